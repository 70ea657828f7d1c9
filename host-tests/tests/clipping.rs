//! Clipping against a reference that does not clip: triangles with corners beyond every plane,
//! behind the eye, in it, and at w = 0.
//!
//! The reference tells for a pixel whether it sees the triangle ([`host_tests::visible_part`]).
//! [`MARGIN`] pixels from its sides the picture must agree: what a vertex may be off by, in x and y.

use fpga_regs::packet::{Clear, FlatTriangle, TriangleShape};
use fpga_regs::registers::Register;
use fpga_regs::screen::{DEPTH_FAR, GUARD_BAND, HEIGHT, PacketDepth, Rgb332, WIDTH};
use geometry::clip::{Corner, clip};
use geometry::mesh::Position;
use geometry::transform::{Homogeneous, SMALLEST_W, doubled_guard_band};
use geometry::{Culling, Winding};
use host_tests::collect::{Drawn, draw_faces};
use host_tests::lent::with_device;
use host_tests::packet_pixels;
use host_tests::rng::Rng;
use host_tests::twin::{Twin, exact_position, position};
use host_tests::visible_part::{Sight, VisiblePart};
use raster_model::Device;

const NEAR: f64 = 0.25;
const FAR: f64 = 6.0;
/// A sixteenth of a pixel both ways.
const MARGIN: f64 = 0.0885;

/// Where a corner may be, the eye in the origin looking along −z.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Place {
    InView,
    Beside,
    BehindEye,
    BeforeNear,
    EyePlane,
    Eye,
    NearPlane,
    FarPlane,
    BeyondFar,
    BeyondGuardSideways,
    BeyondGuardUpOrDown,
}

const PLACES: [Place; 11] = [
    Place::InView,
    Place::Beside,
    Place::BehindEye,
    Place::BeforeNear,
    Place::EyePlane,
    Place::Eye,
    Place::NearPlane,
    Place::FarPlane,
    Place::BeyondFar,
    Place::BeyondGuardSideways,
    Place::BeyondGuardUpOrDown,
];

fn projection() -> Twin {
    Twin::perspective(std::f64::consts::FRAC_PI_3, 4.0 / 3.0, NEAR, FAR)
}

/// A point in a place; x and y are such that the screen's border is at ±1 unless the place says more.
fn corner(rng: &mut Rng, place: Place) -> Position {
    let (half_height, half_width) = (1.0 / 3f64.sqrt(), 4.0 / 3.0 / 3f64.sqrt());
    let distance = match place {
        Place::InView | Place::Beside => rng.logarithmic(NEAR, FAR),
        Place::BehindEye => -rng.logarithmic(1e-6, 8.0),
        Place::BeforeNear => NEAR * rng.logarithmic(1e-6, 1.0),
        Place::EyePlane | Place::Eye => 0.0,
        Place::NearPlane => NEAR,
        Place::FarPlane => FAR,
        Place::BeyondFar => rng.between(FAR, 8.0),
        Place::BeyondGuardSideways | Place::BeyondGuardUpOrDown => rng.between(NEAR, 0.5),
    };
    let mut within = |limit: f64| rng.between(-limit, limit);
    let [x, y] = match place {
        Place::InView | Place::NearPlane | Place::FarPlane => [within(1.0), within(1.0)],
        Place::Beside | Place::BeyondFar => [within(4.0), within(4.0)],
        _ => [within(8.0), within(8.0)],
    };
    let sign = |value: f64| if value < 0.0 { -1.0 } else { 1.0 };
    let [x, y] = match place {
        Place::BehindEye | Place::BeforeNear | Place::EyePlane => [x, y],
        Place::Eye => [0.0, 0.0],
        Place::BeyondGuardSideways => [sign(x) * rng.between(6.5, 10.0) * distance * half_width, y * 0.2],
        Place::BeyondGuardUpOrDown => [x * 0.2, sign(y) * rng.between(9.6, 14.0) * distance * half_height],
        _ => [x * distance * half_width, y * distance * half_height],
    };
    position([x.clamp(-7.9, 7.9), y.clamp(-7.9, 7.9), -distance]).expect("the places lie in range")
}

fn assert_in_guard_band(drawn: &[Drawn], what: &str) {
    for corner in drawn.iter().flat_map(|it| &it.corners) {
        assert!(corner.x.abs() <= GUARD_BAND && corner.y.abs() <= GUARD_BAND, "{what}: {corner:?}");
        assert!((0..=65_535).contains(&corner.depth), "{what}: {corner:?}");
    }
}

