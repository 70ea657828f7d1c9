//! The models in `assets/` are what they are said to be.

use std::path::Path;

use models::{Model, read};

fn asset(name: &str) -> Model {
    let model = read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../assets").join(name)).expect(name);
    assert!(model.notes.is_empty(), "{name}: {:?}", model.notes);
    model
}

/// Six times the volume that triangles enclose; positive when they go counter-clockwise seen from outside.
fn volume(model: &Model) -> f64 {
    model
        .triangles()
        .map(|corners| {
            let [a, b, c] = corners.map(|corner| model.positions[corner as usize]);
            a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
        })
        .sum::<f64>()
        / 6.0
}

#[test]
fn every_solid_goes_counter_clockwise_and_has_its_volume() {
    let cases = [
        // A ring of 24 sides: (1² − 0.5²) · 24/2 · sin 15° · 0.5.
        ("ring.stl", 192, 0.75 * 12.0 * 15f64.to_radians().sin() * 0.5),
        // A cone of 12 sides: 12/2 · sin 30° · 2/3.
        ("cone.stl", 24, 2.0),
        // A dodecahedron in a unit sphere, and a prism of seven sides and radius 0.9.
        ("solids.obj", 36 + 24, 2.785_163 + 3.5 * (360f64 / 7.0).to_radians().sin() * 0.81 * 1.8),
        ("icosphere.obj", 320, 4.047),
    ];
    for (name, triangles, expected) in cases {
        let model = asset(name);
        assert_eq!(model.triangle_count(), triangles, "{name}");
        assert!((volume(&model) - expected).abs() < 2e-3 * expected, "{name}: {} for {expected}", volume(&model));
    }
    assert!(volume(&asset("knot.glb")) > 1.0);
}

#[test]
fn polygons_have_their_corners_and_materials() {
    let model = asset("solids.obj");
    let count = |corners: usize| model.faces().filter(|face| face.len() == corners).count();
    assert_eq!([4, 5, 7].map(count), [7, 12, 2]);
    let mut colours = model.face_colours.expect("materials").clone();
    colours.sort_by(|a, b| a.partial_cmp(b).expect("no NaN"));
    colours.dedup();
    assert_eq!(colours, [[0.2, 0.8, 0.75], [0.75, 0.35, 0.9], [1.0, 0.75, 0.2]]);
}

#[test]
fn the_babylon_plate_is_the_other_plate_with_its_three_blues() {
    let (babylon, obj) = (asset("plate.babylon"), asset("plate.obj"));
    assert_eq!((babylon.face_count(), obj.face_count()), (120, 120));
    let colours = babylon.face_colours.as_ref().expect("materials");
    for (face, (found, expected)) in babylon.faces().zip(obj.faces()).enumerate() {
        for (found, expected) in found.iter().zip(expected) {
            let [x, y, z] = obj.positions[*expected as usize];
            let found = babylon.positions[*found as usize];
            assert!((0..3).all(|axis| (found[axis] - [x, y, -z][axis]).abs() < 1e-6), "face {face}");
        }
        let blue = match face {
            0..=39 => [0x27, 0x40, 0xab],
            40..=78 => [0x48, 0x76, 0xff],
            _ => [0xca, 0xe1, 0xff],
        };
        assert_eq!(colours[face].map(|part| (part * 255.0).round() as u8), blue, "face {face}");
    }
    // Clockwise in its own left-handed space, counter-clockwise in ours; the published plate is clockwise.
    assert!(volume(&babylon) > 0.1 && volume(&obj) < -0.1);
}

#[test]
fn the_house_is_a_wire_model_with_its_view() {
    let model = asset("house.rom");
    assert_eq!((model.lines.len(), model.face_count()), (27, 0));
    let view = model.view.expect("eye, plane and window");
    assert_eq!((view.plane, view.eye[2]), (2.0, 4.0));
}
