//! "3D Rendering in FPGA" (2014): its matrices, to the digit.

use controls::Button;
use firmware::act::columbia;
use firmware::scene::Scene;
use firmware::scene::meshes::{MeshMemory, Meshes, Shape};
use firmware::viewer::Viewer;
use fixed::types::{I4F28, I16F16, I32F32};
use fpga_regs::screen::{HEIGHT, WIDTH};
use geometry::{Face, Mesh, ScreenTransform, Winding};
use host_tests::float_matrix::FloatMatrix;

use crate::{Player, difference, float, holding};

/// Sine and cosine are within 2⁻²⁹.
const CLOSE: f64 = 4e-9;

/// The rotations as the report prints them, for column vectors: not OpenGL's, which turn the other way.
fn printed(axis: usize, degrees: f64) -> [[f64; 4]; 4] {
    let (s, c) = degrees.to_radians().sin_cos();
    match axis {
        0 => [[1.0, 0.0, 0.0, 0.0], [0.0, c, s, 0.0], [0.0, -s, c, 0.0], [0.0, 0.0, 0.0, 1.0]],
        1 => [[c, 0.0, -s, 0.0], [0.0, 1.0, 0.0, 0.0], [s, 0.0, c, 0.0], [0.0, 0.0, 0.0, 1.0]],
        _ => [[c, s, 0.0, 0.0], [-s, c, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]],
    }
}

fn degrees(value: f64) -> I16F16 {
    I16F16::from_num(value)
}

#[test]
fn rotations_are_the_printed_ones() {
    let makes: [fn(I16F16) -> geometry::Matrix; 3] = [columbia::rotation_x, columbia::rotation_y, columbia::rotation_z];
    for (axis, make) in makes.into_iter().enumerate() {
        for angle in (-180..=180).step_by(15) {
            let found = float(&make(degrees(angle.into())));
            assert!(difference(&found, &printed(axis, angle.into())) < CLOSE, "axis {axis}, {angle}°: {found:?}");
        }
    }
    // The report's own digits at 30°.
    let [_, [_, c, s, _], [_, minus_s, ..], _] = float(&columbia::rotation_x(degrees(30.0)));
    assert_eq!([c, s, minus_s].map(|part| format!("{part:.4}")), ["0.8660", "0.5000", "-0.5000"]);
}

#[test]
fn the_projection_and_the_camera_are_the_printed_ones() {
    let digits = float(&columbia::PROJECTION).map(|row| row.map(|part| format!("{part:.4}")));
    assert_eq!(digits[0], ["2.4178", "0.0000", "0.0000", "0.0000"]);
    assert_eq!(digits[1], ["0.0000", "2.4178", "0.0000", "0.0000"]);
    assert_eq!(digits[2], ["0.0000", "0.0000", "-2.0000", "-3.0000"]);
    assert_eq!(digits[3], ["0.0000", "0.0000", "-1.0000", "0.0000"]);
    assert_eq!(float(&columbia::camera().view), FloatMatrix::translation([0.0, 0.0, -5.0]).0);
}

#[test]
fn the_world_matrix_is_translation_rotations_and_scale_in_their_order() {
    let (offset, scale) = ([0.5, -1.25, 2.0], [1.5, 0.75, 2.0]);
    for (tilt_x, tilt_y) in [(0.0, 0.0), (90.0, 0.0), (0.0, 90.0), (-37.5, 61.25), (90.0, -90.0)] {
        let angles = [-tilt_y, -tilt_x, 180.0];
        let found = columbia::world(offset.map(I32F32::from_num), angles.map(degrees), scale.map(I32F32::from_num));
        let [rx, ry, rz] = [0, 1, 2].map(|axis| FloatMatrix(printed(axis, angles[axis])));
        let expected = FloatMatrix::translation(offset).times(&rz).times(&ry).times(&rx);
        let expected = expected.times(&FloatMatrix::scaling(scale));
        assert!(difference(&float(&found), &expected.0) < 3.0 * CLOSE, "{tilt_x}, {tilt_y}");
    }
}

