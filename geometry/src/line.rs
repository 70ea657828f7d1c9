//! Line setup: the pixels that lie nearest to a line, as the packet of a very thin triangle.
//!
//! The FPGA needs no second rasterizer for lines. Two of a packet's three edges are the line itself,
//! moved half a pixel to either side along its minor axis and facing each other; the third edge's
//! steps, minus the sum of theirs, are 0, and with the value 0 it is always inside. The box cuts
//! the ends. So in each column of a line that is wider than high (each row of another) exactly one
//! pixel is covered: the line is one pixel thick and has no gap.
//!
//! The rule: along the axis in which the line is longer (x, if it is as wide as high) it has the
//! pixels from the one that contains one end to the one that contains the other; across, the pixel
//! whose centre is nearest, and of two that are as near the upper or left one. It does not depend
//! on which end comes first. Lines that share an end touch there, so an outline has no gap either.

use fpga_regs::packet::{EdgeSteps, FlatTriangle, Header, Kind, PixelMode, Span, TriangleShape};
use fpga_regs::screen::{DEPTH_FRACTION_BITS, HEIGHT, Rgb332, SUBPIXEL, SUBPIXEL_BITS, WIDTH};

use crate::reciprocal::reciprocal;
use crate::setup::{ScreenVertex, last_words};

/// How a line looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LineStyle {
    /// Its colour.
    pub colour: Rgb332,
    /// What its pixels do: [`PixelMode::keep_depth`] draws it over everything.
    pub mode: PixelMode,
}

/// Writes the packet of the line between two points on the screen and returns whether any of it
/// is there.
///
/// The ends must lie within the guard band and their depths in 0…65,535. Depth goes linearly
/// from one to the other along the longer axis; a line shorter than a pixel has its nearer end's.
pub fn set_up_line(
    from: &ScreenVertex,
    to: &ScreenVertex,
    style: &LineStyle,
    words: &mut [u32; FlatTriangle::WORDS],
) -> bool {
    let steep = (to.y - from.y).abs() > (to.x - from.x).abs();
    let (from, to) = if steep { (Along::steep(from), Along::steep(to)) } else { (Along::flat(from), Along::flat(to)) };
    // From left to right, or from top to bottom.
    let (start, end) = if (from.major, from.minor) <= (to.major, to.minor) { (from, to) } else { (to, from) };
    let (major_size, minor_size) = if steep { (HEIGHT, WIDTH) } else { (WIDTH, HEIGHT) };
    let majors = on_screen(start.major, end.major, 0, major_size);
    let (length, rise) = (end.major - start.major, end.minor - start.minor);
    // At the centre of its last pixel the line may be half a pixel past its end, so a row further.
    // Not so a single point: any centre is on it, and the box alone says where it is.
    let point = i32::from(length == 0);
    let minors = on_screen(start.minor.min(end.minor), start.minor.max(end.minor), 1 - point, minor_size);
    let (Some(majors), Some(minors)) = (majors, minors) else { return false };

    let centre = |pixel: u16| (i32::from(pixel) << SUBPIXEL_BITS) + SUBPIXEL / 2;
    let (along, across) = (centre(majors.first()) - start.major, centre(minors.first()) - start.minor);
    // How far the first pixel's centre lies below the line (or right of it), times its length. Both
    // products are below 2²⁸. All centres have the same remainder modulo 16, so dropping it below
    // changes no sign.
    let below = length * across - rise * along;
    let half = length * (SUBPIXEL / 2);
    let edges = [(below + half) >> SUBPIXEL_BITS, (half - 1 + point - below) >> SUBPIXEL_BITS, 0];
    let towards =
        |major: i32, minor: i32| if steep { EdgeSteps::new(minor, major) } else { EdgeSteps::new(major, minor) };
    let steps = [towards(-rise, length), towards(rise, -length)];

    let depth = DepthAlong::new(&start, &end);
    let (depth_step_x, depth_step_y) = if steep { (0, depth.step) } else { (depth.step, 0) };
    let (columns, rows) = if steep { (minors, majors) } else { (majors, minors) };
    words[0] = Header::of(Kind::FlatTriangle).with_colour(style.colour.0).with_mode(style.mode).0;
    let shape: &mut [u32; TriangleShape::WORDS] = last_words(words);
    *shape = [
        columns.0,
        rows.0,
        edges[0] as u32,
        edges[1] as u32,
        edges[2] as u32,
        steps[0].0,
        steps[1].0,
        depth.at(along) as u32,
        depth_step_x as u32,
        depth_step_y as u32,
    ];
    true
}

/// An end, by the axis in which the line is longer and the other.
struct Along {
    major: i32,
    minor: i32,
    depth: i32,
}

impl Along {
    fn flat(vertex: &ScreenVertex) -> Self {
        Self { major: vertex.x, minor: vertex.y, depth: vertex.depth }
    }

    fn steep(vertex: &ScreenVertex) -> Self {
        Self { major: vertex.y, minor: vertex.x, depth: vertex.depth }
    }
}

/// The pixels from the one that contains `low` to the one that contains `high` and `more` beyond
/// each, cut to a screen of `size`; `None` if none is on it.
fn on_screen(low: i32, high: i32, more: i32, size: u32) -> Option<Span> {
    let first = ((low >> SUBPIXEL_BITS) - more).max(0);
    let last = ((high >> SUBPIXEL_BITS) + more).min(size as i32 - 1);
    (first <= last).then(|| Span::new(first as u16, last as u16))
}

/// Depth along a line, Q20.12.
struct DepthAlong {
    start: i32,
    step: i32,
}

impl DepthAlong {
    /// At a pixel's centre the line may be half a pixel outside its ends; as its steps are at most
    /// 65,535, the sum stays in −32,768…98,303 and saturates where the device takes it.
    fn new(start: &Along, end: &Along) -> Self {
        let rounded = |depth: i32| depth << DEPTH_FRACTION_BITS | 1 << (DEPTH_FRACTION_BITS - 1);
        let length = end.major - start.major;
        if length < SUBPIXEL {
            return Self { start: rounded(start.depth.min(end.depth)), step: 0 };
        }
        // difference · 2¹² · 16 / length = difference · (2⁶¹/(length · 2^n)) / 2^(61 − 16 − n).
        let normalising = (length as u32).leading_zeros();
        let over_length = i64::from(reciprocal((length as u32) << normalising));
        let shift = 61 - DEPTH_FRACTION_BITS - SUBPIXEL_BITS - normalising;
        let step = (i64::from(end.depth - start.depth) * over_length) >> shift;
        Self { start: rounded(start.depth), step: step as i32 }
    }

    /// Returns the depth so many sixteenths of a pixel along.
    fn at(&self, along: i32) -> i32 {
        self.start.wrapping_add(((i64::from(self.step) * i64::from(along)) >> SUBPIXEL_BITS) as i32)
    }
}
