//! Vertices against a reference in `f64`: within 1/16 of a pixel, and within 2 of 65,536 in depth.
//!
//! The reference starts from the numbers that the matrices were made from; only positions, which
//! enter the project quantised, are taken as they are.
//!
//! A mesh's vertices share one scale, so what is lost near the eye grows with the mesh's reach:
//! the greatest clip coordinate of any of its corners over a vertex's own w. Two claims follow:
//! the 1/16 of a pixel up to [`REACH`], and a law for any reach.

use fpga_regs::screen::{GUARD_BAND, SUBPIXEL};
use geometry::mesh::Position;
use host_tests::collect::transform;
use host_tests::float_matrix::{FloatMatrix, ScreenPoint, viewport};
use host_tests::rng::Rng;
use host_tests::twin::{Twin, exact_position, position};

/// Scenes and vertices a scene.
const SCENES: usize = 4_000;
const VERTICES: usize = 150;
/// Up to this reach the promise of 1/16 of a pixel holds.
const REACH: f64 = 2_500.0;
/// What rounding to sixteenths and the reciprocal cost, in pixels: 1/32 + 1/512.
const PIXELS_AT_NO_REACH: f64 = 1.0 / 32.0 + 1.0 / 512.0;
/// What rounding and the reciprocal cost in depth.
const DEPTH_AT_NO_REACH: f64 = 0.6;
/// What a unit of reach costs more, in pixels and in depth (measured, with a quarter to spare).
const PIXELS_PER_REACH: f64 = 5.3e-6;
const DEPTH_PER_REACH: f64 = 8.5e-4;
/// The guard band in pixels, less a hair for vertices on its border.
const GUARD_PIXELS: f64 = (GUARD_BAND / SUBPIXEL - 1) as f64;

struct Scene {
    matrix: Twin,
    positions: Vec<Position>,
}

struct Checked {
    pixels: f64,
    depth: f64,
    reach: f64,
    near_plane: bool,
    what: String,
}

/// A scene of every kind: perspective or parallel, near 0.05 to 1, far up to 1,000 times as far,
/// model scales from 1/1,000 to 1,000, turned and moved, seen from anywhere.
fn scene(rng: &mut Rng) -> Option<Scene> {
    let near = rng.logarithmic(0.05, 1.0);
    let far = near * rng.logarithmic(2.0, 1_000.0);
    let perspective = !rng.once_in(4);
    let projection = if perspective {
        Twin::perspective(rng.between(0.35, 2.1), rng.between(0.6, 2.0), near, far)
    } else {
        let half = rng.logarithmic(0.05, 50.0);
        let (x, y) = (rng.between(-0.5, 0.5) * half, rng.between(-0.5, 0.5) * half);
        Twin::orthographic([x - half * 4.0 / 3.0, x + half * 4.0 / 3.0], [y - half, y + half], [near, far])
    };
    let scale = rng.logarithmic(1e-3, 1e3);
    let turned = Twin::rotation(0, rng.between(0.0, 6.3))
        .times(&Twin::rotation(1, rng.between(0.0, 6.3)))
        .times(&Twin::rotation(2, rng.between(0.0, 6.3)));
    let model = Twin::translation(rng.point(scale.min(10.0))).times(&turned).times(&Twin::scaling([scale; 3]));
    // The eye is as far from a point of the model as something in the view volume is.
    let target = model.exact.apply(rng.point(4.0));
    let target = [target[0], target[1], target[2]];
    let (distance, away) = (rng.logarithmic(near, far), rng.direction());
    let eye = [0, 1, 2].map(|axis| target[axis] + distance * away[axis]);
    let view = Twin::look_at(eye, target, rng.direction())?;
    let matrix = projection.times(&view).times(&model);

    let back = matrix.exact.inverse()?;
    let positions = (0..VERTICES * 4).filter_map(|index| {
        if index % 8 == 0 {
            return position(rng.point(8.0));
        }
        // From the screen back to the model; every eighth very near the near plane.
        let w = match (perspective, index % 8) {
            (false, _) => 1.0,
            (true, 1) => near * (1.0 + rng.logarithmic(1e-7, 1e-2)),
            (true, _) => rng.logarithmic(near, far),
        };
        let z = match (perspective, index % 8) {
            (true, _) => (far + near) / (far - near) * w - 2.0 * far * near / (far - near),
            (false, 1) => -1.0 + rng.logarithmic(1e-7, 1e-2),
            (false, _) => rng.between(-1.0, 1.0),
        };
        let wide = if index % 4 == 3 { 6.3 } else { 1.0 };
        let [x, y] = [0; 2].map(|_| rng.between(-wide, wide));
        position(divided(apply_homogeneous(&back, [x * w, y * w, z, w])))
    });
    let positions: Vec<Position> = positions.take(VERTICES).collect();
    (positions.len() == VERTICES).then_some(Scene { matrix, positions })
}

fn apply_homogeneous(matrix: &FloatMatrix, point: [f64; 4]) -> [f64; 4] {
    matrix.0.map(|row| row.iter().zip(point).map(|(element, part)| element * part).sum())
}

