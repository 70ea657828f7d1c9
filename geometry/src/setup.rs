//! Triangle setup: a screen triangle to edge functions, box and depth plane.
//!
//! After Pineda, "A Parallel Algorithm for Polygon Rasterization" (SIGGRAPH 1988). The formats
//! and ranges of what it makes stand in [`fpga_regs::packet`].

use fpga_regs::packet::{EdgeSteps, FlatTriangle, Header, Kind, Packet, Span};
use fpga_regs::screen::{DEPTH_FRACTION_BITS, HEIGHT, SUBPIXEL, SUBPIXEL_BITS, WIDTH};

use crate::reciprocal::{high, reciprocal};

/// A vertex on the screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(C, align(16))]
pub struct ScreenVertex {
    /// To the right, in sixteenths of a pixel, within the guard band.
    pub x: i32,
    /// Down, in sixteenths of a pixel, within the guard band.
    pub y: i32,
    /// 0 (near) to 65,535 (far).
    pub depth: i32,
    /// Not 0 if the vertex has to be clipped: a bit for each plane it is outside of. The other
    /// fields then mean nothing.
    pub outside: u32,
}

/// Returns twice the signed area of a triangle, in 1/256 of a pixel's area: positive when its
/// corners go clockwise on screen (where y is down), which is the back of a face whose winding
/// is counter-clockwise.
///
/// Within the guard band it is below 2²⁸ in magnitude.
#[inline(always)]
pub fn doubled_area([a, b, c]: [&ScreenVertex; 3]) -> i32 {
    (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y)
}

/// First pixel whose centre is at `low` (sixteenths of a pixel) or after, cut to the screen.
#[inline(always)]
fn first_pixel(low: i32) -> i32 {
    ((low + SUBPIXEL / 2 - 1) >> SUBPIXEL_BITS).max(0)
}

/// Last pixel whose centre is at `high` or before, cut to a screen of `size` pixels.
#[inline(always)]
fn last_pixel(high: i32, size: u32) -> i32 {
    ((high - SUBPIXEL / 2) >> SUBPIXEL_BITS).min(size as i32 - 1)
}

/// First and last pixel of a triangle's box along one axis: one corner's coordinate, and the
/// ways from it to the other two.
#[inline(always)]
fn span(corner: i32, to_second: i32, to_third: i32, size: u32) -> (i32, i32) {
    let (low, high) = (to_second.min(0).min(to_third), to_second.max(0).max(to_third));
    (first_pixel(corner + low), last_pixel(corner + high, size))
}

/// An edge's value for the packet: top-left rule folded in, then in steps of a pixel.
///
/// A pixel centre on the edge itself counts as inside only if the edge is a left one (its value
/// grows to the right) or a top one (level, and its value grows downwards); else the value is
/// lowered by the least amount there is. At all pixel centres the value has the same remainder
/// modulo 16, so dropping it changes no sign.
#[inline(always)]
fn edge_value(value: i32, step_x: i32, step_y: i32) -> i32 {
    // Positive for a left or top edge: steps are below 2¹⁵, so the first outweighs the second.
    let top_left = (step_x << 16) + step_y;
    (value + (top_left >> 31)) >> SUBPIXEL_BITS
}

/// Sets up a triangle whose corners go counter-clockwise on screen, so that its [`doubled_area`]
/// is below 0. It comes out black. Returns `None` when no pixel centre lies in its box on the
/// screen.
///
/// The corners must lie within the guard band and their depths in 0…65,535.
pub fn set_up(corners: [&ScreenVertex; 3]) -> Option<FlatTriangle> {
    let mut words = [Header::of(Kind::FlatTriangle).0; FlatTriangle::WORDS];
    if !set_up_words(corners, &mut words) {
        return None;
    }
    match Packet::decode(Header(words[0]), &words[1..]) {
        Ok(Packet::FlatTriangle(triangle)) => Some(triangle),
        _ => None,
    }
}

