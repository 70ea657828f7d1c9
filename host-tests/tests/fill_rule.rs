//! The fill rule, pixel by pixel: a pixel on an edge that triangles share is drawn once.
//!
//! Packets that `geometry` sets up are held against the rule's definition in exact integers, and
//! drawn by the software model, whose counters and depth buffer must say the same.

use fpga_regs::packet::FlatTriangle;
use fpga_regs::registers::Register;
use fpga_regs::screen::{DEPTH_FAR, GUARD_BAND, HEIGHT, PIXELS, Rgb332, WIDTH};
use geometry::{Culling, Winding};
use host_tests::collect::{draw_faces, set_up_either_way, vertex};
use host_tests::exact_triangle::{Point, covers, doubled_area, pixel_box, winding_number};
use host_tests::lent::with_device;
use host_tests::packet_pixels;
use host_tests::rng::Rng;
use host_tests::twin::{Twin, position};
use raster_model::Device;

const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];

fn set_up(corners: [Point; 3], depth: i32) -> Option<FlatTriangle> {
    set_up_either_way(corners.map(|corner| vertex(corner, depth)))
}

/// A triangle of any size and place: specks, slivers, degenerate, off the screen, as large as the
/// guard band.
fn any_triangle(rng: &mut Rng) -> [Point; 3] {
    let (width, height) = (16 * WIDTH as i32, 16 * HEIGHT as i32);
    let on_screen = |rng: &mut Rng| (rng.within(0, width), rng.within(0, height));
    let beside = |rng: &mut Rng, (x, y): Point, size: i32| (x + rng.within(-size, size), y + rng.within(-size, size));
    let corners = match rng.below(60) {
        // Up to a pixel, a few pixels, a few dozen.
        kind @ 0..=49 => {
            let size = [8, 24, 90, 300, 1_000][kind as usize % 5];
            let first = on_screen(rng);
            [first, beside(rng, first, size), beside(rng, first, size)]
        }
        // A sliver: the third corner beside the line of the others, or on it.
        50..=53 => {
            let (first, second) = (on_screen(rng), on_screen(rng));
            let part = rng.within(0, 64);
            let between = |a: i32, b: i32| a + (b - a) * part / 64;
            let third = (between(first.0, second.0), between(first.1, second.1));
            let size = rng.pick(&[0, 1, 8]);
            [first, second, beside(rng, third, size)]
        }
        // On pixel centres, so that every edge and corner is a tie.
        54..=57 => {
            let first = (rng.within(0, 100) * 16 + 8, rng.within(0, 100) * 16 + 8);
            [first; 3].map(|(x, y)| (x + rng.within(-20, 20) * 16, y + rng.within(-20, 20) * 16))
        }
        58 => [0; 3].map(|_| on_screen(rng)),
        _ => [0; 3].map(|_| (rng.within(-GUARD_BAND, GUARD_BAND), rng.within(-GUARD_BAND, GUARD_BAND))),
    };
    corners.map(|(x, y)| (x.clamp(-GUARD_BAND, GUARD_BAND), y.clamp(-GUARD_BAND, GUARD_BAND)))
}

fn exact_pixels(corners: [Point; 3]) -> Vec<(i32, i32)> {
    let (columns, rows) = pixel_box(&corners, WIDTH, HEIGHT);
    rows.flat_map(|y| columns.clone().map(move |x| (x, y))).filter(|(x, y)| covers(corners, *x, *y)).collect()
}

fn packet_pixels(triangle: Option<&FlatTriangle>) -> Vec<(i32, i32)> {
    let mut pixels = Vec::new();
    if let Some(triangle) = triangle {
        packet_pixels::for_each(&triangle.shape, |x, y| pixels.push((x, y)));
    }
    pixels
}

#[test]
fn random_triangles_of_every_size_cover_exactly_what_the_rule_says() {
    const TRIANGLES: u32 = 60_000;
    with_device(|device| {
        let mut rng = Rng(21);
        let (mut empty, mut pixels, mut largest) = (0, 0, 0);
        for number in 0..TRIANGLES {
            let corners = any_triangle(&mut rng);
            let expected = exact_pixels(corners);
            // Nearer than all before it, so that the depth buffer tells which pixels are its own.
            let depth = number % 65_000;
            if depth == 0 {
                device.push(&fpga_regs::packet::Clear { colour: Rgb332::BLACK, depth: DEPTH_FAR }.encode());
            }
            let depth = 65_000 - depth as i32;
            let triangle = set_up(corners, depth);
            let tested = device.read(Register::PixelsTested);
            if let Some(triangle) = &triangle {
                device.push(&triangle.encode());
            }
            assert_eq!(device.read(Register::Errors), 0, "{corners:?}: {triangle:?}");
            let tested = device.read(Register::PixelsTested) - tested;
            assert_eq!(tested as usize, expected.len(), "pixels of {corners:?}: {triangle:?}");
            for (x, y) in &expected {
                let found = device.depth()[(y * WIDTH as i32 + x) as usize];
                assert_eq!(i32::from(found), depth, "{corners:?} at ({x}, {y}): {triangle:?}");
            }
            empty += usize::from(expected.is_empty());
            pixels += expected.len();
            largest = largest.max(expected.len());
        }
        println!("{TRIANGLES} triangles, {empty} without a pixel, {pixels} pixels, largest {largest}");
        assert!(empty > 1_000 && largest > 50_000, "{empty} without a pixel, largest {largest}");
    });
}

