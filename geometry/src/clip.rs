//! Clipping in homogeneous space: near and far planes, w, and the guard band.
//!
//! Sutherland and Hodgman's algorithm ("Reentrant polygon clipping", CACM 17, 1974), a plane at
//! a time. The slow path: most triangles need none of it.

use crate::transform::{Homogeneous, SMALLEST_W, doubled_guard_band};

/// Planes that a triangle may cross.
pub(crate) const PLANES: usize = 7;
/// Corners of a triangle after each plane has added one.
pub const MAX_CORNERS: usize = 3 + PLANES;

/// A corner of a polygon.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Corner {
    /// Where it is.
    pub at: Homogeneous,
    /// Its colour: red, green, blue, 0…255. It changes linearly along an edge in space.
    pub colour: [u8; 3],
}

/// A convex polygon of at most [`MAX_CORNERS`] corners.
#[derive(Debug, Clone, Copy)]
pub struct Polygon {
    corners: [Corner; MAX_CORNERS],
    count: usize,
}

impl Polygon {
    fn empty() -> Self {
        let nowhere = Corner { at: Homogeneous { x: 0, y: 0, z: 0, w: 0 }, colour: [0; 3] };
        Self { corners: [nowhere; MAX_CORNERS], count: 0 }
    }

    fn push(&mut self, corner: Corner) {
        // A plane cuts a convex polygon in two points at most, so there is always room; a
        // polygon that rounding made concave loses a corner rather than the frame.
        if let Some(slot) = self.corners.get_mut(self.count) {
            *slot = corner;
            self.count += 1;
        }
    }

    /// Returns the corners in order.
    pub fn corners(&self) -> &[Corner] {
        &self.corners[..self.count]
    }
}

/// Signed distance of a vertex to a plane, positive inside, scaled by the plane's own factor.
/// Planes: 0 w, 1 near, 2 far, 3 right, 4 left, 5 bottom, 6 top of the guard band.
pub(crate) fn distance(vertex: &Homogeneous, plane: usize) -> i64 {
    let (w, guard) = (i64::from(vertex.w), i64::from(doubled_guard_band(vertex.w)));
    let doubled = |value: i32| 2 * i64::from(value);
    match plane {
        0 => w - i64::from(SMALLEST_W),
        1 => i64::from(vertex.z),
        2 => w - doubled(vertex.z),
        3 => guard - doubled(vertex.x),
        4 => guard + doubled(vertex.x),
        5 => guard - doubled(vertex.y),
        _ => guard + doubled(vertex.y),
    }
}

/// Returns the part of a triangle that lies inside all planes; empty if there is none.
///
/// The corners keep their order. An edge that two triangles share is cut at the same points in
/// both, whichever way round they take it, so clipping opens no cracks.
pub fn clip(triangle: [Corner; 3]) -> Polygon {
    let mut polygon = Polygon::empty();
    for corner in triangle {
        polygon.push(corner);
    }
    for plane in 0..PLANES {
        if polygon.corners().iter().all(|corner| distance(&corner.at, plane) >= 0) {
            continue;
        }
        polygon = clip_at(&polygon, plane);
    }
    for corner in &mut polygon.corners[..polygon.count] {
        corner.at = settled(corner.at);
    }
    polygon
}

/// A corner moved inside all planes, where rounding at a later plane has put it a unit or two
/// outside an earlier one.
fn settled(corner: Homogeneous) -> Homogeneous {
    let w = corner.w.max(SMALLEST_W);
    let guard = doubled_guard_band(w) / 2;
    Homogeneous { x: corner.x.clamp(-guard, guard), y: corner.y.clamp(-guard, guard), z: corner.z.clamp(0, w / 2), w }
}

fn clip_at(polygon: &Polygon, plane: usize) -> Polygon {
    let mut inside = Polygon::empty();
    let corners = polygon.corners();
    for (index, corner) in corners.iter().enumerate() {
        let next = &corners[(index + 1) % corners.len()];
        let (here, there) = (distance(&corner.at, plane), distance(&next.at, plane));
        if here >= 0 {
            inside.push(*corner);
        }
        if (here >= 0) != (there >= 0) {
            inside.push(cut(corner, here, next, there));
        }
    }
    inside
}

/// The corner between two others where the distance is 0.
fn cut(a: &Corner, here: i64, b: &Corner, there: i64) -> Corner {
    let (to_a, to_b) = (here.abs(), there.abs());
    let mixed = |channel: usize| {
        let (a, b) = (i64::from(a.colour[channel]), i64::from(b.colour[channel]));
        ((a * to_b + b * to_a + (to_a + to_b) / 2) / (to_a + to_b)) as u8
    };
    Corner { at: intersection(&a.at, here, &b.at, there), colour: [0, 1, 2].map(mixed) }
}

/// Returns the part of a line that lies inside all planes, if there is one.
///
/// The same, point for point, whichever end comes first.
pub fn clip_line([mut a, mut b]: [Homogeneous; 2]) -> Option<[Homogeneous; 2]> {
    for plane in 0..PLANES {
        let (here, there) = (distance(&a, plane), distance(&b, plane));
        match (here >= 0, there >= 0) {
            (true, true) => {}
            (false, false) => return None,
            (true, false) => b = intersection(&a, here, &b, there),
            (false, true) => a = intersection(&a, here, &b, there),
        }
    }
    Some([settled(a), settled(b)])
}

/// The point between two vertices where the distance is 0.
///
/// a·|d_b| + b·|d_a| over |d_a| + |d_b|: the same for (a, b) and (b, a). Each coordinate is
/// rounded once, half up.
fn intersection(a: &Homogeneous, here: i64, b: &Homogeneous, there: i64) -> Homogeneous {
    let (here, there) = (here.abs(), there.abs());
    let sum = here + there;
    // Coordinates are below 2²⁹ and distances below 2³¹, so the sums are below 2⁶².
    let between = |a: i32, b: i32| {
        let numerator = i64::from(a) * there + i64::from(b) * here;
        (numerator + sum / 2).div_euclid(sum) as i32
    };
    Homogeneous { x: between(a.x, b.x), y: between(a.y, b.y), z: between(a.z, b.z), w: between(a.w, b.w) }
}
