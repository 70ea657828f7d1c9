//! Whether a polygon can be drawn as a fan of triangles.

use std::f64::consts::TAU;

/// Why a polygon cannot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum PolygonFault {
    /// It turns the other way at this corner, from 0, or goes round more than once.
    NotConvex {
        /// The corner; 0 if it is no single one.
        corner: usize,
    },
    /// A triangle of the fan, the one that ends at this corner, leans away from the whole by more than 60°.
    NotFlat {
        /// The corner.
        corner: usize,
    },
}

/// Sine of how far a corner may turn back: what rounding in a file makes of a straight edge.
const STRAIGHT: f64 = 1e-3;
/// Cosine of how far a triangle may lean away.
const LEAN: f64 = 0.5;

/// Checks a polygon: once around, never back, and flat enough that its fan covers it.
///
/// One without area is let through: nothing of it is drawn.
pub(crate) fn check(corners: &[[f64; 3]]) -> Result<(), PolygonFault> {
    let count = corners.len();
    // About the first corner and of size 1, so that squares neither overflow nor vanish.
    let side = |to: [f64; 3]| [0, 1, 2].map(|axis| to[axis] - corners[0][axis]);
    let size = corners.iter().flat_map(|corner| side(*corner)).fold(0.0f64, |size, part| size.max(part.abs()));
    if !(size > 0.0 && size.is_finite()) {
        return Ok(());
    }
    let at = |corner: usize| side(corners[corner % count]).map(|part| part / size);
    // Twice the area along the normal, by Newell's sum.
    let sum = (0..count).map(|corner| cross(at(corner), at(corner + 1))).fold([0.0; 3], plus);
    let area = length(sum);
    if area < 1e-12 {
        return Ok(());
    }
    let normal = sum.map(|part| part / area);
    let mut turned = 0.0;
    for corner in 0..count {
        let incoming = along(normal, minus(at(corner), at(corner + count - 1)));
        let outgoing = along(normal, minus(at(corner + 1), at(corner)));
        let (sine, cosine) = (dot(cross(incoming, outgoing), normal), dot(incoming, outgoing));
        if sine < -STRAIGHT * length(incoming) * length(outgoing) {
            return Err(PolygonFault::NotConvex { corner });
        }
        turned += sine.atan2(cosine);
    }
    if turned > 1.5 * TAU {
        return Err(PolygonFault::NotConvex { corner: 0 });
    }
    for corner in 2..count {
        let part = cross(at(corner - 1), at(corner));
        // What is a thousandth of the whole shows no lean.
        if length(part) > 1e-3 * area && dot(part, normal) < LEAN * length(part) {
            return Err(PolygonFault::NotFlat { corner });
        }
    }
    Ok(())
}

/// Returns the unit normal of a counter-clockwise polygon; zero for a degenerate one.
pub(crate) fn normal(corners: &[[f64; 3]]) -> [f64; 3] {
    let Some(first) = corners.first() else { return [0.0; 3] };
    let side = |to: &[f64; 3]| [0, 1, 2].map(|axis| to[axis] - first[axis]);
    let size = corners.iter().flat_map(side).fold(0.0f64, |size, part| size.max(part.abs()));
    if !(size > 0.0 && size.is_finite()) {
        return [0.0; 3];
    }
    let at = |corner: &[f64; 3]| side(corner).map(|part| part / size);
    let sum = corners.windows(2).map(|pair| cross(at(&pair[0]), at(&pair[1]))).fold([0.0; 3], plus);
    let length = length(sum);
    sum.map(|part| if length > 0.0 { part / length } else { 0.0 })
}

fn plus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The part of a vector that lies in the plane with this unit normal.
fn along(normal: [f64; 3], a: [f64; 3]) -> [f64; 3] {
    let height = dot(a, normal);
    [0, 1, 2].map(|axis| a[axis] - height * normal[axis])
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on_circle(angles: impl IntoIterator<Item = u32>) -> Vec<[f64; 3]> {
        angles
            .into_iter()
            .map(|degrees| {
                let angle = f64::from(degrees).to_radians();
                // In a slanted plane, far from the origin and small.
                [100.0 + 1e-3 * angle.cos(), 1e-3 * angle.sin(), 5.0 + 5e-4 * angle.cos()]
            })
            .collect()
    }

    #[test]
    fn regular_polygons_are_convex_either_way_round() {
        for corners in 3..40 {
            let polygon = on_circle((0..corners).map(|corner| corner * 360 / corners));
            assert_eq!(check(&polygon), Ok(()), "{corners}");
            let back: Vec<_> = polygon.into_iter().rev().collect();
            assert_eq!(check(&back), Ok(()), "{corners} backwards");
        }
    }

    #[test]
    fn corners_on_an_edge_and_doubled_ones_do_no_harm() {
        let square =
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]];
        assert_eq!(check(&square), Ok(()));
        assert_eq!(check(&[[3.0; 3]; 5]), Ok(()));
        assert_eq!(check(&[[0.0; 3], [1.0; 3], [2.0; 3], [3.0; 3]]), Ok(()));
    }

    #[test]
    fn dents_stars_and_second_rounds_are_found() {
        let dent = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 4.0, 0.0]];
        assert_eq!(check(&dent), Err(PolygonFault::NotConvex { corner: 2 }));
        assert_eq!(check(&on_circle([0, 144, 288, 72, 216])), Err(PolygonFault::NotConvex { corner: 0 }));
        let twice = on_circle([0, 90, 180, 270, 5, 95, 185, 275]);
        assert_eq!(check(&twice), Err(PolygonFault::NotConvex { corner: 0 }));
        let bow = [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
        assert!(matches!(check(&bow), Err(PolygonFault::NotConvex { .. })));
    }

    #[test]
    fn a_bent_square_is_flat_enough_and_a_folded_one_is_not() {
        let bent = |height: f64| [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, height], [0.0, 1.0, 0.0]];
        assert_eq!(check(&bent(0.3)), Ok(()));
        let folded = [[0.0, 0.0, 0.0], [1.0, 0.0, 3.0], [1.0, 1.0, 0.0], [0.0, 1.0, 3.0]];
        assert!(matches!(check(&folded), Err(PolygonFault::NotFlat { .. })), "{:?}", check(&folded));
    }

    #[test]
    fn a_normal_is_of_the_whole_polygon() {
        let normal = normal(&[[0.0, 0.0, 0.0], [1e-90, 0.0, 0.0], [1e-90, 1e-90, 0.0], [0.0, 1e-90, 0.0]]);
        assert!((normal[2] - 1.0).abs() < 1e-9, "{normal:?}");
        assert_eq!(super::normal(&[[1.0; 3]; 4]), [0.0; 3]);
    }
}