/// Draws on a clear screen; returns how many pixels were drawn more than once.
fn draw(device: &mut Device<'_>, drawn: &[Drawn]) -> u32 {
    let count = |device: &Device<'_>| (device.read(Register::PixelsTested), device.read(Register::PixelsWritten));
    // All at depth 0: the first to come to a pixel is the only one to write it.
    device.push(&Clear { colour: Rgb332::BLACK, depth: DEPTH_FAR }.encode());
    let before = count(device);
    for it in drawn {
        let zero = PacketDepth::ZERO;
        let shape = TriangleShape { depth: zero, depth_step_x: zero, depth_step_y: zero, ..it.triangle.shape };
        let flat = FlatTriangle { shape, ..it.triangle };
        device.push(&flat.encode());
    }
    let after = count(device);
    device.push(&Clear { colour: Rgb332::BLACK, depth: DEPTH_FAR }.encode());
    drawn.iter().for_each(|it| device.push(&it.triangle.encode()));
    assert_eq!(device.read(Register::Errors), 0);
    (after.0 - before.0) - (after.1 - before.1)
}

fn centre(pixel: u32) -> f64 {
    f64::from(pixel) + 0.5
}

/// What the checks saw.
#[derive(Debug, Default)]
struct Seen {
    inside: u32,
    outside: u32,
    worst_depth: f64,
    drawn_twice: u32,
    clipped: u32,
}

fn check(device: &mut Device<'_>, matrix: &Twin, corners: [Position; 3], what: &str, seen: &mut Seen) {
    let (drawn, statistics) =
        draw_faces(&corners, &[[0, 1, 2]], Winding::CounterClockwise, &matrix.fixed, Culling::None);
    assert_in_guard_band(&drawn, what);
    seen.clipped += statistics.clipped;
    let clip = corners.map(|corner| matrix.exact.apply(exact_position(&corner)));
    let Some(part) = VisiblePart::of(clip) else { return };
    seen.drawn_twice += draw(device, &drawn);
    for y in 0..HEIGHT {
        for x in ((y * 7) % 5..WIDTH).step_by(5) {
            let (right, down) = (centre(x), centre(y));
            let found = f64::from(device.depth()[(y * WIDTH + x) as usize]);
            match part.sight(right, down, MARGIN) {
                Sight::Border => {}
                Sight::Outside => {
                    assert!(found == 65_535.0, "{what}: drew ({x}, {y}) at {found} from {clip:?}: {drawn:?}");
                    seen.outside += 1;
                }
                Sight::Inside => {
                    let expected = part.depth.at(right, down);
                    // A vertex off by a sixteenth both ways shifts the plane along its slope.
                    let error = (found - expected).abs() - part.depth.slope() * MARGIN;
                    seen.worst_depth = seen.worst_depth.max(error);
                    assert!(
                        error <= 2.0,
                        "{what}: depth {found} at ({x}, {y}), expected {expected}, from {clip:?}: {drawn:?}"
                    );
                    seen.inside += 1;
                }
            }
        }
    }
}

#[test]
fn corners_in_all_places_give_what_is_seen_and_nothing_else() {
    let mut seen = Seen::default();
    with_device(|device| {
        let mut rng = Rng(31);
        for round in 0..3 {
            // The same view at three sizes: the scale must not matter.
            let scale = [1.0, 1e-2, 1e2][round];
            let matrix = Twin::perspective(std::f64::consts::FRAC_PI_3, 4.0 / 3.0, NEAR * scale, FAR * scale)
                .times(&Twin::scaling([scale; 3]));
            for a in PLACES {
                for b in PLACES {
                    for c in PLACES {
                        let corners = [a, b, c].map(|place| corner(&mut rng, place));
                        check(device, &matrix, corners, &format!("{a:?}, {b:?}, {c:?}"), &mut seen);
                    }
                }
            }
        }
    });
    println!("{seen:?}");
    assert_eq!(seen.drawn_twice, 0, "a fan draws a pixel once");
    assert!(seen.inside > 1_000_000 && seen.outside > 10_000_000 && seen.clipped > 1_500, "{seen:?}");
}

/// Triangles so large that they reach through the whole range of positions on all sides.
#[test]
fn huge_triangles_around_the_eye_are_seen_as_they_are() {
    let mut seen = Seen::default();
    with_device(|device| {
        let mut rng = Rng(32);
        for _ in 0..300 {
            let view = Twin::rotation(0, rng.between(0.0, 6.3)).times(&Twin::rotation(1, rng.between(0.0, 6.3)));
            let corners = [0; 3].map(|_| position(rng.point(7.99)).expect("in range"));
            check(device, &projection().times(&view), corners, "huge", &mut seen);
        }
    });
    println!("{seen:?}");
    assert_eq!(seen.drawn_twice, 0, "a fan draws a pixel once");
    assert!(seen.inside > 100_000 && seen.clipped > 200, "{seen:?}");
}

