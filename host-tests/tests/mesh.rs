//! The meshes that the project makes itself: closed, their normals outwards; and that a mesh is
//! checked.

use std::collections::HashMap;

use firmware::scene::meshes::{MAX_VERTICES, MeshMemory, Meshes, Shape, TORUS_RADIUS, TORUS_TUBE};
use fixed::types::I4F28;
use geometry::mesh::Position;
use geometry::shapes::torus;
use geometry::{Face, Mesh, MeshError, Winding};
use host_tests::float_matrix::{Vector, cross, dot, unit};
use host_tests::twin::exact_position;

fn with_mesh<R>(shape: Shape, look: impl FnOnce(&Mesh<'_>) -> R) -> R {
    let mut memory = Box::<MeshMemory>::default();
    look(&Meshes::new(&mut memory).expect("the built-in meshes are well-formed").of(shape).mesh)
}

/// Every edge has a face on each side, which take it in opposite directions.
fn assert_closed(mesh: &Mesh<'_>) {
    let mut edges: HashMap<(u32, u32), u32> = HashMap::new();
    for face in mesh.faces() {
        for index in 0..3 {
            *edges.entry((face.corners[index], face.corners[(index + 1) % 3])).or_default() += 1;
        }
    }
    for ((from, to), count) in &edges {
        assert_eq!((*count, edges.get(&(*to, *from))), (1, Some(&1)), "edge from {from} to {to}");
    }
    assert_eq!(edges.len(), 3 * mesh.faces().len());
}

/// The faces' corners in counter-clockwise order, in `f64`.
fn corners(mesh: &Mesh<'_>, face: &Face) -> [Vector; 3] {
    let [a, b, c] = face.corners.map(|corner| exact_position(&mesh.positions()[corner as usize]));
    match mesh.winding() {
        Winding::CounterClockwise => [a, b, c],
        Winding::Clockwise => [a, c, b],
    }
}

fn minus(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|axis| a[axis] - b[axis])
}

/// The stored normal is that of the corners in their winding, to two units of its last place.
fn assert_normals_fit(mesh: &Mesh<'_>) {
    for face in mesh.faces() {
        let [a, b, c] = corners(mesh, face);
        let expected = unit(cross(minus(b, a), minus(c, a)));
        for (part, expected) in face.normal.into_iter().zip(expected) {
            let error = (f64::from(part) - expected * 16_384.0).abs();
            assert!(error <= 2.0, "{face:?}: off by {error}, expected {expected:?}");
        }
    }
}

/// Six times the volume inside; above 0 when the faces' fronts are outside.
fn volume(mesh: &Mesh<'_>) -> f64 {
    mesh.faces()
        .iter()
        .map(|face| {
            let [a, b, c] = corners(mesh, face);
            dot(a, cross(b, c))
        })
        .sum::<f64>()
        / 6.0
}

#[test]
fn the_torus_is_closed_large_and_turned_outwards() {
    with_mesh(Shape::Torus, |mesh| {
        assert!(mesh.faces().len() >= 4_000 && mesh.positions().len() <= MAX_VERTICES, "{}", mesh.faces().len());
        assert_closed(mesh);
        assert_normals_fit(mesh);
        let (radius, tube) = (TORUS_RADIUS.to_num::<f64>(), TORUS_TUBE.to_num::<f64>());
        for position in mesh.positions().iter().map(exact_position) {
            let from_axis = position[0].hypot(position[2]) - radius;
            // Eight units of the positions' last place.
            assert!((from_axis.hypot(position[1]) - tube).abs() < 3e-8, "{position:?} is not on the tube");
        }
        for face in mesh.faces() {
            let corners = corners(mesh, face);
            let middle = [0, 1, 2].map(|axis| (corners[0][axis] + corners[1][axis] + corners[2][axis]) / 3.0);
            let to_axis = radius / middle[0].hypot(middle[2]);
            let from_tube = minus(middle, [middle[0] * to_axis, 0.0, middle[2] * to_axis]);
            assert!(dot(face.normal.map(f64::from), from_tube) > 0.0, "{face:?} looks inwards");
        }
        // Pappus: 2π²·R·r², a little less for the flat faces.
        let round = 2.0 * std::f64::consts::PI.powi(2) * radius * tube * tube;
        assert!((0.98..1.0).contains(&(volume(mesh) / round)), "{} of {round}", volume(mesh));
    });
}

#[test]
fn the_plate_has_120_faces_is_closed_and_turned_outwards() {
    with_mesh(Shape::Plate, |mesh| {
        assert_eq!((mesh.faces().len(), mesh.positions().len()), (120, 62));
        assert_closed(mesh);
        assert_normals_fit(mesh);
        assert!(volume(mesh) > 0.0);
        // Its rim slopes and its top and bottom are level: the bottom's normals point down.
        for face in mesh.faces() {
            let level = corners(mesh, face).iter().all(|corner| corner[1] == 0.0);
            assert_eq!(face.normal == [0, -16_384, 0], level, "{face:?}");
            assert!(level || face.normal[1] > 0, "{face:?}");
        }
    });
}

