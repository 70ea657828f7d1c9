//! The planes of colour that setup gives the hardware: right at every covered pixel, however thin
//! the triangle and however far outside the screen its corners.

use fpga_regs::packet::{Channels, GouraudTriangle, Header, Packet};
use fpga_regs::screen::GUARD_BAND;
use geometry::ScreenVertex;
use geometry::setup::{doubled_area, set_up, set_up_gouraud};
use host_tests::collect::vertex;
use host_tests::exact_triangle;
use host_tests::packet_pixels;
use host_tests::rng::Rng;

/// What a channel may be off by: half of rounding, and what steps of 1/4,096 lose over the
/// longest way in the guard band.
const ERROR_MAX: f64 = 1.0;

#[derive(Debug, Default)]
struct Seen {
    packets: u32,
    pixels: u32,
    worst: f64,
}

/// The channel at a pixel, from the packet's 21 bits alone: its whole part, −128…383.
fn channel_at(triangle: &GouraudTriangle, channel: usize, x: i32, y: i32) -> i32 {
    let right = i64::from(x) - i64::from(triangle.shape.columns.first());
    let down = i64::from(y) - i64::from(triangle.shape.rows.first());
    let of = |channels: Channels| i64::from(channels.0[channel]);
    let sum = of(triangle.colour) + right * of(triangle.colour_step_x) + down * of(triangle.colour_step_y);
    let whole = (sum >> 12).rem_euclid(512) as i32;
    if whole < 384 { whole } else { whole - 512 }
}

fn check(corners: [ScreenVertex; 3], colours: [[u8; 3]; 3], seen: &mut Seen) {
    let (corners, colours) = match doubled_area([&corners[0], &corners[1], &corners[2]]) {
        0 => return,
        ..0 => (corners, colours),
        _ => ([corners[0], corners[2], corners[1]], [colours[0], colours[2], colours[1]]),
    };
    let [a, b, c] = &corners;
    let flat = set_up([a, b, c]);
    let Some(triangle) = set_up_gouraud([a, b, c], colours) else {
        assert_eq!(flat, None, "{corners:?}");
        return;
    };
    seen.packets += 1;
    let words = triangle.encode();
    assert_eq!(Packet::decode(Header(words[0]), &words[1..]), Ok(Packet::GouraudTriangle(triangle)));
    assert_eq!(Some(triangle.shape), flat.map(|flat| flat.shape), "{corners:?}");
    let points = corners.map(|corner| (corner.x, corner.y));
    packet_pixels::for_each(&triangle.shape, |x, y| {
        seen.pixels += 1;
        for channel in 0..3 {
            let found = channel_at(&triangle, channel, x, y);
            let values = colours.map(|colour| i32::from(colour[channel]));
            let (numerator, denominator) = exact_triangle::depth(points, values, x, y);
            // The whole part of a value to which half was added: off by half at most, if all is exact.
            let error = (f64::from(found) - numerator as f64 / denominator as f64).abs();
            seen.worst = seen.worst.max(error);
            assert!(error <= ERROR_MAX, "{corners:?} {colours:?}: {found} at ({x}, {y}), off by {error}: {triangle:?}");
        }
    });
}

fn any_colours(rng: &mut Rng) -> [[u8; 3]; 3] {
    [0; 3].map(|_| {
        [0; 3].map(|_| match rng.below(3) {
            0 => rng.pick(&[0, 255]),
            _ => rng.within(0, 255) as u8,
        })
    })
}

#[test]
fn triangles_of_all_sizes() {
    let mut rng = Rng(51);
    let mut seen = Seen::default();
    for _ in 0..20_000 {
        let size = rng.pick(&[4, 20, 100, 400, 1_500]);
        let middle = (rng.within(-400, 5_500), rng.within(-400, 4_200));
        let corners = [0; 3].map(|_| {
            let near = |rng: &mut Rng, part: i32| (part + rng.within(-size, size)).clamp(-GUARD_BAND, GUARD_BAND);
            vertex((near(&mut rng, middle.0), near(&mut rng, middle.1)), rng.clone().within(0, 65_535))
        });
        let colours = any_colours(&mut rng);
        check(corners, colours, &mut seen);
    }
    println!("{seen:?}");
    assert!(seen.packets > 10_000 && seen.pixels > 1_000_000, "{seen:?}");
}

#[test]
fn triangles_with_corners_anywhere_in_the_guard_band() {
    let mut rng = Rng(52);
    let mut seen = Seen::default();
    for _ in 0..400 {
        let corners = [0; 3].map(|_| {
            let mut part = || match rng.below(3) {
                0 => rng.pick(&[-GUARD_BAND, GUARD_BAND]),
                _ => rng.within(-GUARD_BAND, GUARD_BAND),
            };
            vertex((part(), part()), 1_000)
        });
        let colours = any_colours(&mut rng);
        check(corners, colours, &mut seen);
    }
    println!("{seen:?}");
    assert!(seen.packets > 200 && seen.pixels > 1_000_000, "{seen:?}");
}

/// Planes far too steep for their 21 bits, which only the sum's modulus brings into range.
#[test]
fn slivers() {
    let mut rng = Rng(53);
    let (mut seen, mut steep) = (Seen::default(), 0);
    for _ in 0..40_000 {
        let mut place = || (rng.within(-2_000, 7_000), rng.within(-2_000, 6_000));
        let (a, b) = (place(), place());
        let part = rng.within(0, 256);
        let size = rng.pick(&[1, 3, 12]);
        let mut beside = |a: i32, b: i32| a + (b - a) * part / 256 + rng.within(-size, size);
        let c = (beside(a.0, b.0), beside(a.1, b.1));
        let colours = any_colours(&mut rng);
        let corners = [a, b, c].map(|place| vertex(place, 7));
        let area = exact_triangle::doubled_area([a, b, c]).abs();
        let more = |corner: usize| i64::from(colours[corner][0]) - i64::from(colours[0][0]);
        let rise = more(1) * i64::from(c.1 - a.1) - more(2) * i64::from(b.1 - a.1);
        steep += u32::from(area > 0 && rise.abs() * 16 / area > 256);
        check(corners, colours, &mut seen);
    }
    println!("{seen:?}, {steep} steeper than 21 bits");
    assert!(seen.pixels > 100_000 && steep > 2_000, "{seen:?}, {steep} steep");
}
