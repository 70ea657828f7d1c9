//! "3D" on the DE2: polygons of any number of corners, each pixel by its crossing number; depth as grey.

use firmware::scene::Scene;
use firmware::scene::meshes::{MeshMemory, Meshes, Shape};
use fixed::types::I32F32;
use fpga_regs::screen::{HEIGHT, WIDTH};
use geometry::{Angle, Culling, Matrix};
use host_tests::collect::{draw_faces, transform};
use host_tests::exact_triangle::winding_number;
use host_tests::packet_pixels::for_each;
use host_tests::rng::Rng;
use xtask::machine::{Link, with_host};

use crate::float;

/// The corners of each facet, in order: what its fan of triangles was made from.
fn facets(faces: &[geometry::Face]) -> Vec<Vec<u32>> {
    let mut facets: Vec<(Vec<u32>, [u8; 3], [i16; 3])> = Vec::new();
    for face in faces {
        let [first, before, last] = face.corners;
        match facets.last_mut() {
            Some((corners, colour, normal))
                if corners[0] == first
                    && corners.last() == Some(&before)
                    && (*colour, *normal) == (face.colour, face.normal) =>
            {
                corners.push(last);
            }
            _ => facets.push((face.corners.to_vec(), face.colour, face.normal)),
        }
    }
    facets.into_iter().map(|(corners, ..)| corners).collect()
}

/// Each pixel whose centre is inside a polygon is drawn once, no other one is: the fan has no crack and no overlap.
#[test]
fn a_polygons_pixels_are_those_inside_its_outline() {
    let mut memory = Box::<MeshMemory>::default();
    let meshes = Meshes::new(&mut memory).expect("the built-in meshes are well-formed");
    let mut rng = Rng(71);
    let mut corners_seen = [0; 17];
    let mut pixels = 0;
    for shape in [Shape::Dodecahedron, Shape::Prism, Shape::Disc, Shape::House] {
        let mesh = &meshes.of(shape).mesh;
        for _ in 0..12 {
            let angle = |rng: &mut Rng| Angle::from_bits(rng.word());
            let model = Matrix::rotation_x(angle(&mut rng)).times(&Matrix::rotation_y(angle(&mut rng)));
            let back = Matrix::translation([0, 0, -3].map(I32F32::from_num));
            let (near, far) = (I32F32::from_num(0.5), I32F32::from_num(9));
            let lens = Matrix::perspective(Angle::from_bits(1 << 29), I32F32::from_num(4) / 3, near, far);
            let matrix = lens.times(&back).times(&model);
            let screen = transform(mesh.positions(), &matrix);
            for facet in facets(mesh.faces()) {
                let fan: Vec<[u32; 3]> = facet[1..].windows(2).map(|pair| [facet[0], pair[0], pair[1]]).collect();
                let (drawn_triangles, _) =
                    draw_faces(mesh.positions(), &fan, mesh.winding(), &matrix, Culling::BackFaces);
                let mut counts = vec![0u8; (WIDTH * HEIGHT) as usize];
                for drawn in &drawn_triangles {
                    for_each(&drawn.triangle.shape, |x, y| counts[(y * WIDTH as i32 + x) as usize] += 1);
                }
                if drawn_triangles.is_empty() {
                    continue;
                }
                corners_seen[facet.len()] += 1;
                let outline: Vec<_> = facet
                    .iter()
                    .map(|corner| screen[*corner as usize].expect("it is inside"))
                    .map(|at| (at.x, at.y))
                    .collect();
                for (index, count) in counts.iter().enumerate() {
                    let (x, y) = (index as i32 % WIDTH as i32, index as i32 / WIDTH as i32);
                    let inside = winding_number(&outline, x, y) != 0;
                    assert_eq!(*count, u8::from(inside), "{shape:?}: pixel {x}, {y} of {outline:?}");
                    pixels += usize::from(inside);
                }
            }
        }
    }
    assert!(
        [4, 5, 6, 12].iter().all(|corners| corners_seen[*corners] > 0) && pixels > 500_000,
        "{corners_seen:?} {pixels}"
    );
}

/// A = y1(z2−z3) + y2(z3−z1) + y3(z1−z2), and B and C likewise, is the direction of the facet's normal.
#[test]
fn a_polygons_normal_is_that_of_its_first_three_corners() {
    let mut memory = Box::<MeshMemory>::default();
    let meshes = Meshes::new(&mut memory).expect("the built-in meshes are well-formed");
    for shape in [Shape::Dodecahedron, Shape::Prism, Shape::Disc, Shape::House] {
        let mesh = &meshes.of(shape).mesh;
        for face in mesh.faces() {
            let facets = facets(mesh.faces());
            let facet = facets.iter().find(|facet| face.corners.iter().all(|corner| facet.contains(corner)));
            let facet = facet.expect("every face is of a facet");
            let corner = |index: usize| mesh.positions()[facet[index] as usize].map(|part| part.to_num::<f64>());
            let ([x1, y1, z1], [x2, y2, z2], [x3, y3, z3]) = (corner(0), corner(1), corner(2));
            let plane = [
                y1 * (z2 - z3) + y2 * (z3 - z1) + y3 * (z1 - z2),
                z1 * (x2 - x3) + z2 * (x3 - x1) + z3 * (x1 - x2),
                x1 * (y2 - y3) + x2 * (y3 - y1) + x3 * (y1 - y2),
            ];
            let length = plane.iter().map(|part| part * part).sum::<f64>().sqrt();
            for (part, found) in plane.iter().zip(face.normal) {
                assert!((part / length * 16_384.0 - f64::from(found)).abs() <= 2.0, "{shape:?} {face:?}");
            }
        }
    }
}

#[test]
fn the_farther_the_darker_and_the_greys_are_spread() {
    with_host(|machine| {
        let mut link = Link::new(machine);
        link.begin(Scene::Polygons.index() as u8)?;
        for _ in 0..5 {
            link.step()?;
        }
        let (_, picture) = link.screen()?;
        let greys: Vec<u8> = picture.pixels().filter(|pixel| *pixel != [0; 3]).map(|[red, ..]| red).collect();
        let (darkest, brightest) = (greys.iter().min().copied(), greys.iter().max().copied());
        assert!(greys.len() > 20_000 && darkest <= Some(73) && brightest >= Some(182), "{darkest:?} {brightest:?}");
        Ok(())
    })
    .expect("the application starts");
}

/// The planes of depth lie tight about the model, and move with it.
#[test]
fn near_and_far_planes_close_in_on_the_model() {
    use crate::{Player, holding};
    use firmware::viewer::Viewer;
    let mut player = Player::new(Viewer::new(Scene::Polygons));
    let stage = player.frame(&[holding(&[])]);
    let [_, _, [_, _, a, b], _] = float(&stage.camera.projection);
    let (near, far) = (b / (a - 1.0), b / (a + 1.0));
    assert!((near - 2.35).abs() < 0.01 && (far - 5.25).abs() < 0.01, "{near}, {far}");
}
