//! Setup's promise to the hardware: for any three corners in the guard band and any depths, every
//! field of the packet is in its documented range, and at every covered pixel so is the depth.
//!
//! The ranges are those of the table in `fpga_regs::packet`, written out again.

use fpga_regs::packet::{FlatTriangle, Header, Packet, TriangleShape};
use fpga_regs::screen::{GUARD_BAND, HEIGHT, WIDTH};
use geometry::ScreenVertex;
use host_tests::collect::{set_up_either_way, vertex};
use host_tests::exact_triangle::{self, Point};
use host_tests::packet_pixels::{covers, depth_at, edges_at};
use host_tests::rng::Rng;

/// ±2²⁴.
const EDGE_MAX: i64 = 1 << 24;
const STEP_MAX: i32 = 16_382;
/// What a depth may be off by: half a unit of rounding, and what steps of 1/4,096 and the
/// reciprocal lose over the longest way in the guard band (measured, with a fifth to spare).
const DEPTH_ERROR_MAX: f64 = 1.0;

#[derive(Debug, Default)]
struct Worst {
    packets: u32,
    pixels: u64,
    edge: i64,
    step: i32,
    depth_error: f64,
    depth_low: i32,
    depth_high: i32,
}

fn point(vertex: &ScreenVertex) -> Point {
    (vertex.x, vertex.y)
}

fn check_fields(triangle: &FlatTriangle, corners: &[ScreenVertex; 3], worst: &mut Worst) {
    let words = triangle.encode();
    let decoded = Packet::decode(Header(words[0]), &words[1..]);
    assert_eq!(decoded, Ok(Packet::FlatTriangle(*triangle)), "{corners:?}");
    let TriangleShape { columns, rows, .. } = triangle.shape;
    assert!(columns.first() <= columns.last() && u32::from(columns.last()) < WIDTH, "{corners:?}: {triangle:?}");
    assert!(rows.first() <= rows.last() && u32::from(rows.last()) < HEIGHT, "{corners:?}: {triangle:?}");
    for (step_x, step_y) in triangle.shape.all_steps() {
        worst.step = worst.step.max(step_x.abs()).max(step_y.abs());
        assert!(step_x.abs() <= STEP_MAX && step_y.abs() <= STEP_MAX, "{corners:?}: {triangle:?}");
    }
    // Linear functions are greatest in the box's corners.
    for x in [columns.first(), columns.last()].map(i32::from) {
        for y in [rows.first(), rows.last()].map(i32::from) {
            for edge in edges_at(&triangle.shape, x, y) {
                worst.edge = worst.edge.max(edge.abs());
                assert!(edge.abs() <= EDGE_MAX, "{corners:?} at ({x}, {y}): {triangle:?}");
            }
        }
    }
    worst.packets += 1;
}

fn check_depth(triangle: &FlatTriangle, corners: &[ScreenVertex; 3], (x, y): (i32, i32), worst: &mut Worst) {
    let found = depth_at(&triangle.shape, x, y) >> 12;
    worst.depth_low = worst.depth_low.min(found);
    worst.depth_high = worst.depth_high.max(found - 65_535);
    assert!((-1..=65_536).contains(&found), "{corners:?}: depth {found} at ({x}, {y}): {triangle:?}");
    let points = [0, 1, 2].map(|index: usize| point(&corners[index]));
    let depths = [0, 1, 2].map(|index: usize| corners[index].depth);
    let (numerator, denominator) = exact_triangle::depth(points, depths, x, y);
    let error = (f64::from(found) - numerator as f64 / denominator as f64).abs();
    worst.depth_error = worst.depth_error.max(error);
    assert!(error <= DEPTH_ERROR_MAX, "{corners:?}: depth {found} at ({x}, {y}), off by {error}: {triangle:?}");
    worst.pixels += 1;
}

/// Checks all of a triangle's pixels, or those at both ends of every `row_step`th row.
fn check(corners: [ScreenVertex; 3], row_step: usize, worst: &mut Worst) {
    let Some(triangle) = set_up_either_way(corners) else { return };
    check_fields(&triangle, &corners, worst);
    let TriangleShape { columns, rows, .. } = triangle.shape;
    let columns = i32::from(columns.first())..=i32::from(columns.last());
    for y in (i32::from(rows.first())..=i32::from(rows.last())).step_by(row_step) {
        // Depth is linear in a row, so it is farthest off at an end.
        let left = columns.clone().find(|x| covers(&triangle.shape, *x, y));
        let right = columns.clone().rev().find(|x| covers(&triangle.shape, *x, y));
        for x in [left, right].into_iter().flatten() {
            check_depth(&triangle, &corners, (x, y), worst);
        }
    }
}

