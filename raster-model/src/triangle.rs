//! Which pixels a triangle changes, and to what.
//!
//! A pixel of the box is *covered* where all three edge values are ≥ 0, 32-bit two's complement
//! that wraps. Its depth is bits 31…12 of the wrapping sum of the first depth and the steps,
//! saturated to 0…65,535; where that is less than what the depth buffer holds, colour and depth
//! are written. Every pixel is visited once, so the order does not matter.

use fpga_regs::packet::FlatTriangle;
use fpga_regs::screen::{DEPTH_FRACTION_BITS, HEIGHT, WIDTH};

use crate::crossing::Crossing;
use crate::memory::{Colours, Depths};

/// Edge values below this magnitude at the box's first pixel wrap nowhere in a box on the screen,
/// nor one column or row beyond it. Setup's stay below 2²⁶.
const NO_WRAP: u32 = (1 << 31) - (1 << 26);
/// The largest magnitude of a step: the third edge's are minus the sum of two 16-bit ones.
const STEP_MAX: u32 = 2 << 15;
const _: () = assert!(STEP_MAX * (WIDTH + HEIGHT) < 1 << 26);

/// The widest box, in columns, in which looking at every pixel is faster than finding the spans
/// (measured by `cargo bench`).
const NARROW: usize = 16;

/// How many pixels a triangle covered and changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Pixels {
    /// Covered, so that their depth was tested.
    pub(crate) tested: u32,
    /// Nearer than what was there, so that they were written.
    pub(crate) written: u32,
}

/// Draws a triangle whose box lies on the screen.
pub(crate) fn draw(triangle: &FlatTriangle, colours: &mut Colours, depths: &mut Depths) -> Pixels {
    let [_, _, columns, _] = extent(triangle);
    let wraps = triangle.edges.iter().any(|edge| edge.unsigned_abs() >= NO_WRAP);
    if wraps || columns <= NARROW {
        draw_pixels(triangle, colours, depths)
    } else {
        draw_spans(triangle, colours, depths)
    }
}

/// Draws a triangle whose edge values wrap nowhere: each row's covered pixels are one span.
fn draw_spans(triangle: &FlatTriangle, colours: &mut Colours, depths: &mut Depths) -> Pixels {
    let [mut left, top, columns, rows] = extent(triangle);
    left += top * WIDTH as usize;
    let steps = triangle.all_steps();
    let mut edges: [Crossing; 3] =
        core::array::from_fn(|index| Crossing::new(triangle.edges[index], steps[index], columns));
    let mut row_depth = triangle.depth.to_bits();
    let (depth_step_x, depth_step_y) = (triangle.depth_step_x.to_bits(), triangle.depth_step_y.to_bits());
    let mut pixels = Pixels::default();
    for row in 0..rows {
        if row > 0 {
            edges.iter_mut().for_each(Crossing::next_row);
            row_depth = row_depth.wrapping_add(depth_step_y);
            left += WIDTH as usize;
        }
        let (mut first, mut end) = (0, columns);
        edges.iter().for_each(|edge| edge.narrow(&mut first, &mut end));
        if first < end {
            let depth = row_depth.wrapping_add(depth_step_x.wrapping_mul(first as i32));
            let span = left + first..left + end;
            pixels.tested += span.len() as u32;
            pixels.written +=
                fill_span(&mut colours[span.clone()], &mut depths[span], triangle.colour.0, depth, depth_step_x);
        }
    }
    pixels
}

/// Draws any triangle, looking at every pixel of its box.
fn draw_pixels(triangle: &FlatTriangle, colours: &mut Colours, depths: &mut Depths) -> Pixels {
    let [mut left, top, columns, rows] = extent(triangle);
    left += top * WIDTH as usize;
    let steps = triangle.all_steps();
    let (depth_step_x, depth_step_y) = (triangle.depth_step_x.to_bits(), triangle.depth_step_y.to_bits());
    let mut row_edges = triangle.edges;
    let mut row_depth = triangle.depth.to_bits();
    let mut pixels = Pixels::default();
    for _ in 0..rows {
        let mut edges = row_edges;
        let mut depth = row_depth;
        let row = left..left + columns;
        for (shown, nearest) in colours[row.clone()].iter_mut().zip(&mut depths[row]) {
            // The signs of all three at once.
            if edges[0] | edges[1] | edges[2] >= 0 {
                pixels.tested += 1;
                write_if_nearer(shown, nearest, triangle.colour.0, depth, &mut pixels.written);
            }
            edges = core::array::from_fn(|index| edges[index].wrapping_add(steps[index].0));
            depth = depth.wrapping_add(depth_step_x);
        }
        row_edges = core::array::from_fn(|index| row_edges[index].wrapping_add(steps[index].1));
        row_depth = row_depth.wrapping_add(depth_step_y);
        left += WIDTH as usize;
    }
    pixels
}

/// Returns the box's first column, first row, columns and rows.
fn extent(triangle: &FlatTriangle) -> [usize; 4] {
    let (columns, rows) = (triangle.columns, triangle.rows);
    let length = |first: u16, last: u16| usize::from(last - first) + 1;
    [
        columns.first().into(),
        rows.first().into(),
        length(columns.first(), columns.last()),
        length(rows.first(), rows.last()),
    ]
}

/// Tests and writes the pixels of a row; returns how many were written.
///
/// `depth` is that of the first pixel and `step` what each further one adds, Q20.12 modulo 2³².
#[inline(always)]
fn fill_span(colours: &mut [u8], depths: &mut [u16], colour: u8, mut depth: i32, step: i32) -> u32 {
    let mut written = 0;
    for (shown, nearest) in colours.iter_mut().zip(depths) {
        write_if_nearer(shown, nearest, colour, depth, &mut written);
        depth = depth.wrapping_add(step);
    }
    written
}

/// Tests a covered pixel's depth, Q20.12; if it is nearer, writes the pixel and counts it.
#[inline(always)]
fn write_if_nearer(shown: &mut u8, nearest: &mut u16, colour: u8, depth: i32, written: &mut u32) {
    let depth = (depth >> DEPTH_FRACTION_BITS).clamp(0, i32::from(u16::MAX)) as u16;
    if depth < *nearest {
        *nearest = depth;
        *shown = colour;
        *written += 1;
    }
}