fn divided([x, y, z, w]: [f64; 4]) -> [f64; 3] {
    [x / w, y / w, z / w]
}

/// The greatest clip coordinate that a corner of the mesh's box can have.
fn greatest(scene: &Scene) -> f64 {
    let mut extent = [0.0f64; 3];
    for position in scene.positions.iter().map(exact_position) {
        extent = [0, 1, 2].map(|axis| extent[axis].max(position[axis].abs()));
    }
    let sum = |row: &[f64; 4]| (0..3).map(|axis| row[axis].abs() * extent[axis]).sum::<f64>() + row[3].abs();
    scene.matrix.exact.0.iter().map(sum).fold(0.0, f64::max)
}

fn in_guard_band(point: &ScreenPoint) -> bool {
    point.x.abs() < GUARD_PIXELS && point.y.abs() < GUARD_PIXELS
}

fn check(scene: &Scene, checked: &mut Vec<Checked>) {
    let seen = transform(&scene.positions, &scene.matrix.fixed);
    let greatest = greatest(scene);
    for (seen, position) in seen.iter().zip(&scene.positions) {
        let clip = scene.matrix.exact.apply(exact_position(position));
        let [_, _, z, w] = clip;
        let reach = greatest / w;
        // Nearer to a plane than this, a vertex may be taken as outside or inside.
        let doubt = 1e-8 * greatest;
        let expected = viewport(clip);
        let between_planes = z >= -w + doubt && z <= w - doubt && w > doubt;
        let outside = z < -w - doubt || z > w + doubt;
        match seen {
            Some(_) if outside => panic!("{clip:?} is beyond a plane and was not marked: {:?}", scene.matrix.exact),
            None if between_planes && in_guard_band(&expected) && reach < 1e5 => {
                panic!("{clip:?} is inside and was marked as outside: {:?}", scene.matrix.exact)
            }
            Some(seen) if between_planes => checked.push(Checked {
                pixels: (f64::from(seen.x) / 16.0 - expected.x)
                    .abs()
                    .max((f64::from(seen.y) / 16.0 - expected.y).abs()),
                depth: (f64::from(seen.depth) - expected.depth).abs(),
                reach,
                near_plane: z <= -0.999 * w,
                what: format!("{seen:?}, expected {expected:?}, w {w}, greatest {greatest}"),
            }),
            _ => {}
        }
    }
}

fn all_checked() -> Vec<Checked> {
    let mut rng = Rng(11);
    let mut checked = Vec::new();
    for _ in 0..SCENES {
        if let Some(scene) = scene(&mut rng) {
            check(&scene, &mut checked);
        }
    }
    checked
}

fn worst<'a>(checked: &[&'a Checked], of: impl Fn(&Checked) -> f64) -> &'a Checked {
    checked.iter().max_by(|a, b| of(a).total_cmp(&of(b))).expect("there are vertices")
}

#[test]
fn every_vertex_is_within_a_sixteenth_of_a_pixel_and_two_of_depth() {
    let all = all_checked();
    let within: Vec<&Checked> = all.iter().filter(|it| it.reach <= REACH).collect();
    let near_plane = within.iter().filter(|it| it.near_plane).count();
    assert!(within.len() > 200_000 && near_plane > 20_000, "only {} vertices, {near_plane} near", within.len());
    let worst_pixels = worst(&within, |it| it.pixels);
    println!("{} vertices, {near_plane} at the near plane; worst {} pixels", within.len(), worst_pixels.pixels);
    assert!(worst_pixels.pixels <= 1.0 / 16.0, "off by {} pixels: {}", worst_pixels.pixels, worst_pixels.what);
    let worst_depth = worst(&within, |it| it.depth);
    println!("worst {} of depth", worst_depth.depth);
    assert!(worst_depth.depth <= 2.0, "depth off by {}: {}", worst_depth.depth, worst_depth.what);
}

/// For a mesh that reaches farther than the promise, in proportion: a mesh of 100,000 times the
/// distance to its nearest vertex is off by a pixel there, not by the screen.
#[test]
fn beyond_that_reach_the_error_grows_no_faster_than_the_reach() {
    let all = all_checked();
    let all: Vec<&Checked> = all.iter().collect();
    let farthest = worst(&all, |it| it.reach).reach;
    assert!(farthest > 1e5, "the farthest reach is {farthest}");
    let pixels = |it: &Checked| (it.pixels - PIXELS_AT_NO_REACH) / it.reach;
    let depth = |it: &Checked| (it.depth - DEPTH_AT_NO_REACH) / it.reach;
    let (worst_pixels, worst_depth) = (worst(&all, pixels), worst(&all, depth));
    println!("a unit of reach costs {:e} pixels and {:e} of depth", pixels(worst_pixels), depth(worst_depth));
    assert!(pixels(worst_pixels) <= PIXELS_PER_REACH, "{} pixels: {}", worst_pixels.pixels, worst_pixels.what);
    assert!(depth(worst_depth) <= DEPTH_PER_REACH, "{} of depth: {}", worst_depth.depth, worst_depth.what);
}