#[test]
fn the_order_of_the_corners_does_not_matter() {
    let mut rng = Rng(22);
    for _ in 0..4_000 {
        let corners = any_triangle(&mut rng);
        let expected = exact_pixels(corners);
        for order in ORDERS {
            let triangle = set_up(order.map(|index| corners[index]), 0);
            assert_eq!(packet_pixels(triangle.as_ref()), expected, "{corners:?} in order {order:?}");
        }
    }
}

/// A screen of counters, and a model that must count the same.
struct Counting<'a, 'memory> {
    counts: Vec<i32>,
    device: &'a mut Device<'memory>,
}

impl<'a, 'memory> Counting<'a, 'memory> {
    fn new(device: &'a mut Device<'memory>) -> Self {
        Self { counts: vec![0; PIXELS], device }
    }

    fn draw(&mut self, triangle: &FlatTriangle) {
        let before = self.device.read(Register::PixelsTested);
        self.device.push(&triangle.encode());
        let mut covered = 0;
        packet_pixels::for_each(&triangle.shape, |x, y| {
            self.counts[(y * WIDTH as i32 + x) as usize] += 1;
            covered += 1;
        });
        let tested = self.device.read(Register::PixelsTested) - before;
        assert_eq!(tested, covered, "the model and the packet's definition: {triangle:?}");
    }

    /// Every pixel was drawn as often as `outline` goes round it.
    fn assert_inside_once(&self, outline: &[Point], what: &str) {
        for (index, count) in self.counts.iter().enumerate() {
            let (x, y) = (index as i32 % WIDTH as i32, index as i32 / WIDTH as i32);
            let expected = winding_number(outline, x, y).abs();
            assert_eq!(*count, expected, "{what}: pixel ({x}, {y}), outline {outline:?}");
        }
    }
}

/// A raster whose inner corners are moved at random, but not so far that a face turns over.
#[test]
fn a_grid_draws_every_pixel_inside_once() {
    with_device(|device| {
        let mut rng = Rng(23);
        for round in 0..40 {
            let (columns, rows) = (rng.within(1, 24), rng.within(1, 18));
            let (width, height) = (rng.within(2, 5_120 / columns), rng.within(2, 3_840 / rows));
            // Often on pixel centres, also beyond the screen.
            let snap = rng.pick(&[1, 8, 16]);
            let (left, top) = (rng.within(-60, 60) * snap + 8, rng.within(-60, 60) * snap + 8);
            let mut at = |column: i32, row: i32| {
                let inner = column > 0 && column < columns && row > 0 && row < rows;
                let mut moved = |size: i32| if inner { rng.within(-size / 5, size / 5) / snap * snap } else { 0 };
                (left + column * width + moved(width), top + row * height + moved(height))
            };
            let raster: Vec<Vec<Point>> =
                (0..=rows).map(|row| (0..=columns).map(|column| at(column, row)).collect()).collect();
            let mut counting = Counting::new(device);
            for pair in raster.windows(2) {
                for (above, below) in pair[0].windows(2).zip(pair[1].windows(2)) {
                    let ([a, b], [d, c]) = ([above[0], above[1]], [below[0], below[1]]);
                    let halves = if rng.once_in(2) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
                    for half in halves {
                        if let Some(triangle) = set_up(rng.pick(&ORDERS).map(|index| half[index]), 1) {
                            counting.draw(&triangle);
                        }
                    }
                }
            }
            let (right, bottom) = (left + columns * width, top + rows * height);
            let outline = [(left, top), (right, top), (right, bottom), (left, bottom)];
            counting.assert_inside_once(&outline, &format!("grid {round}"));
        }
    });
}

/// Spokes round a point, in rising angle: the outline is a star.
#[test]
fn a_fan_draws_every_pixel_inside_once() {
    with_device(|device| {
        let mut rng = Rng(24);
        for round in 0..60 {
            let spokes = rng.within(3, 40);
            let middle = (rng.within(0, 320) * 16 + 8, rng.within(0, 240) * 16 + 8);
            let radius = rng.logarithmic(20.0, 6_000.0);
            let snap = rng.pick(&[1, 16]);
            let outline: Vec<Point> = (0..spokes)
                .map(|spoke| {
                    let angle = std::f64::consts::TAU * f64::from(spoke) / f64::from(spokes);
                    let length = rng.between(0.3, 1.0) * radius;
                    let moved = |part: f64| (part * length) as i32 / snap * snap;
                    (middle.0 + moved(angle.cos()), middle.1 + moved(angle.sin()))
                })
                .collect();
            // Rounding may turn a thin face over; then it is no fan.
            let faces = (0..outline.len()).map(|index| [middle, outline[index], outline[(index + 1) % outline.len()]]);
            let faces: Vec<[Point; 3]> = faces.collect();
            if faces.iter().any(|face| doubled_area(*face) < 0) {
                continue;
            }
            let mut counting = Counting::new(device);
            faces.iter().filter_map(|face| set_up(*face, 1)).for_each(|triangle| counting.draw(&triangle));
            counting.assert_inside_once(&outline, &format!("fan {round}"));
        }
    });
}

