//! What `geometry` makes of vertices and faces, kept to be looked at.
//!
//! The tests reach `geometry`'s drawing through here alone.

use fpga_regs::packet::{FlatTriangle, Header, Packet};
use geometry::mesh::Position;
use geometry::setup::{doubled_area, set_up};
use geometry::{
    Culling, DrawStatistics, Face, Matrix, Mesh, ObjectLight, ScreenTransform, ScreenVertex, Sink, Transformed, Winding,
};

/// A triangle that went to the sink.
#[derive(Debug, Clone, Copy)]
pub struct Drawn {
    /// The packet.
    pub triangle: FlatTriangle,
    /// The corners that it was made from.
    pub corners: [ScreenVertex; 3],
}

/// All triangles that went to the sink, in order.
#[derive(Debug, Clone)]
pub struct Collector {
    /// The triangles.
    pub drawn: Vec<Drawn>,
    room: [u32; Packet::MAX_WORDS],
}

impl Default for Collector {
    fn default() -> Self {
        Self { drawn: Vec::new(), room: [0; Packet::MAX_WORDS] }
    }
}

impl Sink for Collector {
    fn room<const N: usize>(&mut self) -> Option<&mut [u32; N]> {
        self.room = [0; Packet::MAX_WORDS];
        self.room.first_chunk_mut()
    }

    fn take<const N: usize>(&mut self, drawn: geometry::Drawn<'_>) {
        let geometry::Drawn::Flat { corners, .. } = drawn else { panic!("{drawn:?} was not asked for") };
        let corners = corners.map(|corner| *corner);
        match Packet::decode(Header(self.room[0]), &self.room[1..N]) {
            Ok(Packet::FlatTriangle(triangle)) => self.drawn.push(Drawn { triangle, corners }),
            other => panic!("{corners:?} came out as {other:?}"),
        }
    }
}

/// Draws faces, each of three corners, in full light, and returns the triangles and the counts.
///
/// # Panics
/// If a face names a corner that is not there.
pub fn draw_faces(
    positions: &[Position],
    faces: &[[u32; 3]],
    winding: Winding,
    model_to_clip: &Matrix,
    culling: Culling,
) -> (Vec<Drawn>, DrawStatistics) {
    let faces: Vec<Face> =
        faces.iter().map(|corners| Face { corners: *corners, colour: [255; 3], ..Face::default() }).collect();
    let mesh = Mesh::new(positions, &faces, winding).expect("the faces name corners that are there");
    let transform = ScreenTransform::new(model_to_clip, &mesh);
    let mut cache = vec![ScreenVertex::default(); positions.len()];
    let mut sink = Collector::default();
    let statistics = geometry::draw(&mesh, &transform, &ObjectLight::FULL, culling, &mut cache, &mut sink)
        .expect("the cache is as long as the mesh");
    (sink.drawn, statistics)
}

/// Transforms the vertices of one mesh, as drawing it does. A vertex that has to be clipped comes
/// back as `None`.
///
/// # Panics
/// Never: a mesh without faces has nothing wrong with it.
pub fn transform(positions: &[Position], model_to_clip: &Matrix) -> Vec<Option<ScreenVertex>> {
    let mesh = Mesh::new(positions, &[], Winding::CounterClockwise).expect("no face names a missing corner");
    let transform = ScreenTransform::new(model_to_clip, &mesh);
    let mut cache = vec![ScreenVertex::default(); positions.len()];
    Transformed::new(&mesh, &transform, &mut cache).expect("the cache is as long as the mesh");
    cache.into_iter().map(|vertex| (vertex.outside == 0).then_some(vertex)).collect()
}

/// Sets up a triangle whose corners go either way round; `None` if it has no area or no pixel.
pub fn set_up_either_way([a, b, c]: [ScreenVertex; 3]) -> Option<FlatTriangle> {
    match doubled_area([&a, &b, &c]) {
        0 => None,
        ..0 => set_up([&a, &b, &c]),
        _ => set_up([&a, &c, &b]),
    }
}

/// Returns a vertex on the screen, in sixteenths of a pixel.
pub fn vertex((x, y): (i32, i32), depth: i32) -> ScreenVertex {
    ScreenVertex { x, y, depth, outside: 0 }
}
