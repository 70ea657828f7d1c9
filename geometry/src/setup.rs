//! Triangle setup: a screen triangle to edge functions, box and depth plane.
//!
//! After Pineda, "A Parallel Algorithm for Polygon Rasterization" (SIGGRAPH 1988). The formats
//! and ranges of what it makes stand in [`fpga_regs::packet`].

use fpga_regs::packet::{
    Channels, EdgeSteps, FlatTriangle, GouraudTriangle, Header, Kind, Packet, Span, TriangleShape,
};
use fpga_regs::screen::{COLOUR_FRACTION_BITS, DEPTH_FRACTION_BITS, HEIGHT, SUBPIXEL, SUBPIXEL_BITS, WIDTH};

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
    set_up_shape(corners, last_words(&mut words))?;
    match Packet::decode(Header(words[0]), &words[1..]) {
        Ok(Packet::FlatTriangle(triangle)) => Some(triangle),
        _ => None,
    }
}

/// As [`set_up`], but with a colour at each corner, 8 bits a channel, that changes linearly over
/// the screen from one to the other.
pub fn set_up_gouraud(corners: [&ScreenVertex; 3], colours: [[u8; 3]; 3]) -> Option<GouraudTriangle> {
    let mut words = [Header::of(Kind::GouraudTriangle).0; GouraudTriangle::WORDS];
    if !set_up_gouraud_words(corners, colours, &mut words) {
        return None;
    }
    match Packet::decode(Header(words[0]), &words[1..]) {
        Ok(Packet::GouraudTriangle(triangle)) => Some(triangle),
        _ => None,
    }
}

/// As [`set_up_gouraud`], but writes the packet's words, all but the header, and returns whether
/// there is a triangle to draw.
pub(crate) fn set_up_gouraud_words(
    corners: [&ScreenVertex; 3],
    colours: [[u8; 3]; 3],
    words: &mut [u32; GouraudTriangle::WORDS],
) -> bool {
    let Some(basis) = set_up_shape(corners, last_words(words)) else { return false };
    let planes = [0, 1, 2].map(|channel| {
        let [a, b, c] = colours.map(|colour| i32::from(colour[channel]));
        let mut plane = Plane::default();
        basis.plane(rounded(a, COLOUR_FRACTION_BITS), (b - a, c - a), &mut plane);
        plane
    });
    for (part, place) in (1..).step_by(Channels::WORDS).take(3).enumerate() {
        let channels = Channels(planes.map(|plane| plane[part] as i32));
        [words[place], words[place + 1]] = channels.encode();
    }
    true
}

/// A triangle packet's shape, which stands at its end.
#[inline(always)]
pub(crate) fn last_words<const N: usize>(words: &mut [u32; N]) -> &mut [u32; TriangleShape::WORDS] {
    match words.last_chunk_mut() {
        Some(shape) => shape,
        None => unreachable!("a packet has more words than its shape"),
    }
}

/// Writes a shape's words and returns what other planes over the triangle are worked out from;
/// `None` when there is nothing to draw.
///
/// The words are written as soon as they are known: the processor has too few registers to keep
/// them.
#[inline(always)]
pub(crate) fn set_up_shape([a, b, c]: [&ScreenVertex; 3], words: &mut [u32; TriangleShape::WORDS]) -> Option<Basis> {
    let ((dx1, dy1), (dx2, dy2)) = ((b.x - a.x, b.y - a.y), (c.x - a.x, c.y - a.y));
    let (x_first, x_last) = span(a.x, dx1, dx2, WIDTH);
    let (y_first, y_last) = span(a.y, dy1, dy2, HEIGHT);
    if x_first > x_last || y_first > y_last {
        return None;
    }
    words[0] = Span::new(x_first as u16, x_last as u16).0;
    words[1] = Span::new(y_first as u16, y_last as u16).0;

    // From the first corner to the centre of the box's first pixel.
    let (qx, qy) = to_centre(a, x_first, y_first);
    // Edges a→b, c→a, b→c. The three values sum to the area at every point.
    let area = dx2 * dy1 - dx1 * dy2;
    let ab = dy1 * qx - dx1 * qy;
    let ca = dx2 * qy - dy2 * qx;
    let bc = area - ab - ca;
    words[2] = edge_value(ab, dy1, -dx1) as u32;
    words[3] = edge_value(ca, -dy2, dx2) as u32;
    words[4] = edge_value(bc, dy2 - dy1, dx1 - dx2) as u32;
    words[5] = EdgeSteps::new(dy1, -dx1).0;
    words[6] = EdgeSteps::new(-dy2, dx2).0;

    let normalising = (area as u32).leading_zeros();
    let over_area = reciprocal((area as u32) << normalising);
    let basis = Basis { first: (dx1, dy1), second: (dx2, dy2), area, normalising, over_area, to_centre: (qx, qy) };
    let depth = words.last_chunk_mut().expect("a shape has more words than a plane");
    basis.plane(rounded(a.depth, DEPTH_FRACTION_BITS), (b.depth - a.depth, c.depth - a.depth), depth);
    Some(basis)
}

