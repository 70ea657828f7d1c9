//! Smooth shading and lines of a mesh: the same triangles as flat ones, colours that clipping mixes
//! as space does, every line where its ends are.

use fpga_regs::packet::{FlatTriangle, GouraudTriangle, Header, Packet, PixelMode, TriangleShape};
use fpga_regs::screen::Rgb332;
use geometry::clip::{Corner, clip};
use geometry::look::{LitColour, VertexLook};
use geometry::mesh::Position;
use geometry::transform::Homogeneous;
use geometry::{
    Angle, Culling, Drawn, Face, LineStyle, Matrix, Mesh, ObjectLight, ScreenTransform, ScreenVertex, Sink,
    Transformed, Unlit, Winding,
};
use host_tests::rng::Rng;

/// Decoded packets, in order.
struct Packets {
    room: [u32; Packet::MAX_WORDS],
    seen: Vec<Packet>,
}

impl Packets {
    fn new() -> Self {
        Self { room: [0; Packet::MAX_WORDS], seen: Vec::new() }
    }

    fn shapes(&self) -> Vec<TriangleShape> {
        let shape = |packet: &Packet| match packet {
            Packet::FlatTriangle(FlatTriangle { shape, .. }) => *shape,
            Packet::GouraudTriangle(GouraudTriangle { shape, .. }) => *shape,
            other => panic!("{other:?} is no triangle"),
        };
        self.seen.iter().map(shape).collect()
    }
}

impl Sink for Packets {
    fn room<const N: usize>(&mut self) -> Option<&mut [u32; N]> {
        self.room = [0xdead_beef; Packet::MAX_WORDS];
        self.room.first_chunk_mut()
    }

    fn take<const N: usize>(&mut self, _: Drawn<'_>) {
        self.seen.push(Packet::decode(Header(self.room[0]), &self.room[1..N]).expect("a good packet"));
    }
}

fn any_matrix(rng: &mut Rng) -> Matrix {
    let number = |value: f64| fixed::types::I32F32::from_num(value);
    let angle = |rng: &mut Rng| Angle::from_bits(rng.word());
    let model = Matrix::rotation_y(angle(rng)).times(&Matrix::rotation_x(angle(rng)));
    let back = Matrix::translation([0, 0, 0].map(|_| number(f64::from(rng.within(-100, 100)) / 100.0)))
        .times(&Matrix::translation([number(0.0), number(0.0), number(-1.2)]));
    let field = Angle::from_degrees(fixed::types::I16F16::from_num(60));
    Matrix::perspective(field, number(4.0 / 3.0), number(0.5), number(4.0)).times(&back).times(&model)
}

struct Soup {
    positions: Vec<Position>,
    faces: Vec<Face>,
    looks: Vec<VertexLook>,
}

fn soup(rng: &mut Rng) -> Soup {
    let positions: Vec<Position> = (0..24)
        .map(|_| {
            [0; 3].map(|_| {
                Position::default()[0] + fixed::types::I4F28::from_num(f64::from(rng.within(-150, 150)) / 100.0)
            })
        })
        .collect();
    let faces = (0..40)
        .map(|_| Face { corners: [0; 3].map(|_| rng.below(24)), colour: [9; 3], ..Face::default() })
        .filter(|face| face.corners[0] != face.corners[1])
        .collect();
    let looks = (0..24).map(|_| VertexLook::new([0; 3], [0; 3].map(|_| rng.within(0, 255) as u8))).collect();
    Soup { positions, faces, looks }
}

#[test]
fn smooth_unlit_and_flat_triangles_have_the_same_shapes() {
    let mut rng = Rng(81);
    let (mut triangles, mut clipped) = (0, 0);
    for round in 0..400 {
        let soup = soup(&mut rng);
        let mesh = Mesh::new(&soup.positions, &soup.faces, Winding::CounterClockwise).expect("a mesh");
        let transform = ScreenTransform::new(&any_matrix(&mut rng), &mesh);
        let mut cache = vec![ScreenVertex::default(); 24];
        let transformed = Transformed::new(&mesh, &transform, &mut cache).expect("large enough");
        let culling = if round % 2 == 0 { Culling::None } else { Culling::BackFaces };
        let (mut flat, mut smooth, mut grey) = (Packets::new(), Packets::new(), Packets::new());
        let light = ObjectLight::FULL;
        let statistics = transformed.draw(&light, culling, &mut flat);
        let mut lit = [LitColour::default(); 24];
        let smooth_statistics = {
            let colours = transformed.light_vertices(&soup.looks, &light, &mut lit).expect("large enough");
            transformed.draw_smooth(&colours, culling, &mut smooth)
        };
        assert_eq!(statistics, smooth_statistics);
        assert_eq!(statistics, transformed.draw_unlit(Unlit::DEPTH_GREY, culling, &mut grey));
        assert_eq!(flat.shapes(), smooth.shapes());
        assert_eq!(flat.shapes(), grey.shapes());
        triangles += statistics.drawn;
        clipped += statistics.clipped;
        let short = transformed.light_vertices(&soup.looks, &light, &mut lit[1..]);
        assert_eq!(
            short.expect_err("too short").to_string(),
            "the mesh has 24 vertices, the vertex cache holds 23: lend a larger one"
        );
    }
    println!("{triangles} triangles, {clipped} clipped faces");
    assert!(triangles > 3_000 && clipped > 1_000);
}