/// A band of triangles between two lines that rise from left to right.
#[test]
fn a_strip_draws_every_pixel_inside_once() {
    with_device(|device| {
        let mut rng = Rng(25);
        for round in 0..60 {
            let steps = rng.within(1, 60);
            let width = rng.within(1, 5_000 / steps);
            let snap = rng.pick(&[1, 8, 16]);
            let mut line = |offset: i32| -> Vec<Point> {
                let at = |step: i32, y: i32| (step * width / snap * snap + 8, (offset + y) / snap * snap + 8);
                (0..=steps).map(|step| at(step, rng.within(0, 600))).collect()
            };
            let (upper, lower) = (line(300), line(1_000));
            let mut counting = Counting::new(device);
            for (above, below) in upper.windows(2).zip(lower.windows(2)) {
                let faces = [[above[0], below[0], above[1]], [above[1], below[0], below[1]]];
                faces.iter().filter_map(|face| set_up(*face, 1)).for_each(|triangle| counting.draw(&triangle));
            }
            let outline: Vec<Point> = upper.iter().copied().chain(lower.iter().rev().copied()).collect();
            counting.assert_inside_once(&outline, &format!("strip {round}"));
        }
    });
}

/// Wherever the guard band's border is exactly, this is inside.
const LIMIT: i32 = GUARD_BAND - 16;

/// A parallel projection in which a position in units of 1/2,048 is a sixteenth of a pixel.
fn sixteenths() -> Twin {
    let (width, height) = (f64::from(WIDTH) / 128.0, f64::from(HEIGHT) / 128.0);
    Twin::orthographic([0.0, width], [height, 0.0], [-8.0, 8.0])
}

/// Through a closed surface a line goes in as often as out, however crumpled it is: at every pixel
/// as many front faces are drawn as back faces. Drawn by `geometry` from vertex to packet.
#[test]
fn a_closed_mesh_shows_every_pixel_as_many_fronts_as_backs() {
    with_device(|device| {
        let mut rng = Rng(26);
        let mut drawn = 0;
        for round in 0..60 {
            // A torus of quads, each corner anywhere: closed whatever its shape.
            let (rings, sides) = (rng.within(3, 7) as u32, rng.within(3, 7) as u32);
            let size = rng.pick(&[40, 400, 3_000, 7_000]);
            let snap = rng.pick(&[1, 8, 16]);
            let (middle_x, middle_y) = (rng.within(500, 4_600), rng.within(500, 3_300));
            let mut part = |middle: i32| (middle + rng.within(-size, size) / snap * snap).clamp(-LIMIT, LIMIT);
            let points: Vec<Point> = (0..rings * sides).map(|_| (part(middle_x), part(middle_y))).collect();
            let positions: Vec<_> = points
                .iter()
                .map(|(x, y)| position([f64::from(*x) / 2_048.0, f64::from(*y) / 2_048.0, 0.0]).expect("in range"))
                .collect();
            let corner = |ring: u32, side: u32| ring % rings * sides + side % sides;
            let faces: Vec<[u32; 3]> = (0..rings * sides)
                .flat_map(|index| {
                    let (ring, side) = (index / sides, index % sides);
                    let (a, b) = (corner(ring, side), corner(ring + 1, side));
                    let (c, d) = (corner(ring + 1, side + 1), corner(ring, side + 1));
                    [[a, b, c], [a, c, d]]
                })
                .collect();
            let mut differences = vec![0; PIXELS];
            for (winding, sign) in [(Winding::CounterClockwise, 1), (Winding::Clockwise, -1)] {
                let (triangles, statistics) =
                    draw_faces(&positions, &faces, winding, &sixteenths().fixed, Culling::BackFaces);
                assert_eq!(statistics.clipped, 0);
                let mut counting = Counting::new(device);
                for it in &triangles {
                    // Every corner is where it was put, to the sixteenth.
                    assert!(it.corners.iter().all(|corner| points.contains(&(corner.x, corner.y))), "{it:?}");
                    counting.draw(&it.triangle);
                }
                drawn += triangles.len();
                differences.iter_mut().zip(&counting.counts).for_each(|(sum, count)| *sum += sign * count);
            }
            let odd = differences.iter().position(|difference| *difference != 0);
            assert_eq!(odd, None, "mesh {round} of {points:?}");
        }
        assert!(drawn > 2_000, "only {drawn} triangles were drawn");
    });
}