/// As [`set_up`], but writes the packet's words, all but the header, and returns whether there
/// is a triangle to draw.
///
/// They are written as soon as they are known: the processor has too few registers to keep them.
#[inline(always)]
pub(crate) fn set_up_words([a, b, c]: [&ScreenVertex; 3], words: &mut [u32; FlatTriangle::WORDS]) -> bool {
    let ((dx1, dy1), (dx2, dy2)) = ((b.x - a.x, b.y - a.y), (c.x - a.x, c.y - a.y));
    let (x_first, x_last) = span(a.x, dx1, dx2, WIDTH);
    let (y_first, y_last) = span(a.y, dy1, dy2, HEIGHT);
    if x_first > x_last || y_first > y_last {
        return false;
    }
    words[1] = Span::new(x_first as u16, x_last as u16).0;
    words[2] = Span::new(y_first as u16, y_last as u16).0;

    // From the first corner to the centre of the box's first pixel.
    let (qx, qy) = to_centre(a, x_first, y_first);
    // Edges a→b, c→a, b→c. The three values sum to the area at every point.
    let area = dx2 * dy1 - dx1 * dy2;
    let ab = dy1 * qx - dx1 * qy;
    let ca = dx2 * qy - dy2 * qx;
    let bc = area - ab - ca;
    words[3] = edge_value(ab, dy1, -dx1) as u32;
    words[4] = edge_value(ca, -dy2, dx2) as u32;
    words[5] = edge_value(bc, dy2 - dy1, dx1 - dx2) as u32;
    words[6] = EdgeSteps::new(dy1, -dx1).0;
    words[7] = EdgeSteps::new(-dy2, dx2).0;

    let (dz1, dz2) = (b.depth - a.depth, c.depth - a.depth);
    let gradient = (dz2 * dy1 - dz1 * dy2, dz1 * dx2 - dz2 * dx1);
    let Some((step_x, step_y)) = depth_steps(gradient, area) else {
        steep_depth_plane(a, gradient, area, (qx, qy), words);
        return true;
    };
    let from_corner = i64::from(step_x) * i64::from(qx) + i64::from(step_y) * i64::from(qy);
    words[8] = depth_start(a).wrapping_add((from_corner >> SUBPIXEL_BITS) as i32) as u32;
    words[9] = step_x as u32;
    words[10] = step_y as u32;
    true
}

/// The way from a corner to the centre of a pixel, in sixteenths of a pixel.
#[inline(always)]
fn to_centre(corner: &ScreenVertex, column: i32, row: i32) -> (i32, i32) {
    let half = SUBPIXEL / 2;
    ((column << SUBPIXEL_BITS) + half - corner.x, (row << SUBPIXEL_BITS) + half - corner.y)
}

/// A corner's depth in Q20.12, and half a unit more, so that the device's floor rounds.
#[inline(always)]
fn depth_start(corner: &ScreenVertex) -> i32 {
    (corner.depth << DEPTH_FRACTION_BITS) | 1 << (DEPTH_FRACTION_BITS - 1)
}

/// How far an area is normalised when the upper half of gradient · reciprocal is the step itself.
const EVEN: u32 = 61 - 32 - DEPTH_FRACTION_BITS - SUBPIXEL_BITS;

/// Steps of depth in x and y, Q20.12: the gradient's numerators over twice the area. `None` if
/// they do not fit in 32 bits.
///
/// Steps are floored to 2⁻¹², which over 1,024 pixels each way is half a unit of depth; the
/// reciprocal's own error is in proportion to the difference in depth, so below 65,535 · 10⁻⁶.
#[inline(always)]
fn depth_steps((gradient_x, gradient_y): (i32, i32), area: i32) -> Option<(i32, i32)> {
    let normalising = (area as u32).leading_zeros();
    let over_area = reciprocal((area as u32) << normalising);
    // gradient · 2¹² · 16 / area = gradient · (2⁶¹/(area · 2^n)) / 2³² · 2^(n−13).
    if normalising < EVEN {
        let right = EVEN - normalising;
        return Some((high(gradient_x, over_area) >> right, high(gradient_y, over_area) >> right));
    }
    let left = normalising - EVEN;
    let (x, y) = (gradient_x << left, gradient_y << left);
    if x >> left != gradient_x || y >> left != gradient_y {
        return None;
    }
    Some((high(x, over_area), high(y, over_area)))
}

/// Depth of a triangle so steep that its steps do not fit in 32 bits: a sliver, or a face seen
/// nearly edge-on. Divides exactly, and takes all sums modulo 2⁶⁴.
#[cold]
#[inline(never)]
fn steep_depth_plane(
    corner: &ScreenVertex,
    (gradient_x, gradient_y): (i32, i32),
    area: i32,
    (qx, qy): (i32, i32),
    words: &mut [u32; FlatTriangle::WORDS],
) {
    // Gradients are below 2³¹, so the quotients are below 2⁴⁷.
    let step = |gradient: i32| (i64::from(gradient) << (DEPTH_FRACTION_BITS + SUBPIXEL_BITS)).div_euclid(area.into());
    let (step_x, step_y) = (step(gradient_x), step(gradient_y));
    let from_corner = step_x.wrapping_mul(qx.into()).wrapping_add(step_y.wrapping_mul(qy.into()));
    words[8] = depth_start(corner).wrapping_add((from_corner >> SUBPIXEL_BITS) as i32) as u32;
    words[9] = step_x as u32;
    words[10] = step_y as u32;
}