/// Two of a corner's channels as weights: a point's colour then says where in the triangle it is.
#[test]
fn clipping_mixes_colours_as_space_does() {
    let mut rng = Rng(82);
    let mut mixed = 0;
    for _ in 0..50_000 {
        let size = 1 << rng.within(20, 28);
        let corners = [0; 3].map(|_| {
            let mut part = || rng.within(-size, size);
            Homogeneous { x: part(), y: part(), z: part(), w: part() }
        });
        let colours = [[0, 0, 255], [255, 0, 255], [0, 255, 255]];
        let polygon = clip([0, 1, 2].map(|index: usize| Corner { at: corners[index], colour: colours[index] }));
        for corner in polygon.corners() {
            let [second, third] = [0, 1].map(|channel: usize| f64::from(corner.colour[channel]) / 255.0);
            let weights = [1.0 - second - third, second, third];
            let parts: [fn(&Homogeneous) -> i32; 4] = [|it| it.x, |it| it.y, |it| it.z, |it| it.w];
            for part in parts {
                let found = f64::from(part(&corner.at));
                let exact: f64 =
                    weights.iter().zip(&corners).map(|(weight, corner)| weight * f64::from(part(corner))).sum();
                // Each of up to seven cuts rounds a colour by half of 1/255.
                let allowed = 7.0 * f64::from(size) * 2.0 / 255.0;
                assert!((found - exact).abs() <= allowed, "{corner:?} of {corners:?}: {found}, by its colour {exact}");
            }
            mixed += u32::from(weights.iter().all(|weight| *weight < 0.999));
            assert_eq!(corner.colour[2], 255, "the same at every corner stays the same");
        }
    }
    assert!(mixed > 20_000, "only {mixed} corners were new");
}

#[test]
fn lines_of_a_mesh_are_cut_where_its_faces_are() {
    let mut rng = Rng(83);
    let style = LineStyle { colour: Rgb332(0x1c), mode: PixelMode { keep_depth: true, ..PixelMode::USUAL } };
    let (mut drawn, mut clipped) = (0, 0);
    for _ in 0..400 {
        let soup = soup(&mut rng);
        let mesh = Mesh::new(&soup.positions, &soup.faces, Winding::CounterClockwise).expect("a mesh");
        let transform = ScreenTransform::new(&any_matrix(&mut rng), &mesh);
        let mut cache = vec![ScreenVertex::default(); 24];
        let transformed = Transformed::new(&mesh, &transform, &mut cache).expect("large enough");
        let edges: Vec<[u32; 2]> = (0..60).map(|_| [rng.below(24), rng.below(24)]).collect();
        let turned: Vec<[u32; 2]> = edges.iter().map(|[from, to]| [*to, *from]).collect();
        let (mut one_way, mut other_way) = (Packets::new(), Packets::new());
        let statistics = transformed.draw_lines(&edges, &style, &mut one_way);
        assert_eq!(statistics, transformed.draw_lines(&turned, &style, &mut other_way));
        assert_eq!(one_way.seen, other_way.seen, "a line depends on which end comes first");
        assert_eq!(statistics.drawn as usize, one_way.seen.len());
        drawn += statistics.drawn;
        clipped += statistics.clipped;
        assert_eq!(transformed.draw_lines(&[[0, 24]], &style, &mut one_way).drawn, 0, "vertex 24 does not exist");
    }
    println!("{drawn} lines, {clipped} clipped");
    assert!(drawn > 5_000 && clipped > 2_000, "{drawn} lines, {clipped} clipped");
}