/// The way from a corner to the centre of a pixel, in sixteenths of a pixel.
#[inline(always)]
fn to_centre(corner: &ScreenVertex, column: i32, row: i32) -> (i32, i32) {
    let half = SUBPIXEL / 2;
    ((column << SUBPIXEL_BITS) + half - corner.x, (row << SUBPIXEL_BITS) + half - corner.y)
}

/// A value with fraction bits, and half a unit more, so that the device's floor rounds.
#[inline(always)]
fn rounded(value: i32, fraction_bits: u32) -> i32 {
    (value << fraction_bits) | 1 << (fraction_bits - 1)
}

/// Fraction bits of every quantity that is a plane over the screen.
const PLANE_FRACTION_BITS: u32 = DEPTH_FRACTION_BITS;
const _: () = assert!(COLOUR_FRACTION_BITS == PLANE_FRACTION_BITS);

/// How far an area is normalised when the upper half of gradient · reciprocal is the step itself.
const EVEN: u32 = 61 - 32 - PLANE_FRACTION_BITS - SUBPIXEL_BITS;

/// A quantity that is linear over the screen, in 2⁻¹² of its unit, modulo 2³²: at the centre of
/// the box's first pixel, its step of one pixel to the right, and of one row down.
type Plane = [u32; 3];

/// What planes over a triangle are worked out from. All in sixteenths of a pixel.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Basis {
    /// From the first corner to the second.
    first: (i32, i32),
    /// From the first corner to the third.
    second: (i32, i32),
    /// Minus the [`doubled_area`]: above 0.
    area: i32,
    /// By how many bits `area` was shifted for its reciprocal.
    normalising: u32,
    /// 2⁶¹ over that.
    over_area: i32,
    /// From the first corner to the centre of the box's first pixel.
    to_centre: (i32, i32),
}

impl Basis {
    /// Writes the plane through `start` (in 2⁻¹² of its unit) at the first corner and through
    /// what the other two corners have more than it.
    #[inline(always)]
    fn plane(&self, start: i32, (more1, more2): (i32, i32), plane: &mut Plane) {
        let ((dx1, dy1), (dx2, dy2)) = (self.first, self.second);
        let gradient = (more2 * dy1 - more1 * dy2, more1 * dx2 - more2 * dx1);
        let (qx, qy) = self.to_centre;
        let Some((step_x, step_y)) = self.steps(gradient) else {
            return steep_plane(start, gradient, self.area, (qx, qy), plane);
        };
        let from_corner = i64::from(step_x) * i64::from(qx) + i64::from(step_y) * i64::from(qy);
        plane[0] = start.wrapping_add((from_corner >> SUBPIXEL_BITS) as i32) as u32;
        plane[1] = step_x as u32;
        plane[2] = step_y as u32;
    }

    /// Steps in x and y: the gradient's numerators over twice the area. `None` if they do not fit
    /// in 32 bits.
    ///
    /// Steps are floored to 2⁻¹², which over 1,024 pixels each way is half a unit; the
    /// reciprocal's own error is in proportion to the corners' difference, so for depth below
    /// 65,535 · 10⁻⁶.
    #[inline(always)]
    fn steps(&self, (gradient_x, gradient_y): (i32, i32)) -> Option<(i32, i32)> {
        // gradient · 2¹² · 16 / area = gradient · (2⁶¹/(area · 2^n)) / 2³² · 2^(n−13).
        if self.normalising < EVEN {
            let right = EVEN - self.normalising;
            return Some((high(gradient_x, self.over_area) >> right, high(gradient_y, self.over_area) >> right));
        }
        let left = self.normalising - EVEN;
        let (x, y) = (gradient_x << left, gradient_y << left);
        if x >> left != gradient_x || y >> left != gradient_y {
            return None;
        }
        Some((high(x, self.over_area), high(y, self.over_area)))
    }
}

/// The plane of a triangle so steep that its steps do not fit in 32 bits: a sliver, or a face
/// seen nearly edge-on. Divides exactly, and takes all sums modulo 2⁶⁴.
#[cold]
#[inline(never)]
fn steep_plane(start: i32, (gradient_x, gradient_y): (i32, i32), area: i32, (qx, qy): (i32, i32), plane: &mut Plane) {
    // Gradients are below 2³¹, so the quotients are below 2⁴⁷.
    let step = |gradient: i32| (i64::from(gradient) << (PLANE_FRACTION_BITS + SUBPIXEL_BITS)).div_euclid(area.into());
    let (step_x, step_y) = (step(gradient_x), step(gradient_y));
    let from_corner = step_x.wrapping_mul(qx.into()).wrapping_add(step_y.wrapping_mul(qy.into()));
    plane[0] = start.wrapping_add((from_corner >> SUBPIXEL_BITS) as i32) as u32;
    plane[1] = step_x as u32;
    plane[2] = step_y as u32;
}
