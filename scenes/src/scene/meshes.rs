//! The meshes that scenes put together.

mod balancer;
mod house;
mod memory;
mod solids;

use fixed::types::I4F28;
use geometry::mesh::Position;
use geometry::shapes::{Corners, icosphere, torus};
use geometry::{Face, Mesh, MeshError, VertexLook, Winding};

use super::found::{self, Found};
use super::plate;
use memory::{LookMemory, MadeMemory};

/// Rings and sides of the torus: 2,048 vertices and 4,096 triangles.
const TORUS: (u32, u32) = (64, 32);
const TORUS_VERTICES: usize = (TORUS.0 * TORUS.1) as usize;
/// Distance of the torus's tube from its axis.
pub const TORUS_RADIUS: I4F28 = I4F28::lit("1");
/// Radius of the tube.
pub const TORUS_TUBE: I4F28 = I4F28::lit("0.45");
/// The coarse torus: 240 vertices and 480 triangles.
const RING: (u32, u32) = (20, 12);
const RING_VERTICES: usize = (RING.0 * RING.1) as usize;
/// How often the sphere's icosahedron is cut: 162 vertices and 320 triangles.
const SPHERE_LEVELS: u32 = 2;
const SPHERE_FACES: usize = 20 << (2 * SPHERE_LEVELS);

/// Vertices of the largest mesh.
pub const MAX_VERTICES: usize = TORUS_VERTICES;

/// A mesh, by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// The plate: 120 faces, its rim sloping.
    Plate,
    /// A torus about the y axis, of 4,096 faces.
    Torus,
    /// A coarse torus about the y axis.
    Ring,
    /// A sphere of radius 1.
    Sphere,
    /// A box from −1 to 1 in all axes.
    Box,
    /// A pyramid from −1 to 1 in all axes, a colour at each corner.
    Pyramid,
    /// Twelve pentagons, its corners at a distance of 1.
    Dodecahedron,
    /// A prism of six sides about the y axis, of radius 1 and from y = −1 to 1.
    Prism,
    /// The same with twelve sides.
    Disc,
    /// A house of polygons and lines.
    House,
    /// The game's plate: chequered, its rim below.
    Board,
    /// The game's ball, of radius 1, striped.
    Ball,
    /// A flat ring of radius 1, lying.
    Hoop,
    /// A bright disc of radius 1, lying.
    Spot,
    /// A dark one.
    Shadow,
    /// The digit 0, standing, two high and a little wider than one.
    Zero,
    /// The digit 1, standing, two high and a little wider than one.
    One,
    /// The digit 2, standing, two high and a little wider than one.
    Two,
    /// The digit 3, standing, two high and a little wider than one.
    Three,
    /// The digit 4, standing, two high and a little wider than one.
    Four,
    /// The digit 5, standing, two high and a little wider than one.
    Five,
    /// The digit 6, standing, two high and a little wider than one.
    Six,
    /// The digit 7, standing, two high and a little wider than one.
    Seven,
    /// The digit 8, standing, two high and a little wider than one.
    Eight,
    /// The digit 9, standing, two high and a little wider than one.
    Nine,
}

impl Shape {
    /// All shapes.
    pub const ALL: [Self; 25] = [
        Self::Plate,
        Self::Torus,
        Self::Ring,
        Self::Sphere,
        Self::Box,
        Self::Pyramid,
        Self::Dodecahedron,
        Self::Prism,
        Self::Disc,
        Self::House,
        Self::Board,
        Self::Ball,
        Self::Hoop,
        Self::Spot,
        Self::Shadow,
        Self::Zero,
        Self::One,
        Self::Two,
        Self::Three,
        Self::Four,
        Self::Five,
        Self::Six,
        Self::Seven,
        Self::Eight,
        Self::Nine,
    ];

