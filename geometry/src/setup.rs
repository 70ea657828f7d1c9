//! Triangle setup: a screen triangle to edge functions, box and depth plane.
//!
//! After Pineda, "A Parallel Algorithm for Polygon Rasterization" (SIGGRAPH 1988). The formats
//! and ranges of what it makes stand in [`fpga_regs::packet`].

use fpga_regs::packet::{EdgeSteps, FlatTriangle, Span};
use fpga_regs::screen::{DEPTH_FRACTION_BITS, HEIGHT, PacketDepth, Rgb332, SUBPIXEL, SUBPIXEL_BITS, WIDTH};

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
/// Within the guard band it is below 2³⁰ in magnitude.
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
/// [`doubled_area`], below 0. It comes out black. Returns `None` when no pixel centre lies in its
/// box on the screen.
#[inline(always)]
pub fn set_up([a, b, c]: [&ScreenVertex; 3], area: i32) -> Option<FlatTriangle> {
    debug_assert!(area < 0);
    let (x_low, x_high) = (a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x));
    let (y_low, y_high) = (a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y));
    let (x_first, x_last) = (first_pixel(x_low), last_pixel(x_high, WIDTH));
    let (y_first, y_last) = (first_pixel(y_low), last_pixel(y_high, HEIGHT));
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
    let plane = DepthPlane {
        start: (a.depth << DEPTH_FRACTION_BITS) + (1 << (DEPTH_FRACTION_BITS - 1)),
        first: (dx1, dy1, b.depth - a.depth),
        second: (dx2, dy2, c.depth - a.depth),
        area: -area,
        to_pixel: (qx, qy),
    };
    let is_small = (x_high - x_low) | (y_high - y_low) < SMALL;
    let (depth, depth_step_x, depth_step_y) = if is_small { plane.of_small() } else { plane.exact() };
    Some(FlatTriangle {
        colour: Rgb332::BLACK,
        columns: Span::new(x_first as u16, x_last as u16),
        rows: Span::new(y_first as u16, y_last as u16),
        edges: [edge_value(ab, dy1, -dx1), edge_value(ca, -dy2, dx2), edge_value(bc, dy2 - dy1, dx1 - dx2)],
        steps: [EdgeSteps::new(dy1, -dx1), EdgeSteps::new(-dy2, dx2)],
        depth: PacketDepth::from_bits(depth),
        depth_step_x: PacketDepth::from_bits(depth_step_x),
        depth_step_y: PacketDepth::from_bits(depth_step_y),
    })
}

/// A triangle less wide and high than this, in sixteenths of a pixel, has a depth gradient whose
/// numerators fit in 32 bits: 65,535 · 2¹⁴ · 2 < 2³¹.
const SMALL: i32 = 1 << 14;

/// How far an area is normalised when the upper half of gradient · reciprocal is the step itself.
const EVEN: u32 = 61 - 32 - DEPTH_FRACTION_BITS - SUBPIXEL_BITS;

/// The plane through a triangle's three depths, and where it is wanted.
struct DepthPlane {
    /// Depth at the first corner in Q20.12, and half a unit, so that the device's floor rounds.
    start: i32,
    /// From the first corner to the second: right, down, deeper.
    first: (i32, i32, i32),
    /// From the first corner to the third.
    second: (i32, i32, i32),
    /// Twice the area, above 0.
    area: i32,
    /// From the first corner to the box's first pixel.
    to_pixel: (i32, i32),
}

impl DepthPlane {
    /// Depth at the first pixel and its steps in x and y, Q20.12 modulo 2³², of a small triangle.
    ///
    /// The gradient is a cross product over twice the area. Steps are floored to 2⁻¹², which over
    /// 1,024 pixels each way is half a unit of depth; the reciprocal's own error is in proportion to the difference in depth, so
    /// below 65,535 · 10⁻⁶.
    #[inline(always)]
    fn of_small(&self) -> (i32, i32, i32) {
        let ((dx1, dy1, dz1), (dx2, dy2, dz2)) = (self.first, self.second);
        let (gradient_x, gradient_y) = (dz2 * dy1 - dz1 * dy2, dz1 * dx2 - dz2 * dx1);
        let normalising = (self.area as u32).leading_zeros();
        let over_area = reciprocal((self.area as u32) << normalising);
        // gradient · 2¹² · 16 / area = gradient · (2⁶¹/(area · 2^n)) / 2³² · 2^(n−13).
        let (step_x, step_y) = if normalising >= EVEN {
            let left = normalising - EVEN;
            let (x, y) = (gradient_x << left, gradient_y << left);
            if x >> left != gradient_x || y >> left != gradient_y {
                return self.exact();
            }
            (high(x, over_area), high(y, over_area))
        } else {
            let right = EVEN - normalising;
            (high(gradient_x, over_area) >> right, high(gradient_y, over_area) >> right)
        };
        let (qx, qy) = self.to_pixel;
        let from_corner = i64::from(step_x) * i64::from(qx) + i64::from(step_y) * i64::from(qy);
        (self.start.wrapping_add((from_corner >> SUBPIXEL_BITS) as i32), step_x, step_y)
    }

    /// The same for a triangle that is large, or so steep that its steps do not fit in 32 bits:
    /// a sliver, or a face seen nearly edge-on. Divides exactly, and takes all sums modulo 2⁶⁴.
    #[cold]
    #[inline(never)]
    fn exact(&self) -> (i32, i32, i32) {
        let wide = |(x, y, z): (i32, i32, i32)| (i64::from(x), i64::from(y), i64::from(z));
        let ((dx1, dy1, dz1), (dx2, dy2, dz2)) = (wide(self.first), wide(self.second));
        // Gradients are below 2³³, so the quotients are below 2⁴⁹.
        let step = |gradient: i64| (gradient << (DEPTH_FRACTION_BITS + SUBPIXEL_BITS)).div_euclid(self.area.into());
        let (step_x, step_y) = (step(dz2 * dy1 - dz1 * dy2), step(dz1 * dx2 - dz2 * dx1));
        let (qx, qy) = self.to_pixel;
        let from_corner = step_x.wrapping_mul(qx.into()).wrapping_add(step_y.wrapping_mul(qy.into()));
        (self.start.wrapping_add((from_corner >> SUBPIXEL_BITS) as i32), step_x as i32, step_y as i32)
    }
}
