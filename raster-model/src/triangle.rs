//! Which pixels a triangle changes, and to what.
//!
//! A pixel of the box is *covered* where all three edge values are ≥ 0, 32-bit two's complement
//! that wraps. Its depth is bits 31…12 of the wrapping sum of the first depth and the steps,
//! saturated to 0…65,535; where that is less than what the depth buffer holds, colour and depth
//! are written, unless the packet's mode keeps one of them. Every pixel is visited once, so the order does not matter.

use fpga_regs::packet::{PixelMode, TriangleShape};
use fpga_regs::screen::{DEPTH_FRACTION_BITS, HEIGHT, WIDTH};

use crate::crossing::Crossing;
use crate::memory::{Colours, Depths};
use crate::paint::Paint;

/// Edge values below this magnitude at the box's first pixel wrap nowhere in a box on the screen,
/// nor one column or row beyond it. Setup's stay below 2²⁶.
const NO_WRAP: u32 = (1 << 31) - (1 << 26);
/// The largest magnitude of a step: the third edge's are minus the sum of two 16-bit ones.
const STEP_MAX: u32 = 2 << 15;
const _: () = assert!(STEP_MAX * (WIDTH + HEIGHT) < 1 << 26);

/// The widest box, in columns, in which looking at every pixel is faster than finding the spans
/// (measured by `cargo bench`).
const NARROW: usize = 16;

/// What a triangle leaves as it is.
pub(crate) trait Keep: Copy {
    /// Whether depth is neither tested nor written.
    fn depth(self) -> bool;
    /// Whether colour is not written.
    fn colour(self) -> bool;
}

/// Keeps nothing: its own type, so that what most triangles do has no test in it.
#[derive(Clone, Copy)]
pub(crate) struct Nothing;

impl Keep for Nothing {
    #[inline(always)]
    fn depth(self) -> bool {
        false
    }

    #[inline(always)]
    fn colour(self) -> bool {
        false
    }
}

impl Keep for PixelMode {
    fn depth(self) -> bool {
        self.keep_depth
    }

    fn colour(self) -> bool {
        self.keep_colour
    }
}

/// How many pixels a triangle covered and changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Pixels {
    /// Covered, so that their depth was tested.
    pub(crate) tested: u32,
    /// Nearer than what was there, or not tested: written, as far as the mode writes.
    pub(crate) written: u32,
}

/// Draws a triangle whose box lies on the screen. `paint` stands at the box's upper left pixel.
pub(crate) fn draw(
    shape: &TriangleShape,
    paint: impl Paint,
    keep: impl Keep,
    colours: &mut Colours,
    depths: &mut Depths,
) -> Pixels {
    let wraps = shape.edges.iter().any(|edge| edge.unsigned_abs() >= NO_WRAP);
    if wraps || extent(shape).columns <= NARROW {
        draw_pixels(shape, paint, keep, colours, depths)
    } else {
        draw_spans(shape, paint, keep, colours, depths)
    }
}

/// Draws a triangle whose edge values wrap nowhere: each row's covered pixels are one span.
fn draw_spans(
    shape: &TriangleShape,
    mut paint: impl Paint,
    keep: impl Keep,
    colours: &mut Colours,
    depths: &mut Depths,
) -> Pixels {
    let Extent { left, top, columns, rows } = extent(shape);
    let steps = shape.all_steps();
    let mut edges: [Crossing; 3] =
        core::array::from_fn(|index| Crossing::new(shape.edges[index], steps[index], columns));
    let mut row_depth = shape.depth.to_bits();
    let (depth_step_x, depth_step_y) = (shape.depth_step_x.to_bits(), shape.depth_step_y.to_bits());
    let mut pixels = Pixels::default();
    for y in top..top + rows {
        if y > top {
            edges.iter_mut().for_each(Crossing::next_row);
            row_depth = row_depth.wrapping_add(depth_step_y);
            paint.go_down();
        }
        let (mut first, mut end) = (0, columns);
        edges.iter().for_each(|edge| edge.narrow(&mut first, &mut end));
        if first < end {
            let mut depth = row_depth.wrapping_add(depth_step_x.wrapping_mul(first as i32));
            let mut paint = paint;
            paint.go_right(first);
            let start = y * WIDTH as usize + left;
            let span = start + first..start + end;
            pixels.tested += span.len() as u32;
            for ((shown, nearest), x) in colours[span.clone()].iter_mut().zip(&mut depths[span]).zip(left + first..) {
                write_if_nearer(shown, nearest, depth, keep, &mut pixels.written, |depth| paint.colour(x, y, depth));
                depth = depth.wrapping_add(depth_step_x);
                paint.go_right(1);
            }
        }
    }
    pixels
}

/// Draws any triangle, looking at every pixel of its box.
fn draw_pixels(
    shape: &TriangleShape,
    mut paint: impl Paint,
    keep: impl Keep,
    colours: &mut Colours,
    depths: &mut Depths,
) -> Pixels {
    let Extent { left, top, columns, rows } = extent(shape);
    let steps = shape.all_steps();
    let (depth_step_x, depth_step_y) = (shape.depth_step_x.to_bits(), shape.depth_step_y.to_bits());
    let mut row_edges = shape.edges;
    let mut row_depth = shape.depth.to_bits();
    let mut pixels = Pixels::default();
    for y in top..top + rows {
        let mut edges = row_edges;
        let mut depth = row_depth;
        let mut row_paint = paint;
        let start = y * WIDTH as usize + left;
        let row = start..start + columns;
        for ((shown, nearest), x) in colours[row.clone()].iter_mut().zip(&mut depths[row]).zip(left..) {
            // The signs of all three at once.
            if edges[0] | edges[1] | edges[2] >= 0 {
                pixels.tested += 1;
                write_if_nearer(shown, nearest, depth, keep, &mut pixels.written, |depth| {
                    row_paint.colour(x, y, depth)
                });
            }
            edges = core::array::from_fn(|index| edges[index].wrapping_add(steps[index].0));
            depth = depth.wrapping_add(depth_step_x);
            row_paint.go_right(1);
        }
        row_edges = core::array::from_fn(|index| row_edges[index].wrapping_add(steps[index].1));
        row_depth = row_depth.wrapping_add(depth_step_y);
        paint.go_down();
    }
    pixels
}

/// A box, in pixels.
struct Extent {
    left: usize,
    top: usize,
    columns: usize,
    rows: usize,
}

fn extent(shape: &TriangleShape) -> Extent {
    let (columns, rows) = (shape.columns, shape.rows);
    let length = |first: u16, last: u16| usize::from(last - first) + 1;
    Extent {
        left: columns.first().into(),
        top: rows.first().into(),
        columns: length(columns.first(), columns.last()),
        rows: length(rows.first(), rows.last()),
    }
}

/// Tests a covered pixel's depth, Q20.12; if it is nearer, writes the pixel and counts it.
#[inline(always)]
fn write_if_nearer(
    shown: &mut u8,
    nearest: &mut u16,
    depth: i32,
    keep: impl Keep,
    written: &mut u32,
    colour: impl FnOnce(u16) -> u8,
) {
    let depth = (depth >> DEPTH_FRACTION_BITS).clamp(0, i32::from(u16::MAX)) as u16;
    if keep.depth() || depth < *nearest {
        if !keep.depth() {
            *nearest = depth;
        }
        if !keep.colour() {
            *shown = colour(depth);
        }
        *written += 1;
    }
}