/// Faces, and the edges that lines show: as many as the shapes' own figures say.
#[test]
fn every_shape_is_whole() {
    let mut memory = Box::<MeshMemory>::default();
    let meshes = Meshes::new(&mut memory).expect("the built-in meshes are well-formed");
    for (shape, faces, edges) in [
        (Shape::Plate, 120, 180),
        (Shape::Torus, 4_096, 6_144),
        (Shape::Ring, 480, 720),
        (Shape::Sphere, 320, 480),
        (Shape::Box, 12, 12),
        (Shape::Pyramid, 6, 8),
        (Shape::Dodecahedron, 36, 30),
        (Shape::Prism, 20, 18),
        (Shape::Disc, 44, 36),
        (Shape::House, 26, 43),
    ] {
        let model = meshes.of(shape);
        assert_eq!((model.mesh.faces().len(), model.edges.len()), (faces, edges), "{shape:?}");
        assert_eq!(model.looks.len(), model.mesh.positions().len(), "{shape:?}");
    }
}

#[test]
fn solids_are_closed_and_turned_outwards() {
    for shape in [Shape::Ring, Shape::Sphere, Shape::Dodecahedron, Shape::Prism, Shape::Disc] {
        with_mesh(shape, |mesh| {
            assert_closed(mesh);
            assert_normals_fit(mesh);
            assert!(volume(mesh) > 0.0, "{shape:?}");
        });
    }
    // Facets that have corners of their own are not closed by their numbers; but by their volume.
    for (shape, expected) in [(Shape::Box, 8.0), (Shape::Pyramid, 8.0 / 3.0)] {
        with_mesh(shape, |mesh| {
            assert_normals_fit(mesh);
            assert!((volume(mesh) - expected).abs() < 1e-6, "{shape:?}");
        });
    }
}

#[test]
fn every_corner_of_a_mesh_is_used() {
    for shape in Shape::ALL.into_iter().filter(|shape| *shape != Shape::House) {
        with_mesh(shape, |mesh| {
            let mut used = vec![false; mesh.positions().len()];
            mesh.faces().iter().flat_map(|face| face.corners).for_each(|corner| used[corner as usize] = true);
            assert!(used.iter().all(|used| *used), "{shape:?}");
        });
    }
}

#[test]
fn a_face_that_names_a_missing_corner_is_refused_by_name() {
    let positions = [[I4F28::ZERO; 3]; 4];
    let face = |corners| Face { corners, ..Face::default() };
    assert!(Mesh::new(&positions, &[face([0, 1, 3])], Winding::Clockwise).is_ok());
    for (place, corner) in [(0, 4), (1, 5), (2, u32::MAX)] {
        let mut corners = [0, 1, 2];
        corners[place] = corner;
        let faces = [face([3, 2, 1]), face(corners), face([9, 9, 9])];
        let error = Mesh::new(&positions, &faces, Winding::Clockwise).expect_err("the corner is missing");
        assert_eq!(error, MeshError::CornerOutOfRange { face: 1, corner, corners: 4 });
        let text = error.to_string();
        assert!(text.contains("face 1") && text.contains(&corner.to_string()), "{text}");
    }
    assert!(Mesh::new(&[], &[face([0; 3])], Winding::Clockwise).is_err());
    assert!(Mesh::new(&[], &[], Winding::Clockwise).is_ok());
}

#[test]
fn the_extent_is_the_greatest_magnitude_of_each_coordinate() {
    let of = |x: i32, y: i32, z: i32| -> Position { [x, y, z].map(I4F28::from_bits) };
    let positions = [of(1, -7, i32::MIN), of(-3, 5, 0)];
    let mesh = Mesh::new(&positions, &[], Winding::Clockwise).expect("there are no faces");
    assert_eq!(mesh.extent(), [3, 7, 1 << 31]);
}

#[test]
fn a_torus_asks_for_room_and_three_of_each() {
    let make = |rings, sides, vertices, faces| {
        let (mut positions, mut room) = (vec![[I4F28::ZERO; 3]; vertices], vec![Face::default(); faces]);
        let sizes = (I4F28::from_num(2), I4F28::from_num(1));
        let made = torus((rings, sides), sizes, |_, _| [0; 3], &mut positions, &mut room);
        made.map(|(positions, faces)| {
            assert_closed(&Mesh::new(positions, faces, Winding::CounterClockwise).expect("it is well-formed"));
            (positions.len(), faces.len())
        })
    };
    assert_eq!(make(3, 3, 9, 18), Some((9, 18)));
    assert_eq!(make(5, 4, 100, 100), Some((20, 40)));
    for (rings, sides, vertices, faces) in
        [(2, 3, 9, 18), (3, 2, 9, 18), (3, 3, 8, 18), (3, 3, 9, 17), (1 << 16, 1 << 16, 9, 18)]
    {
        assert_eq!(make(rings, sides, vertices, faces), None, "{rings}, {sides} in {vertices}, {faces}");
    }
}
