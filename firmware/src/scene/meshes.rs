//! The meshes that scenes put together.

use fixed::types::I4F28;
use geometry::look::looks_of_faces;
use geometry::{Face, Mesh, MeshError, VertexLook, Winding, mesh::Position, shapes, wire};

use super::plate;

/// Rings and sides of the torus: 2,048 vertices and 4,096 triangles.
const TORUS_RINGS: u32 = 64;
const TORUS_SIDES: u32 = 32;
const TORUS_VERTICES: usize = (TORUS_RINGS * TORUS_SIDES) as usize;
/// Distance of the torus's tube from its axis.
pub const TORUS_RADIUS: I4F28 = I4F28::lit("1");
/// Radius of the tube.
pub const TORUS_TUBE: I4F28 = I4F28::lit("0.45");

/// Vertices of the largest mesh.
pub const MAX_VERTICES: usize = TORUS_VERTICES;

/// A mesh, by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// The plate: 120 faces, its top slightly domed.
    Plate,
    /// A torus about the y axis, of 4,096 faces.
    Torus,
}

/// Room for the meshes that are made at start.
pub struct MeshMemory {
    positions: [Position; TORUS_VERTICES],
    faces: [Face; 2 * TORUS_VERTICES],
    plate: LookMemory<{ plate::POSITIONS.len() }, { 3 * plate::FACES.len() }>,
    torus: LookMemory<TORUS_VERTICES, { 6 * TORUS_VERTICES }>,
    counts: [u16; MAX_VERTICES],
}

/// Room for what smooth shading and lines want of a mesh.
struct LookMemory<const VERTICES: usize, const CORNERS: usize> {
    looks: [VertexLook; VERTICES],
    edges: [[u32; 2]; CORNERS],
}

impl<const VERTICES: usize, const CORNERS: usize> LookMemory<VERTICES, CORNERS> {
    const fn new() -> Self {
        Self { looks: [VertexLook::new([0; 3], [0; 3]); VERTICES], edges: [[0; 2]; CORNERS] }
    }
}

/// A mesh with all that any style needs of it.
#[derive(Debug, Clone, Copy)]
pub struct Model<'a> {
    /// The mesh.
    pub mesh: Mesh<'a>,
    /// What each vertex looks like.
    pub looks: &'a [VertexLook],
    /// Its edges, each once.
    pub edges: &'a [[u32; 2]],
}

impl<'a> Model<'a> {
    fn new<const VERTICES: usize, const CORNERS: usize>(
        mesh: Mesh<'a>,
        memory: &'a mut LookMemory<VERTICES, CORNERS>,
        counts: &mut [u16],
    ) -> Self {
        // The memory is as large as the mesh, so both are always made.
        let looks = looks_of_faces(&mesh, &mut memory.looks, counts).unwrap_or(&[]);
        let edges = wire::edges(&mesh, &mut memory.edges).unwrap_or(&[]);
        Self { mesh, looks, edges }
    }
}

impl MeshMemory {
    /// Empty memory, for a static.
    pub const fn new() -> Self {
        Self {
            positions: [[I4F28::ZERO; 3]; TORUS_VERTICES],
            faces: [Face { corners: [0; 3], normal: [0; 3], colour: [0; 3] }; 2 * TORUS_VERTICES],
            plate: LookMemory::new(),
            torus: LookMemory::new(),
            counts: [0; MAX_VERTICES],
        }
    }
}

impl Default for MeshMemory {
    fn default() -> Self {
        Self::new()
    }
}

/// All meshes.
#[derive(Debug, Clone, Copy)]
pub struct Meshes<'a> {
    plate: Model<'a>,
    torus: Model<'a>,
}

impl<'a> Meshes<'a> {
    /// Makes the meshes that are not constants, in `memory`.
    ///
    /// # Errors
    /// [`MeshError`] if a mesh is malformed, which a test rules out for those built in.
    pub fn new(memory: &'a mut MeshMemory) -> Result<Self, MeshError> {
        let made = shapes::torus(
            (TORUS_RINGS, TORUS_SIDES),
            (TORUS_RADIUS, TORUS_TUBE),
            torus_colour,
            &mut memory.positions,
            &mut memory.faces,
        );
        // The memory is as large as the torus, so it is always made.
        let (positions, faces) = made.unwrap_or((&[], &[]));
        let plate = Mesh::new(&plate::POSITIONS, &plate::FACES, Winding::Clockwise)?;
        let torus = Mesh::new(positions, faces, Winding::CounterClockwise)?;
        Ok(Self {
            plate: Model::new(plate, &mut memory.plate, &mut memory.counts),
            torus: Model::new(torus, &mut memory.torus, &mut memory.counts),
        })
    }

    /// Returns the mesh of a shape.
    pub fn of(&self, shape: Shape) -> &Model<'a> {
        match shape {
            Shape::Plate => &self.plate,
            Shape::Torus => &self.torus,
        }
    }
}

/// Four bright stripes that wind round the tube, chequered.
fn torus_colour(ring: u32, side: u32) -> [u8; 3] {
    const STRIPES: [[u8; 3]; 4] = [[255, 90, 60], [255, 210, 70], [70, 200, 130], [80, 130, 255]];
    let stripe = STRIPES[((ring / 4 + side / 8) % 4) as usize];
    if (ring / 2 + side / 4).is_multiple_of(2) { stripe } else { stripe.map(|channel| channel - channel / 4) }
}