/// Two faces share an edge that goes through planes: along it every pixel is drawn by one of them.
#[test]
fn clipping_opens_no_cracks() {
    let mut rng = Rng(33);
    let matrix = projection();
    let (mut along, mut pairs) = (0, 0);
    for _ in 0..3_500 {
        let places = [0; 4].map(|_| rng.pick(&PLACES));
        let corners = places.map(|place| corner(&mut rng, place));
        let clip = corners.map(|corner| matrix.exact.apply(exact_position(&corner)));
        let parts = [VisiblePart::of([clip[0], clip[1], clip[2]]), VisiblePart::of([clip[0], clip[2], clip[3]])];
        let [Some(first), Some(second)] = parts else { continue };
        // Sides 1 and 2 are opposite the corners that the faces do not share.
        let (shared, others) = ([first.sides[1], second.sides[2]], [[0, 2, 3, 4], [0, 1, 3, 4]]);
        let mut pixels = Vec::new();
        for y in 0..HEIGHT {
            for x in 0..WIDTH {
                let (right, down) = (centre(x), centre(y));
                let distances = shared.map(|side| side.distance(right, down));
                let across = distances[0].abs() < MARGIN && (distances[0] > 0.0) != (distances[1] > 0.0);
                let inside = |part: &VisiblePart, sides: [usize; 4]| {
                    sides.iter().all(|side| part.sides[*side].distance(right, down) > MARGIN)
                };
                if across && inside(&first, others[0]) && inside(&second, others[1]) {
                    pixels.push((x as i32, y as i32));
                }
            }
        }
        if pixels.is_empty() {
            continue;
        }
        pairs += 1;
        // The second face the other way round every other time, so that the edge is taken both ways.
        let faces = [[0, 1, 2], rng.pick(&[[0, 2, 3], [2, 0, 3]])];
        let (drawn, _) = draw_faces(&corners, &faces, Winding::CounterClockwise, &matrix.fixed, Culling::None);
        for (x, y) in pixels {
            let count = drawn.iter().filter(|it| packet_pixels::covers(&it.triangle.shape, x, y)).count();
            assert_eq!(count, 1, "{places:?}: pixel ({x}, {y}) on the shared edge, {clip:?}: {drawn:?}");
            along += 1;
        }
    }
    println!("{along} pixels along the shared edges of {pairs} pairs");
    assert!(along > 5_000 && pairs > 300, "{along} pixels along {pairs} edges");
}

#[test]
fn what_is_wholly_beyond_a_plane_draws_nothing() {
    let mut rng = Rng(34);
    let beyond = [Place::BehindEye, Place::BeforeNear, Place::EyePlane, Place::Eye];
    for _ in 0..2_000 {
        let corners = match rng.below(3) {
            0 => [0; 3].map(|_| corner(&mut rng, Place::BeyondFar)),
            1 => {
                let right = corner(&mut rng, Place::BeyondGuardSideways).map(|part| part.abs());
                [0; 3].map(|index| [right[0], right[1], -right[2] + right[2] / 1_000 * index])
            }
            _ => [0; 3].map(|_| {
                let place = rng.pick(&beyond);
                corner(&mut rng, place)
            }),
        };
        let (drawn, _) =
            draw_faces(&corners, &[[0, 1, 2]], Winding::CounterClockwise, &projection().fixed, Culling::None);
        assert!(drawn.is_empty(), "{corners:?} drew {drawn:?}");
    }
}

/// Corners in homogeneous space itself, of every size: what is left is inside to the last unit.
/// Projection relies on it: a depth or coordinate beyond w/2 would wrap there.
#[test]
fn every_corner_that_clipping_leaves_is_inside_all_planes() {
    let mut rng = Rng(35);
    let mut corners = 0;
    for _ in 0..300_000 {
        let size = 1 << rng.within(4, 28);
        let triangle = [0; 3].map(|_| {
            let mut part = || rng.within(-size, size);
            let [x, y, z, w] = [part(), part(), part(), part()];
            // Some as the lens gives them: depth near w/2 or 0 and w a power of two or one less.
            let w = if rng.once_in(3) { (1 << rng.within(3, 27)) - rng.within(0, 1) } else { w };
            let z = if rng.once_in(3) { w / 2 + rng.within(-3, 3) } else { z };
            Homogeneous { x, y, z, w }
        });
        for corner in clip(triangle.map(|at| Corner { at, colour: [7; 3] })).corners() {
            let Corner { at: Homogeneous { x, y, z, w }, colour } = *corner;
            assert_eq!(colour, [7; 3], "mixed of one colour");
            let guard = doubled_guard_band(w);
            let inside = w >= SMALLEST_W && z >= 0 && 2 * z <= w && 2 * x.abs() <= guard && 2 * y.abs() <= guard;
            assert!(inside, "{corner:?} is left of {triangle:?}, guard band {guard}");
            corners += 1;
        }
    }
    println!("{corners} corners");
    assert!(corners > 50_000, "only {corners} corners were left");
}
