//! Meshes that the project makes itself, into buffers that the caller lends.

mod icosphere;
mod solid;

use fixed::types::{I4F28, I32F32};

use crate::angle::Angle;
use crate::matrix::{Vector, cross, normalise, subtract};
use crate::mesh::{Face, Position};

pub use icosphere::icosphere;
pub use solid::{Corners, MAX_FACET_CORNERS, Solid, SolidBuilder};

/// Returns the unit normal of a counter-clockwise face, Q2.14; zero for a degenerate one.
pub fn face_normal(corners: [&Position; 3]) -> [i16; 3] {
    let [a, b, c] = corners.map(|corner| corner.map(I32F32::from));
    // Small faces have tiny cross products: scaled up first, so that rounding leaves their direction.
    let larger = |vector: Vector| vector.map(|part| part.saturating_mul(I32F32::from_num(1 << 12)));
    let normal = normalise(cross(larger(subtract(b, a)), larger(subtract(c, a)))).unwrap_or_default();
    normal.map(|part| ((part.to_bits() + (1 << 17)) >> 18) as i16)
}

/// Makes a torus about the y axis: `rings` × `sides` vertices and twice as many faces, closed,
/// counter-clockwise seen from outside.
///
/// `radius` is from the axis to the middle of the tube, `tube` the tube's own. `colour` gives
/// the colour of the face pair at (ring, side). Returns the vertices and faces used, or `None`
/// if either buffer is too small or there are fewer than three rings or sides.
pub fn torus<'a>(
    (rings, sides): (u32, u32),
    (radius, tube): (I4F28, I4F28),
    colour: impl Fn(u32, u32) -> [u8; 3],
    positions: &'a mut [Position],
    faces: &'a mut [Face],
) -> Option<(&'a [Position], &'a [Face])> {
    if rings < 3 || sides < 3 {
        return None;
    }
    let count = rings.checked_mul(sides)? as usize;
    let positions = positions.get_mut(..count)?;
    let faces = faces.get_mut(..count.checked_mul(2)?)?;
    let part_of_turn = |index: u32, of: u32| Angle::from_bits(((u64::from(index) << 32) / u64::from(of)) as u32);
    for ring in 0..rings {
        let (ring_sine, ring_cosine) = part_of_turn(ring, rings).sin_cos();
        for side in 0..sides {
            let (side_sine, side_cosine) = part_of_turn(side, sides).sin_cos();
            let from_axis = radius + tube * I4F28::from_num(side_cosine);
            positions[(ring * sides + side) as usize] = [
                from_axis * I4F28::from_num(ring_sine),
                tube * I4F28::from_num(side_sine),
                from_axis * I4F28::from_num(ring_cosine),
            ];
        }
    }
    for ring in 0..rings {
        for side in 0..sides {
            let at = |ring: u32, side: u32| ring % rings * sides + side % sides;
            let (here, right) = (at(ring, side), at(ring + 1, side));
            let (above, across) = (at(ring, side + 1), at(ring + 1, side + 1));
            let pair = 2 * here as usize;
            for (face, corners) in faces[pair..pair + 2].iter_mut().zip([[here, right, across], [here, across, above]])
            {
                let normal = face_normal(corners.map(|corner| &positions[corner as usize]));
                *face = Face { corners, normal, colour: colour(ring, side) };
            }
        }
    }
    Some((positions, faces))
}