    /// The digits from 0 to 9: the last of all.
    pub const DIGITS: [Self; 10] = *Self::ALL.last_chunk().expect("there are more shapes than digits");
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

/// Room for the meshes that are made at start.
pub struct MeshMemory {
    plate: LookMemory<{ plate::POSITIONS.len() }, { 3 * plate::FACES.len() }>,
    torus: MadeMemory<TORUS_VERTICES, { 2 * TORUS_VERTICES }, { 6 * TORUS_VERTICES }>,
    ring: MadeMemory<RING_VERTICES, { 2 * RING_VERTICES }, { 6 * RING_VERTICES }>,
    sphere: MadeMemory<{ SPHERE_FACES / 2 + 2 }, SPHERE_FACES, { 3 * SPHERE_FACES }>,
    cuboid: MadeMemory<24, 12, 12>,
    pyramid: MadeMemory<16, 6, 8>,
    dodecahedron: MadeMemory<20, 36, 30>,
    prism: MadeMemory<12, 20, 18>,
    disc: MadeMemory<24, 44, 36>,
    house: MadeMemory<38, 26, 43>,
    balancer: balancer::Memory,
    counts: [u16; MAX_VERTICES],
}

impl MeshMemory {
    /// Empty memory, for a static.
    pub const fn new() -> Self {
        Self {
            plate: LookMemory::new(),
            torus: MadeMemory::new(),
            ring: MadeMemory::new(),
            sphere: MadeMemory::new(),
            cuboid: MadeMemory::new(),
            pyramid: MadeMemory::new(),
            dodecahedron: MadeMemory::new(),
            prism: MadeMemory::new(),
            disc: MadeMemory::new(),
            house: MadeMemory::new(),
            balancer: balancer::Memory::new(),
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
    /// In the order of [`Shape::ALL`], whose last ones are the game's.
    models: [Model<'a>; Shape::ALL.len() - balancer::COUNT],
    balancer: [Model<'a>; balancer::COUNT],
    /// The model of a mesh file.
    found: Option<Found<'a>>,
}

impl<'a> Meshes<'a> {
    /// Makes the meshes that are not constants, in `memory`.
    ///
    /// # Errors
    /// [`MeshError`] if a mesh is malformed, which a test rules out for those built in.
    pub fn new(memory: &'a mut MeshMemory) -> Result<Self, MeshError> {
        let counts = &mut memory.counts[..];
        let plate = Mesh::new(&plate::POSITIONS, &plate::FACES, Winding::Clockwise)?;
        let (grey, steel) = ([235, 235, 235], [150, 160, 190]);
        Ok(Self {
            models: [
                memory.plate.model(plate, counts),
                memory.torus.triangles(|positions, faces| doughnut(TORUS, positions, faces), counts)?,
                memory.ring.triangles(|positions, faces| doughnut(RING, positions, faces), counts)?,
                memory.sphere.triangles(
                    |positions, faces| icosphere(SPHERE_LEVELS, [255, 235, 215], positions, faces),
                    counts,
                )?,
                memory.cuboid.solid(
                    Corners::Apart,
                    |solid| solids::cuboid(solid, [I4F28::NEG_ONE; 3], [I4F28::ONE; 3], [Some(grey); 6]),
                    None,
                    counts,
                )?,
                memory.pyramid.solid(
                    Corners::Apart,
                    |solid| solids::pyramid(solid, [255, 200, 120]),
                    Some(solids::pyramid_colour),
                    counts,
                )?,
                memory.dodecahedron.solid(Corners::Shared, solids::dodecahedron, None, counts)?,
                memory.prism.solid(
                    Corners::Shared,
                    |solid| solids::prism(solid, 6, [[255, 90, 60]; 2], &[[255, 220, 80], [90, 200, 255]]),
                    None,
                    counts,
                )?,
                memory.disc.solid(
                    Corners::Shared,
                    |solid| solids::prism(solid, 12, [steel; 2], &[grey]),
                    None,
                    counts,
                )?,
                memory.house.solid(Corners::Shared, house::house, None, counts)?,
            ],
            balancer: memory.balancer.models(counts)?,
            // Made by `cargo xtask mesh`; a test reads it.
            found: Found::new(found::BUILT_IN).ok(),
        })
    }

    /// Returns the model of a mesh file: the one that is built in, until there is another.
    pub fn found(&self) -> Option<&Found<'a>> {
        self.found.as_ref()
    }

    /// Has another mesh file's model in place of the one that is built in.
    pub fn set_found(&mut self, found: Found<'a>) {
        self.found = Some(found);
    }

    /// Returns the mesh of a shape.
    pub fn of(&self, shape: Shape) -> &Model<'a> {
        let index = shape as usize;
        self.models.get(index).unwrap_or_else(|| &self.balancer[index - self.models.len()])
    }
}

/// The torus, in so many rings and sides.
fn doughnut<'b>(
    rings_and_sides: (u32, u32),
    positions: &'b mut [Position],
    faces: &'b mut [Face],
) -> Option<(&'b [Position], &'b [Face])> {
    torus(rings_and_sides, (TORUS_RADIUS, TORUS_TUBE), torus_colour, positions, faces)
}

/// Four bright stripes that wind round the tube, chequered.
fn torus_colour(ring: u32, side: u32) -> [u8; 3] {
    const STRIPES: [[u8; 3]; 4] = [[255, 90, 60], [255, 210, 70], [70, 200, 130], [80, 130, 255]];
    let stripe = STRIPES[((ring / 4 + side / 8) % 4) as usize];
    if (ring / 2 + side / 4).is_multiple_of(2) { stripe } else { stripe.map(|channel| channel - channel / 4) }
}
