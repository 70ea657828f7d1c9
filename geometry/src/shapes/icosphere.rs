//! A sphere of triangles that are nearly alike.

use fixed::types::{I4F28, I32F32};

use super::face_normal;
use crate::matrix::normalise;
use crate::mesh::{Face, Position};

/// Corners and faces of the icosahedron, which everything starts from.
const START: (usize, usize) = (12, 20);

/// Makes a sphere of radius 1 from an icosahedron whose faces are cut in four `levels` times: 20 · 4^levels
/// faces and half as many vertices and two, closed, counter-clockwise seen from outside, in one colour.
///
/// Returns the vertices and faces used, or `None` if either buffer is too small.
pub fn icosphere<'a>(
    levels: u32,
    colour: [u8; 3],
    positions: &'a mut [Position],
    faces: &'a mut [Face],
) -> Option<(&'a [Position], &'a [Face])> {
    let face_count = 4usize.checked_pow(levels)?.checked_mul(START.1)?;
    let faces = faces.get_mut(..face_count)?;
    let positions = positions.get_mut(..face_count / 2 + 2)?;
    let mut vertices = START.0;
    positions[..START.0].copy_from_slice(&icosahedron());
    for (face, corners) in faces.iter_mut().zip(FACES) {
        face.corners = corners.map(u32::from);
    }
    for level in 0..levels {
        // From the last face on: its parts take places that no face stands in any more.
        for index in (0..START.1 << (2 * level)).rev() {
            let [a, b, c] = faces[index].corners;
            let mut between = |from, to| middle(positions, &mut vertices, [from, to]);
            let [ab, bc, ca] = [between(a, b), between(b, c), between(c, a)];
            let parts = [[ab, bc, ca], [a, ab, ca], [b, bc, ab], [c, ca, bc]];
            for (face, corners) in faces[4 * index..].iter_mut().zip(parts) {
                face.corners = corners;
            }
        }
    }
    for face in faces.iter_mut() {
        let normal = face_normal(face.corners.map(|corner| &positions[corner as usize]));
        *face = Face { normal, colour, ..*face };
    }
    Some((positions, faces))
}

/// Returns the vertex on the sphere over the middle of an edge, a new one if no face has it yet.
fn middle(positions: &mut [Position], used: &mut usize, ends: [u32; 2]) -> u32 {
    let [from, to] = ends.map(|end| positions[end as usize].map(I32F32::from));
    // A sum does not depend on which end comes first, so both faces of an edge find the same point.
    let sum = [0, 1, 2].map(|axis| from[axis] + to[axis]);
    let point = normalise(sum).unwrap_or_default().map(I4F28::from_num);
    let known = positions[..*used].iter().position(|position| *position == point);
    known.unwrap_or_else(|| {
        positions[*used] = point;
        *used += 1;
        *used - 1
    }) as u32
}

/// Corners in the planes x = 0, y = 0, z = 0, four each.
fn icosahedron() -> [Position; START.0] {
    const SHORT: I4F28 = I4F28::lit("0.525731112");
    const LONG: I4F28 = I4F28::lit("0.850650808");
    let mut corners = [[I4F28::ZERO; 3]; START.0];
    for (index, corner) in corners.iter_mut().enumerate() {
        let plane = index / 4;
        corner[(plane + 1) % 3] = if index & 1 == 0 { SHORT } else { -SHORT };
        corner[(plane + 2) % 3] = if index & 2 == 0 { LONG } else { -LONG };
    }
    corners
}

/// Corners of its faces.
#[rustfmt::skip]
const FACES: [[u8; 3]; START.1] = [
    [0, 1, 4], [0, 6, 1], [0, 4, 8], [0, 9, 6], [0, 8, 9],
    [1, 10, 4], [1, 6, 11], [1, 11, 10], [2, 5, 3], [2, 3, 7],
    [2, 8, 5], [2, 7, 9], [2, 9, 8], [3, 5, 10], [3, 11, 7],
    [3, 10, 11], [4, 5, 8], [4, 10, 5], [6, 9, 7], [6, 7, 11],
];

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;
    use std::vec;

    #[test]
    fn the_sphere_is_closed_round_and_turned_outwards() {
        for levels in 0..4 {
            let count = 20 << (2 * levels);
            let (mut positions, mut faces) = (vec![[I4F28::ZERO; 3]; count / 2 + 2], vec![Face::default(); count]);
            let (positions, faces) = icosphere(levels, [9; 3], &mut positions, &mut faces).expect("it fits");
            let mut edges = BTreeMap::new();
            for face in faces {
                for (from, to) in [(0, 1), (1, 2), (2, 0)] {
                    *edges.entry((face.corners[from], face.corners[to])).or_insert(0) += 1;
                }
                // The normal points the way that the middle lies in.
                let [x, y, z] = [0, 1, 2].map(|axis| {
                    let corners = face.corners.map(|corner| positions[corner as usize][axis].to_num::<f64>());
                    corners.iter().sum::<f64>() / 3.0 * f64::from(face.normal[axis]) / 16_384.0
                });
                assert!(x + y + z > 0.79, "{face:?}");
            }
            // Euler: as many edges as corners and faces without two, each in both directions.
            assert_eq!(edges.len(), 2 * (positions.len() + faces.len() - 2));
            assert!(edges.iter().all(|((from, to), count)| *count == 1 && edges.contains_key(&(*to, *from))));
            for position in positions {
                let length = position.iter().map(|part| part.to_num::<f64>().powi(2)).sum::<f64>().sqrt();
                assert!((length - 1.0).abs() < 1e-7, "{position:?}");
            }
        }
        assert!(icosphere(1, [0; 3], &mut [[I4F28::ZERO; 3]; 41], &mut [Face::default(); 80]).is_none());
    }
}
