//! A block of a mesh file as a mesh.

use fixed::types::I4F28;
use geometry::mesh::Position;
use geometry::{Face, Mesh, VertexLook, Winding};
use mesh_format::{Block, EDGES_MAX, FACES_MAX, Header, VERTICES_MAX};

use crate::scene::meshes::Model;

/// What a part of a file's normal is multiplied by to be Q2.14: 127 of it are 1.
const NORMAL_SCALE: i16 = 129;

/// Room for one block.
pub struct BlockMemory {
    positions: [Position; VERTICES_MAX],
    looks: [VertexLook; VERTICES_MAX],
    faces: [Face; FACES_MAX],
    edges: [[u32; 2]; EDGES_MAX],
}

impl BlockMemory {
    /// Empty memory, for a static.
    pub const fn new() -> Self {
        Self {
            positions: [[I4F28::ZERO; 3]; VERTICES_MAX],
            looks: [VertexLook::new([0; 3], [0; 3]); VERTICES_MAX],
            faces: [Face { corners: [0; 3], normal: [0; 3], colour: [0; 3] }; FACES_MAX],
            edges: [[0; 2]; EDGES_MAX],
        }
    }

    /// Returns a block as a mesh; `None` for one that is no file's.
    ///
    /// What the file leaves out of a face comes from its corners; where these have nothing either, the colour is the
    /// header's. Vertices without normals have no looks.
    pub fn decode<'m>(&'m mut self, header: &Header, block: &Block<'_>) -> Option<Model<'m>> {
        let positions = self.positions.get_mut(..block.positions.len())?;
        for (position, numbers) in positions.iter_mut().zip(block.positions) {
            let numbers = Block::position(*numbers);
            *position = [0, 1, 2].map(|axis| I4F28::from_bits(header.coordinate(axis, numbers[axis])));
        }
        let looks = self.looks.get_mut(..block.normals.len())?;
        for (index, (look, normal)) in looks.iter_mut().zip(block.normals).enumerate() {
            let colour = block.colours.get(index).copied().unwrap_or(header.colour);
            *look = VertexLook::new(normal.map(q2_14), colour);
        }
        let faces = self.faces.get_mut(..block.corners.len())?;
        for (index, (face, corners)) in faces.iter_mut().zip(block.corners).enumerate() {
            let normal = match block.face_normals.get(index) {
                Some(normal) => normal.map(q2_14),
                None => {
                    mean(block.normals, *corners, |part| i32::from(part as i8)).map(|part| part as i16 * NORMAL_SCALE)
                }
            };
            let colour = match block.face_colours.get(index) {
                Some(colour) => *colour,
                // A file has the colours of the faces, or those of the vertices, or one for all.
                None if block.face_normals.is_empty() && !block.colours.is_empty() => {
                    mean(block.colours, *corners, i32::from).map(|part| part as u8)
                }
                None => header.colour,
            };
            *face = Face { corners: corners.map(u32::from), normal, colour };
        }
        let edges = self.edges.get_mut(..block.edges.len())?;
        for (edge, ends) in edges.iter_mut().zip(block.edges) {
            *edge = ends.map(u32::from);
        }
        let mesh = Mesh::new(positions, faces, Winding::CounterClockwise).ok()?;
        Some(Model { mesh, looks, edges })
    }
}

impl Default for BlockMemory {
    fn default() -> Self {
        Self::new()
    }
}

/// Returns a part of a normal, Q2.14.
fn q2_14(part: u8) -> i16 {
    i16::from(part as i8) * NORMAL_SCALE
}

/// Returns the mean over a face's corners.
fn mean(parts: &[[u8; 3]], corners: [u8; 3], number: impl Fn(u8) -> i32) -> [i32; 3] {
    let of = corners.map(|corner| parts.get(usize::from(corner)).copied().unwrap_or_default());
    // Thirds, by 2¹⁶/3.
    [0, 1, 2].map(|axis| (of.iter().map(|part| number(part[axis])).sum::<i32>() * 21_846 + 0x7fff) >> 16)
}
