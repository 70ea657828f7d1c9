//! Triangle setup: a screen triangle to edge functions, box and depth plane.
//!
//! After Pineda, "A Parallel Algorithm for Polygon Rasterization" (SIGGRAPH 1988). The formats
//! and ranges of what it makes stand in [`fpga_regs::packet`].

use fpga_regs::packet::{EdgeSteps, FlatTriangle, Span};
use fpga_regs::screen::{DEPTH_FRACTION_BITS, HEIGHT, PacketDepth, Rgb332, SUBPIXEL, SUBPIXEL_BITS, WIDTH};

use crate::reciprocal::reciprocal;

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
    /// Not 0 if the vertex has to be clipped; the other fields then mean nothing.
    pub outside: u32,
}

impl ScreenVertex {
    /// A vertex that has to be clipped.
    pub const OUTSIDE: Self = Self { x: 0, y: 0, depth: 0, outside: 1 };
}

/// Returns twice the signed area of a triangle, in 1/256 of a pixel's area: positive when its
/// corners go clockwise on screen (where y is down), which is the back of a face whose winding
/// is counter-clockwise.
///
/// Within the guard band it is below 2³⁰ in magnitude.
#[inline(always)]
pub fn doubled_area([a, b, c]: [&ScreenVertex; 3]) -> i32 {
    (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y)
}

/// First and last pixel whose centre lies in `low`…`high` (sixteenths of a pixel), cut to the screen.
#[inline(always)]
fn span(low: i32, high: i32, size: u32) -> (i32, i32) {
    let half = SUBPIXEL / 2;
    (((low - half + SUBPIXEL - 1) >> SUBPIXEL_BITS).max(0), ((high - half) >> SUBPIXEL_BITS).min(size as i32 - 1))
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

/// Sets up a triangle whose corners go counter-clockwise on screen, `area` being its
/// [`doubled_area`], below 0. Returns `None` when no pixel centre lies in its box on the screen.
#[inline(always)]
pub fn set_up([a, b, c]: [&ScreenVertex; 3], area: i32, colour: impl FnOnce() -> Rgb332) -> Option<FlatTriangle> {
    debug_assert!(area < 0);
    let (x_first, x_last) = span(a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x), WIDTH);
    let (y_first, y_last) = span(a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y), HEIGHT);
    if x_first > x_last || y_first > y_last {
        return None;
    }
    let ((dx1, dy1), (dx2, dy2)) = ((b.x - a.x, b.y - a.y), (c.x - a.x, c.y - a.y));
    // From the first corner to the centre of the box's first pixel.
    let qx = (x_first << SUBPIXEL_BITS) + SUBPIXEL / 2 - a.x;
    let qy = (y_first << SUBPIXEL_BITS) + SUBPIXEL / 2 - a.y;
    // Edges a→b, c→a, b→c. The three values sum to −area at every point.
    let ab = dy1 * qx - dx1 * qy;
    let ca = dx2 * qy - dy2 * qx;
    let bc = -area - ab - ca;
    let plane = depth_plane(a.depth, (dx1, dy1, b.depth - a.depth), (dx2, dy2, c.depth - a.depth), -area, (qx, qy));
    Some(FlatTriangle {
        colour: colour(),
        columns: Span::new(x_first as u16, x_last as u16),
        rows: Span::new(y_first as u16, y_last as u16),
        edges: [edge_value(ab, dy1, -dx1), edge_value(ca, -dy2, dx2), edge_value(bc, dy2 - dy1, dx1 - dx2)],
        steps: [EdgeSteps::new(dy1, -dx1), EdgeSteps::new(-dy2, dx2)],
        depth: PacketDepth::from_bits(plane.0),
        depth_step_x: PacketDepth::from_bits(plane.1),
        depth_step_y: PacketDepth::from_bits(plane.2),
    })
}

/// Depth at the first pixel and its steps in x and y, Q20.12 modulo 2³².
///
/// The plane through the corners, (dx, dy, dz) from the first to the second and third: its
/// gradient is a cross product over twice the area, `area` > 0. The steps are floored to a
/// multiple of 2⁻¹², which over the longest way in the guard band is an error below half a unit
/// of depth; the reciprocal's error is in proportion to the difference in depth, so below
/// 65,535 · 10⁻⁶. Half a unit is added, so that the device's floor rounds.
#[inline(always)]
fn depth_plane(
    depth: i32,
    (dx1, dy1, dz1): (i32, i32, i32),
    (dx2, dy2, dz2): (i32, i32, i32),
    area: i32,
    (qx, qy): (i32, i32),
) -> (i32, i32, i32) {
    let gradient_x = i64::from(dz2) * i64::from(dy1) - i64::from(dz1) * i64::from(dy2);
    let gradient_y = i64::from(dz1) * i64::from(dx2) - i64::from(dz2) * i64::from(dx1);
    let normalising = (area as u32).leading_zeros();
    let over_area = i64::from(reciprocal((area as u32) << normalising));
    // gradient · 2¹² · 16 / area = gradient · (2⁶²/(area · 2^n)) / 2^(46−n).
    let shift = 62 - DEPTH_FRACTION_BITS - SUBPIXEL_BITS - normalising;
    let fits = |value: i64| i64::from(value as i32) == value;
    let start = (depth << DEPTH_FRACTION_BITS) + (1 << (DEPTH_FRACTION_BITS - 1));
    if fits(gradient_x) && fits(gradient_y) {
        let step_x = (gradient_x * over_area) >> shift;
        let step_y = (gradient_y * over_area) >> shift;
        if fits(step_x) && fits(step_y) {
            let from_corner = i64::from(step_x as i32) * i64::from(qx) + i64::from(step_y as i32) * i64::from(qy);
            let first = start.wrapping_add((from_corner >> SUBPIXEL_BITS) as i32);
            return (first, step_x as i32, step_y as i32);
        }
    }
    steep_depth_plane(start, gradient_x, gradient_y, area, (qx, qy))
}

/// The same for a plane so steep that its steps do not fit in 32 bits: slivers, and faces seen
/// nearly edge-on. Divides exactly, and takes all sums modulo a power of two.
#[cold]
#[inline(never)]
fn steep_depth_plane(start: i32, gradient_x: i64, gradient_y: i64, area: i32, (qx, qy): (i32, i32)) -> (i32, i32, i32) {
    // Gradients are below 2³³, so the quotients are below 2⁴⁹.
    let step = |gradient: i64| (gradient << (DEPTH_FRACTION_BITS + SUBPIXEL_BITS)).div_euclid(i64::from(area));
    let (step_x, step_y) = (step(gradient_x), step(gradient_y));
    let from_corner = step_x.wrapping_mul(i64::from(qx)).wrapping_add(step_y.wrapping_mul(i64::from(qy)));
    (start.wrapping_add((from_corner >> SUBPIXEL_BITS) as i32), step_x as i32, step_y as i32)
}
