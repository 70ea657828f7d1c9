//! Solids of flat facets: convex polygons of any number of corners, as triangles.

use super::face_normal;
use crate::mesh::{Face, Position};

/// Most corners of a facet.
pub const MAX_FACET_CORNERS: usize = 16;

/// Whether facets that meet have corners in common.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Corners {
    /// They do: fewest vertices. Smooth shading rounds the edges off.
    #[default]
    Shared,
    /// Each facet has its own: it is level in smooth shading, too.
    Apart,
}

/// A solid that is made.
#[derive(Debug, Clone, Copy)]
pub struct Solid<'a> {
    /// Its vertices.
    pub positions: &'a [Position],
    /// Its triangles, counter-clockwise seen from outside.
    pub faces: &'a [Face],
    /// The edges of its facets, each once, without those between the triangles of one facet; and lines that are
    /// no facet's edge.
    pub edges: &'a [[u32; 2]],
}

/// Makes a solid, facet by facet, in buffers that the caller lends.
#[derive(Debug)]
pub struct SolidBuilder<'a> {
    positions: &'a mut [Position],
    faces: &'a mut [Face],
    edges: &'a mut [[u32; 2]],
    /// Of each.
    used: [usize; 3],
    corners: Corners,
    /// Nothing was left out.
    whole: bool,
}

impl<'a> SolidBuilder<'a> {
    /// Starts with nothing.
    pub fn new(
        positions: &'a mut [Position],
        faces: &'a mut [Face],
        edges: &'a mut [[u32; 2]],
        corners: Corners,
    ) -> Self {
        Self { positions, faces, edges, used: [0; 3], corners, whole: true }
    }

    /// Adds a facet: a convex polygon, its corners counter-clockwise seen from outside and in one plane, at
    /// most [`MAX_FACET_CORNERS`].
    ///
    /// It becomes a fan of triangles about its first corner. They have their corners in common, so on screen
    /// each pixel of the facet belongs to one of them; and all have the normal of the plane through the facet's
    /// first three corners, so one light falls on it.
    pub fn facet(&mut self, corners: &[Position], colour: [u8; 3]) {
        let mut indices = [0; MAX_FACET_CORNERS];
        let Some(indices) = indices.get_mut(..corners.len()).filter(|indices| indices.len() >= 3) else {
            self.whole = false;
            return;
        };
        for (index, corner) in indices.iter_mut().zip(corners) {
            *index = self.vertex(*corner, self.corners);
        }
        let normal = face_normal([&corners[0], &corners[1], &corners[2]]);
        for pair in indices[1..].windows(2) {
            match self.faces.get_mut(self.used[1]) {
                Some(face) => *face = Face { corners: [indices[0], pair[0], pair[1]], normal, colour },
                None => self.whole = false,
            }
            self.used[1] += 1;
        }
        for (place, index) in indices.iter().enumerate() {
            self.edge([*index, indices[(place + 1) % indices.len()]]);
        }
    }

    /// Adds a line that is no facet's edge.
    pub fn line(&mut self, ends: [Position; 2]) {
        let ends = ends.map(|end| self.vertex(end, Corners::Shared));
        self.edge(ends);
    }

    /// Returns the solid, or `None` when a buffer was too small, or a facet had too few or too many corners.
    pub fn finish(self) -> Option<Solid<'a>> {
        let [positions, faces, edges] = self.used;
        self.whole.then_some(())?;
        Some(Solid {
            positions: self.positions.get(..positions)?,
            faces: self.faces.get(..faces)?,
            edges: self.edges.get(..edges)?,
        })
    }

    fn vertex(&mut self, position: Position, corners: Corners) -> u32 {
        let used = self.used[0].min(self.positions.len());
        let known = match corners {
            Corners::Shared => self.positions[..used].iter().position(|known| *known == position),
            Corners::Apart => None,
        };
        let index = known.unwrap_or_else(|| {
            match self.positions.get_mut(used) {
                Some(free) => *free = position,
                None => self.whole = false,
            }
            self.used[0] += 1;
            used
        });
        index as u32
    }

    /// Adds an edge unless there is one between the same points.
    fn edge(&mut self, ends: [u32; 2]) {
        if !self.whole {
            return;
        }
        let points = |[from, to]: [u32; 2]| [self.positions[from as usize], self.positions[to as usize]];
        let [from, to] = points(ends);
        let known = self.edges[..self.used[2]].iter().any(|edge| [[from, to], [to, from]].contains(&points(*edge)));
        if !known {
            match self.edges.get_mut(self.used[2]) {
                Some(edge) => *edge = ends,
                None => self.whole = false,
            }
            self.used[2] += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fixed::types::I4F28;

    /// A box without a lid, and a line through it.
    fn tray(room: (usize, usize, usize), corners: Corners) -> Option<(usize, usize, usize)> {
        let (mut positions, mut faces, mut edges) = ([[I4F28::ZERO; 3]; 32], [Face::default(); 32], [[0; 2]; 32]);
        let at = |bits: usize| [0, 1, 2].map(|axis| if bits >> axis & 1 == 1 { I4F28::ONE } else { I4F28::NEG_ONE });
        let (positions, faces, edges) = (&mut positions[..room.0], &mut faces[..room.1], &mut edges[..room.2]);
        let mut tray = SolidBuilder::new(positions, faces, edges, corners);
        for facet in [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [0, 2, 3, 1], [4, 5, 7, 6]] {
            tray.facet(&facet.map(at), [7; 3]);
        }
        tray.line([at(0), at(7)]);
        tray.line([at(7), at(0)]);
        let solid = tray.finish()?;
        assert!(solid.faces.iter().all(|face| face.normal.iter().filter(|part| part.abs() == 1 << 14).count() == 1));
        Some((solid.positions.len(), solid.faces.len(), solid.edges.len()))
    }

    #[test]
    fn facets_become_fans_and_each_edge_is_there_once() {
        assert_eq!(tray((32, 32, 32), Corners::Shared), Some((8, 10, 13)));
        assert_eq!(tray((32, 32, 32), Corners::Apart), Some((20, 10, 13)));
    }

    #[test]
    fn what_does_not_fit_is_told() {
        assert!(tray((8, 10, 13), Corners::Shared).is_some());
        for room in [(7, 10, 13), (8, 9, 13), (8, 10, 12)] {
            assert_eq!(tray(room, Corners::Shared), None, "{room:?}");
        }
        let (mut positions, mut faces, mut edges) = ([[I4F28::ZERO; 3]; 9], [Face::default(); 9], [[0; 2]; 9]);
        let mut builder = SolidBuilder::new(&mut positions, &mut faces, &mut edges, Corners::Shared);
        builder.facet(&[[I4F28::ONE; 3]; 2], [0; 3]);
        assert!(builder.finish().is_none(), "a facet of two corners");
    }
}