fn any_vertex(rng: &mut Rng) -> ScreenVertex {
    let mut part = |size: u32| match rng.below(4) {
        0 => rng.pick(&[-GUARD_BAND, GUARD_BAND]),
        1 => rng.within(-GUARD_BAND, GUARD_BAND),
        _ => rng.within(0, 16 * size as i32),
    };
    let place = (part(WIDTH), part(HEIGHT));
    let depth = match rng.below(3) {
        0 => rng.pick(&[0, 65_535]),
        _ => rng.within(0, 65_535),
    };
    vertex(place, depth)
}

/// The corners of the guard band and of the screen, those beside them, and a middle, in all
/// combinations, near and far.
#[test]
fn the_corners_of_the_guard_band_in_all_combinations() {
    let across = [-GUARD_BAND, 7, 16 * WIDTH as i32 / 2 + 3, 16 * WIDTH as i32 - 8, GUARD_BAND];
    let down = [-GUARD_BAND, 8, 16 * HEIGHT as i32 / 2, 16 * HEIGHT as i32 - 7, GUARD_BAND];
    let points: Vec<Point> = across.iter().flat_map(|x| down.iter().map(move |y| (*x, *y))).collect();
    let depths = [[0, 0, 65_535], [65_535, 0, 0], [0, 65_535, 65_535], [65_535; 3]];
    let mut worst = Worst::default();
    for (number, a) in points.iter().enumerate() {
        for (b, c) in points.iter().flat_map(|b| points.iter().map(move |c| (b, c))) {
            for depths in depths {
                let [i, j, k] = depths;
                check([vertex(*a, i), vertex(*b, j), vertex(*c, k)], 97 + number, &mut worst);
            }
        }
    }
    println!("{worst:?}");
    assert!(worst.step == STEP_MAX && worst.edge > EDGE_MAX * 6 / 10, "the extremes were not met: {worst:?}");
}

#[test]
fn random_triangles_in_the_guard_band() {
    let mut rng = Rng(41);
    let mut worst = Worst::default();
    for _ in 0..12_000 {
        check([0; 3].map(|_| any_vertex(&mut rng)), 17, &mut worst);
    }
    println!("{worst:?}");
    assert!(worst.packets > 8_000 && worst.pixels > 50_000, "{worst:?}");
}

/// Slivers, whose planes are so steep that only the sum modulo 2³² is in range: all of their
/// pixels.
#[test]
fn slivers_with_planes_as_steep_as_can_be() {
    let mut rng = Rng(42);
    let (mut worst, mut steep) = (Worst::default(), 0);
    for _ in 0..25_000 {
        let (a, b) = (any_vertex(&mut rng), any_vertex(&mut rng));
        let part = rng.within(0, 256);
        let beside = |a: i32, b: i32, by: i32| (a + (b - a) * part / 256 + by).clamp(-GUARD_BAND, GUARD_BAND);
        let size = rng.pick(&[1, 4, 20]);
        let by = [0; 2].map(|_| rng.within(-size, size));
        let depth = rng.pick(&[0, 65_535, rng.clone().within(0, 65_535)]);
        let corners = [a, b, vertex((beside(a.x, b.x, by[0]), beside(a.y, b.y, by[1])), depth)];
        let [p, q, r] = [0, 1, 2].map(|index: usize| point(&corners[index]));
        let area = exact_triangle::doubled_area([p, q, r]).abs();
        let rise =
            i64::from(b.depth - a.depth) * i64::from(r.1 - p.1) - i64::from(depth - a.depth) * i64::from(q.1 - p.1);
        steep += u32::from(area > 0 && rise.abs() / area * 16 > 1 << 19);
        check(corners, 1, &mut worst);
    }
    println!("{worst:?}, {steep} steeper than 32 bits");
    assert!(worst.pixels > 200_000 && steep > 1_000, "{worst:?}, {steep} steep");
}

#[test]
fn specks_and_small_triangles_with_any_depths() {
    let mut rng = Rng(43);
    let mut worst = Worst::default();
    for _ in 0..60_000 {
        let first = any_vertex(&mut rng);
        let size = rng.pick(&[2, 10, 40, 200, 1_100]);
        let mut beside = || {
            let moved = |rng: &mut Rng, part: i32| (part + rng.within(-size, size)).clamp(-GUARD_BAND, GUARD_BAND);
            let place = (moved(&mut rng, first.x), moved(&mut rng, first.y));
            vertex(place, any_vertex(&mut rng).depth)
        };
        check([first, beside(), beside()], 1, &mut worst);
    }
    println!("{worst:?}");
    assert!(worst.packets > 10_000 && worst.pixels > 100_000, "{worst:?}");
}