/// Corners of the plate, where that system's viewport puts them: x = W/2·ndc + W/2, y likewise, z = 9/2·ndc + 11/2.
#[test]
fn the_plate_lands_where_that_systems_viewport_has_it() {
    let mut memory = Box::<MeshMemory>::default();
    let meshes = Meshes::new(&mut memory).expect("the built-in meshes are well-formed");
    let mesh = &meshes.of(Shape::Plate).mesh;
    for (tilt_x, tilt_y) in [(0.0, 0.0), (20.0, -35.0), (-80.0, 60.0)] {
        let angles = [-tilt_y, -tilt_x, 180.0];
        let world = columbia::world([I32F32::ZERO; 3], angles.map(degrees), [I32F32::ONE; 3]);
        let camera = columbia::camera();
        let transform = ScreenTransform::new(&camera.projection.times(&camera.view).times(&world), mesh);
        let [rx, ry, rz] = [0, 1, 2].map(|axis| FloatMatrix(printed(axis, angles[axis])));
        let projection = FloatMatrix([
            [2.4178, 0.0, 0.0, 0.0],
            [0.0, 2.4178, 0.0, 0.0],
            [0.0, 0.0, -2.0, -3.0],
            [0.0, 0.0, -1.0, 0.0],
        ]);
        let view = FloatMatrix::translation([0.0, 0.0, -5.0]);
        let all = projection.times(&view).times(&rz).times(&ry).times(&rx);
        for position in mesh.positions() {
            let [x, y, z, w] = all.apply(position.map(|part: I4F28| part.to_num::<f64>()));
            let (width, height) = (f64::from(WIDTH), f64::from(HEIGHT));
            let column = width / 2.0 * x / w + width / 2.0;
            let row = height / 2.0 * y / w + height / 2.0;
            let depth = (4.5 * z / w + 5.5) / 16.0 * 65_535.0;
            let found = transform.screen(position);
            assert_eq!(found.outside, 0);
            let near = |found: i32, exact: f64, unit: f64| (f64::from(found) / unit - exact).abs();
            assert!(near(found.x, column, 16.0) < 0.0625, "{position:?}: column {column}");
            assert!(near(found.y, row, 16.0) < 0.0625, "{position:?}: row {row}");
            assert!(near(found.depth, depth, 1.0) < 2.0, "{position:?}: depth {depth}");
        }
    }
}

#[test]
fn circle_changes_to_these_matrices_and_back() {
    let mut player = Player::new(Viewer::new(Scene::Plate));
    let ours = player.frame(&[holding(&[])]);
    let theirs = player.frame(&[holding(&[Button::Circle])]);
    assert_eq!(float(&theirs.camera.view), FloatMatrix::translation([0.0, 0.0, -5.0]).0);
    assert!(difference(&float(&theirs.objects[0].model), &printed(2, 180.0)) < CLOSE, "a level pad");
    let still = player.frame(&[holding(&[])]);
    assert_eq!(still.camera.view, theirs.camera.view, "it stays when Circle is let go");
    // R1 gives the other one while it is held.
    assert_eq!(player.frame(&[holding(&[Button::R1])]).camera.view, ours.camera.view);
    player.frame(&[holding(&[])]);
    assert_eq!(player.frame(&[holding(&[Button::Circle])]).camera.view, ours.camera.view);
}

/// Three blues by the faces' numbers: 0 to 39, 40 to 78, and the rest.
#[test]
fn the_plate_has_its_three_blues() {
    let mut memory = Box::<MeshMemory>::default();
    let meshes = Meshes::new(&mut memory).expect("the built-in meshes are well-formed");
    let mesh: &Mesh<'_> = &meshes.of(Shape::Plate).mesh;
    assert_eq!((mesh.faces().len(), mesh.winding()), (120, Winding::Clockwise));
    for (number, Face { colour, .. }) in mesh.faces().iter().enumerate() {
        let expected = match number {
            0..=39 => [0x27, 0x40, 0xab],
            40..=78 => [0x48, 0x76, 0xff],
            _ => [0xca, 0xe1, 0xff],
        };
        assert_eq!(*colour, expected, "face {number}");
    }
}
