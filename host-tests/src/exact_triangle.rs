//! Which pixels a screen triangle covers, by the definition, and its depth as a fraction.
//!
//! Two formulations of the top-left rule that share nothing, so that each can be held against the
//! other: the rule as the graphics interfaces write it down ([`covers`]), and the winding number of
//! a closed outline around a pixel centre moved by an infinitesimal step ([`winding_number`]).

use fpga_regs::screen::{SUBPIXEL, SUBPIXEL_BITS};

/// A point on the screen: x to the right and y down, in sixteenths of a pixel.
pub type Point = (i32, i32);

/// Returns the centre of a pixel.
pub fn centre(x: i32, y: i32) -> Point {
    ((x << SUBPIXEL_BITS) + SUBPIXEL / 2, (y << SUBPIXEL_BITS) + SUBPIXEL / 2)
}

/// Returns on which side of the line from `p` to `q` a point lies: above 0, 0 or below 0.
fn side(p: Point, q: Point, point: Point) -> i64 {
    let wide = |(x, y): Point| (i64::from(x), i64::from(y));
    let ((px, py), (qx, qy), (x, y)) = (wide(p), wide(q), wide(point));
    (qx - px) * (y - py) - (qy - py) * (x - px)
}

/// Returns twice the triangle's area in 1/256 of a pixel's, above 0 when its corners go clockwise
/// as one sees the screen.
pub fn doubled_area([a, b, c]: [Point; 3]) -> i64 {
    side(a, b, c)
}

/// Returns whether a triangle covers a pixel: its centre lies inside, or on a left or a top edge.
///
/// A top edge is level and has the triangle below it; a left edge is not level and has the triangle
/// on its right. The order of the corners does not matter. No area, no pixels.
pub fn covers(corners: [Point; 3], x: i32, y: i32) -> bool {
    if doubled_area(corners) == 0 {
        return false;
    }
    let centre = centre(x, y);
    (0..3).all(|index| {
        let (p, q, opposite) = (corners[index], corners[(index + 1) % 3], corners[(index + 2) % 3]);
        let (inner, found) = (side(p, q, opposite).signum(), side(p, q, centre).signum());
        if found != 0 {
            return found == inner;
        }
        if p.1 == q.1 {
            return opposite.1 > p.1;
        }
        // Taken upwards, what is to the right of an edge has a side above 0.
        let (low, high) = if p.1 > q.1 { (p, q) } else { (q, p) };
        side(low, high, opposite) > 0
    })
}

/// Returns how often a closed outline goes round a pixel centre, clockwise as one sees the screen,
/// when the centre is moved to the right by an infinitesimal step and down by a still smaller one.
///
/// That move is the top-left rule: off a left edge it leads inside, off a right one outside; along
/// a level edge only the second part counts, and off a top edge that leads inside.
pub fn winding_number(outline: &[Point], x: i32, y: i32) -> i32 {
    let (x, y) = centre(x, y);
    let mut turns = 0;
    for (index, p) in outline.iter().enumerate() {
        let q = &outline[(index + 1) % outline.len()];
        // The moved centre is below everything at its own height.
        let (p_above, q_above) = (p.1 <= y, q.1 <= y);
        if p_above == q_above {
            continue;
        }
        // Where the edge meets the centre's row, minus the centre's column, times the edge's height:
        let height = i64::from(q.1 - p.1);
        let reach = i64::from(p.0 - x) * height + i64::from(q.0 - p.0) * i64::from(y - p.1);
        if reach * height.signum() > 0 {
            turns += if p_above { 1 } else { -1 };
        }
    }
    turns
}

/// Returns the pixels that may have their centre in the corners' box, cut to the screen.
pub fn pixel_box(corners: &[Point], width: u32, height: u32) -> (core::ops::Range<i32>, core::ops::Range<i32>) {
    let range = |part: fn(&Point) -> i32, size: u32| {
        let low = corners.iter().map(part).min().unwrap_or(0).div_euclid(SUBPIXEL);
        let high = corners.iter().map(part).max().unwrap_or(0).div_euclid(SUBPIXEL) + 1;
        low.clamp(0, size as i32)..high.clamp(0, size as i32)
    };
    (range(|point| point.0, width), range(|point| point.1, height))
}

/// Returns the depth of the triangle's plane at a pixel centre as numerator and denominator, which
/// is above 0. The triangle has an area.
pub fn depth(corners: [Point; 3], depths: [i32; 3], x: i32, y: i32) -> (i128, i128) {
    let [a, b, c] = corners;
    let point = centre(x, y);
    // Barycentric weights, as parts of the area.
    let weights = [side(b, c, point), side(c, a, point), side(a, b, point)];
    let sum: i128 = weights.iter().zip(depths).map(|(weight, depth)| i128::from(*weight) * i128::from(depth)).sum();
    let area = i128::from(doubled_area(corners));
    (sum * area.signum(), area.abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::Rng;

    #[test]
    fn the_rule_and_the_winding_number_say_the_same() {
        let mut rng = Rng(1);
        let mut on_edges = 0;
        for _ in 0..20_000 {
            // On a raster of half pixels centres lie on edges and corners all the time.
            let step = rng.pick(&[1, 8, 8, 16]);
            let corners = [0; 3].map(|_| (rng.within(-4, 14) * step, rng.within(-4, 14) * step));
            let clockwise = doubled_area(corners).signum() as i32;
            for y in 0..12 {
                for x in 0..12 {
                    let expected = if covers(corners, x, y) { clockwise } else { 0 };
                    assert_eq!(winding_number(&corners, x, y), expected, "{corners:?} at ({x}, {y})");
                    let on_edge = |index: usize| side(corners[index], corners[(index + 1) % 3], centre(x, y)) == 0;
                    on_edges += usize::from((0..3).any(on_edge));
                }
            }
        }
        assert!(on_edges > 10_000, "only {on_edges} centres lay on an edge");
    }

    #[test]
    fn a_square_of_two_triangles_on_pixel_centres_keeps_its_left_and_top() {
        let square = [(8, 8), (40, 8), (40, 40), (8, 40)];
        let halves = [[square[0], square[1], square[2]], [square[0], square[2], square[3]]];
        for y in 0..4 {
            for x in 0..4 {
                let count = halves.iter().filter(|half| covers(**half, x, y)).count();
                assert_eq!(count, usize::from(x < 2 && y < 2), "({x}, {y})");
            }
        }
    }

    #[test]
    fn a_corners_depth_is_its_own() {
        let corners = [(8, 8), (8 + 160, 8), (8, 8 + 320)];
        for (pixel, expected) in [((0, 0), 100), ((10, 0), 65_535), ((0, 20), 7)] {
            let (numerator, denominator) = depth(corners, [100, 65_535, 7], pixel.0, pixel.1);
            assert_eq!(numerator, expected * denominator);
        }
    }
}
