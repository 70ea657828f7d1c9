//! Room for the meshes that are made at start.

use fixed::types::I4F28;
use geometry::look::looks_of_faces;
use geometry::mesh::Position;
use geometry::shapes::{Corners, SolidBuilder};
use geometry::{Face, Mesh, MeshError, VertexLook, Winding, wire};

use super::Model;

/// Room for what smooth shading and lines want of a mesh.
pub(super) struct LookMemory<const VERTICES: usize, const EDGES: usize> {
    looks: [VertexLook; VERTICES],
    edges: [[u32; 2]; EDGES],
}

/// Room for a mesh that is made at start, and its looks and edges.
///
/// While edges are looked for among the faces there must be room for three a face.
pub(super) struct MadeMemory<const VERTICES: usize, const FACES: usize, const EDGES: usize> {
    positions: [Position; VERTICES],
    faces: [Face; FACES],
    look: LookMemory<VERTICES, EDGES>,
}

/// Makes positions and faces in the buffers that it gets, and returns those that it used.
pub(super) type Make = for<'b> fn(&'b mut [Position], &'b mut [Face]) -> Option<(&'b [Position], &'b [Face])>;

impl<const VERTICES: usize, const EDGES: usize> LookMemory<VERTICES, EDGES> {
    pub(super) const fn new() -> Self {
        Self { looks: [VertexLook::new([0; 3], [0; 3]); VERTICES], edges: [[0; 2]; EDGES] }
    }

    /// Returns the model of a mesh. `counts` is scratch, one for each vertex.
    pub(super) fn model<'a>(&'a mut self, mesh: Mesh<'a>, counts: &mut [u16]) -> Model<'a> {
        let (looks, edges) = (&mut self.looks[..], &mut self.edges[..]);
        // The memory is as large as the mesh, so both are always made.
        let looks = looks_of_faces(&mesh, looks, counts).unwrap_or(&[]);
        Model { mesh, looks, edges: wire::edges(&mesh, edges).unwrap_or(&[]) }
    }
}

impl<const VERTICES: usize, const FACES: usize, const EDGES: usize> MadeMemory<VERTICES, FACES, EDGES> {
    pub(super) const fn new() -> Self {
        Self {
            positions: [[I4F28::ZERO; 3]; VERTICES],
            faces: [Face { corners: [0; 3], normal: [0; 3], colour: [0; 3] }; FACES],
            look: LookMemory::new(),
        }
    }

    /// Makes a model of triangles.
    ///
    /// # Errors
    /// [`MeshError`] if a face names a missing corner.
    pub(super) fn triangles<'a>(&'a mut self, make: Make, counts: &mut [u16]) -> Result<Model<'a>, MeshError> {
        // The memory is as large as the mesh, so it is always made.
        let (positions, faces) = make(&mut self.positions, &mut self.faces).unwrap_or((&[], &[]));
        Ok(self.look.model(Mesh::new(positions, faces, Winding::CounterClockwise)?, counts))
    }

    /// Makes a model of facets; its edges are theirs. `colour` gives a vertex's, if not the mean of its facets'.
    ///
    /// # Errors
    /// [`MeshError`] if a face names a missing corner.
    pub(super) fn solid<'a>(
        &'a mut self,
        corners: Corners,
        build: impl FnOnce(&mut SolidBuilder<'a>),
        colour: Option<fn(&Position) -> [u8; 3]>,
        counts: &mut [u16],
    ) -> Result<Model<'a>, MeshError> {
        let mut builder = SolidBuilder::new(&mut self.positions, &mut self.faces, &mut self.look.edges, corners);
        build(&mut builder);
        // The memory is as large as the solid, so it is always made.
        let (positions, faces, edges) =
            builder.finish().map_or((&[][..], &[][..], &[][..]), |made| (made.positions, made.faces, made.edges));
        let mesh = Mesh::new(positions, faces, Winding::CounterClockwise)?;
        let looks = &mut self.look.looks;
        if looks_of_faces(&mesh, looks, counts).is_some()
            && let Some(colour) = colour
        {
            for (look, position) in looks.iter_mut().zip(positions) {
                *look = VertexLook::new(look.normal(), colour(position));
            }
        }
        Ok(Model { mesh, looks, edges })
    }
}
