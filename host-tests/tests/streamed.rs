//! A mesh file that is drawn block by block gives the words of the mesh drawn whole.

use std::path::Path;

use firmware::scene::found::{BUILT_IN, BlockMemory, Found};
use geometry::{
    Culling, DirectionalLight, Drawn, Face, LitColour, Matrix, Mesh, ObjectLight, ScreenTransform, ScreenVertex, Sink,
    Transformed, VertexLook, Winding,
};
use mesh_format::Block;
use models::compile::{Looks, Options, compile};
use models::{Model, obj};

/// Keeps all words.
#[derive(Default)]
struct Words {
    room: Vec<u32>,
    words: Vec<u32>,
}

impl Sink for Words {
    fn room<const N: usize>(&mut self) -> Option<&mut [u32; N]> {
        self.room.resize(N.max(self.room.len()), 0);
        self.room.first_chunk_mut()
    }

    fn take<const N: usize>(&mut self, _: Drawn<'_>) {
        self.words.extend(&self.room[..N]);
    }
}

/// How a mesh is looked at.
struct Sight {
    model_to_clip: Matrix,
    light: ObjectLight,
}

fn draw(
    mesh: &Mesh<'_>,
    looks: Option<&[VertexLook]>,
    transform: &ScreenTransform,
    light: &ObjectLight,
    words: &mut Words,
) {
    let mut cache = vec![ScreenVertex::default(); mesh.positions().len()];
    let transformed = Transformed::new(mesh, transform, &mut cache).expect("as large as the mesh");
    match looks {
        None => transformed.draw(light, Culling::BackFaces, words),
        Some(looks) => {
            let mut lit = vec![LitColour::default(); looks.len()];
            let lit = transformed.light_vertices(looks, light, &mut lit).expect("as large as the mesh");
            transformed.draw_smooth(&lit, Culling::BackFaces, words)
        }
    };
}

/// The words of a file, block by block, and of all its blocks put together.
fn both_ways(bytes: &[u8], sight: &Sight, smooth: bool) -> [Vec<u32>; 2] {
    let found = Found::new(bytes).expect("a good file");
    let transform = ScreenTransform::of_extent(&sight.model_to_clip.times(found.fit()), found.extent());
    let (mut streamed, mut whole) = (Words::default(), Words::default());
    let mut memory = BlockMemory::new();
    let (mut positions, mut faces, mut looks) = (Vec::new(), Vec::<Face>::new(), Vec::new());
    for block in found.blocks() {
        let part = memory.decode(found.header(), &block).expect("a block");
        draw(&part.mesh, smooth.then_some(part.looks), &transform, &sight.light, &mut streamed);
        let first = positions.len() as u32;
        positions.extend(part.mesh.positions());
        looks.extend(part.looks);
        faces.extend(part.mesh.faces().iter().map(|face| Face { corners: face.corners.map(|c| c + first), ..*face }));
    }
    let mesh = Mesh::new(&positions, &faces, Winding::CounterClockwise).expect("a mesh");
    draw(&mesh, smooth.then_some(looks.as_slice()), &transform, &sight.light, &mut whole);
    [streamed.words, whole.words]
}

fn sight() -> Sight {
    use fixed::types::{I2F30, I16F16, I32F32};
    let eye = Matrix::translation([I32F32::ZERO, I32F32::ZERO, I32F32::lit("-3")]);
    let turn = Matrix::rotation_x(geometry::Angle::from_bits(0x1234_5678));
    let lens = Matrix::perspective(
        geometry::Angle::from_degrees(I16F16::lit("45")),
        I32F32::from_num(4) / 3,
        I32F32::ONE,
        I32F32::from_num(10),
    );
    let light = DirectionalLight {
        direction: [I2F30::ZERO, I2F30::lit("0.6"), I2F30::lit("0.8")],
        colour: [255; 3],
        diffuse: I16F16::lit("0.75"),
        ambient: I16F16::lit("0.25"),
    };
    Sight { model_to_clip: lens.times(&eye).times(&turn), light: ObjectLight::new(&light, &turn) }
}

/// A bowl of `side` × `side` squares, all seen.
fn bowl(side: u32) -> Model {
    let mut text = String::new();
    for row in 0..=side {
        for column in 0..=side {
            let [x, y] = [column, row].map(|part| f64::from(part) / f64::from(side) * 2.0 - 1.0);
            text += &format!("v {x} {y} {}\n", (x * x + y * y) / 4.0);
        }
    }
    for row in 0..side {
        for column in 0..side {
            let at = |row: u32, column: u32| row * (side + 1) + column + 1;
            let corners = [at(row, column), at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)];
            text += &format!("f {} {} {} {}\n", corners[0], corners[1], corners[2], corners[3]);
        }
    }
    obj::parse_obj(text.as_bytes(), Path::new("bowl.obj"), |_| Ok(None)).expect("a good model")
}

#[test]
fn block_by_block_and_whole_are_the_same_words() {
    let options = |looks| Options { looks, ..Options::default() };
    let file = |looks| compile(&bowl(100), &options(looks)).expect("it compiles").bytes;
    for (bytes, smooth) in [
        (file(Looks::Both), false),
        (file(Looks::Both), true),
        (file(Looks::Flat), false),
        (file(Looks::Smooth), true),
        (BUILT_IN.to_vec(), true),
        (BUILT_IN.to_vec(), false),
    ] {
        let [streamed, whole] = both_ways(&bytes, &sight(), smooth);
        // The file that is built in is small.
        let least = if bytes == BUILT_IN { 100 } else { 5_000 };
        assert!(streamed.len() > least, "{} words", streamed.len());
        assert_eq!(streamed, whole);
    }
}

#[test]
fn a_smooth_file_s_faces_have_their_corners_mean() {
    let bytes = compile(&bowl(20), &Options { looks: Looks::Smooth, ..Options::default() }).expect("it compiles").bytes;
    let found = Found::new(&bytes).expect("a good file");
    let mut memory = BlockMemory::new();
    for block in found.blocks() {
        let part = memory.decode(found.header(), &block).expect("a block");
        for (face, corners) in part.mesh.faces().iter().zip(block.corners) {
            for axis in 0..3 {
                let sum: i32 =
                    corners.iter().map(|corner| i32::from(part.looks[usize::from(*corner)].normal()[axis])).sum();
                assert!((i32::from(face.normal[axis]) - sum / 3).abs() <= 129, "{face:?}");
            }
        }
    }
}

#[test]
fn the_built_in_file_is_the_compiled_asset() {
    let model = models::read(&xtask::paths::workspace_root().join("assets/solids.obj")).expect("a good file");
    let options = Options { scale_to_fit: true, ..Options::default() };
    let compiled = compile(&model, &options).expect("it compiles");
    assert!(
        compiled.bytes == BUILT_IN,
        "stale: run `cargo xtask mesh assets/solids.obj -o assets/solids.mesh --scale-to-fit` and commit the result"
    );
    let first = Found::new(BUILT_IN).expect("a good file").blocks().next().expect("a block");
    assert!(first.positions.iter().copied().map(Block::position).any(|numbers| numbers != [0; 3]));
}
