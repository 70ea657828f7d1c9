//! Which pixels a triangle changes.

use fpga_regs::packet::{
    Channels, Clear, EdgeSteps, FlatTriangle, GouraudTriangle, Packet, PixelMode, Span, TriangleShape, swap,
};
use fpga_regs::screen::{DEPTH_FAR, GUARD_BAND, HEIGHT, PacketDepth, Rgb332, WIDTH};
use raster_model::Device;

use crate::lent::Lent;
use crate::reference::Reference;
use crate::rng::Rng;
use crate::setup::set_up;

const CLEAR: Clear = Clear { colour: Rgb332(0), depth: DEPTH_FAR };

/// A triangle that covers its whole box of `columns` by one row at the screen's upper left.
fn strip(columns: u16, depth: i32, depth_step_x: i32) -> FlatTriangle {
    FlatTriangle {
        colour: Rgb332(7),
        mode: PixelMode::USUAL,
        shape: TriangleShape {
            columns: Span::new(0, columns - 1),
            rows: Span::new(0, 0),
            edges: [0; 3],
            steps: [EdgeSteps::new(0, 0); 2],
            depth: PacketDepth::from_bits(depth),
            depth_step_x: PacketDepth::from_bits(depth_step_x),
            depth_step_y: PacketDepth::from_bits(0),
        },
    }
}

/// Returns columns 9…15 of rows 19…24 of the back buffer, '#' where the colour is not 0.
fn pattern(device: &Device<'_>) -> Vec<String> {
    let row = |y: usize| {
        let start = y * WIDTH as usize;
        device.back()[start + 9..=start + 15].iter().map(|colour| if *colour == 0 { '.' } else { '#' }).collect()
    };
    (19..=24).map(row).collect()
}

/// Box: columns 10…14, rows 20…23. With x and y counted from its corner, the edges are
/// −1 + x ≥ 0, 1 − x + 2y ≥ 0 and 5 − 2y ≥ 0 (whose steps are minus the sum of the others').
/// So row 0 has x in 1…1, row 1 in 1…3, row 2 in 1…5 but the box ends at 4, row 3 none.
#[test]
fn a_small_triangle_covers_the_pixels_that_the_definition_enumerates() {
    let triangle = FlatTriangle {
        colour: Rgb332(0xe3),
        mode: PixelMode::USUAL,
        shape: TriangleShape {
            columns: Span::new(10, 14),
            rows: Span::new(20, 23),
            edges: [-1, 1, 5],
            steps: [EdgeSteps::new(1, 0), EdgeSteps::new(-1, 2)],
            depth: PacketDepth::from_num(100),
            depth_step_x: PacketDepth::from_num(1.5),
            depth_step_y: PacketDepth::from_num(-10),
        },
    };
    let mut lent = Lent::new();
    let mut device = lent.enabled();
    device.push(&CLEAR.encode());
    device.push(&triangle.encode());
    let expected = [
        ".......", //
        "..#....", //
        "..###..", //
        "..####.", //
        ".......", //
        ".......",
    ];
    assert_eq!(pattern(&device), expected);
    assert_eq!(device.back().iter().filter(|colour| **colour == 0xe3).count(), 8);
    let depth_at = |x: usize, y: usize| device.depth()[y * WIDTH as usize + x];
    // 100 + 1.5·x − 10·y, rounded down.
    assert_eq!(depth_at(11, 20), 101);
    assert_eq!([depth_at(11, 21), depth_at(12, 21), depth_at(13, 21)], [91, 93, 94]);
    assert_eq!([depth_at(11, 22), depth_at(14, 22), depth_at(15, 22)], [81, 86, DEPTH_FAR]);
    let counters = device.counters();
    assert_eq!((counters.triangles, counters.pixels_tested, counters.pixels_written), (1, 8, 8));

    // Once more: every pixel is tested, none is nearer.
    device.push(&triangle.encode());
    let counters = device.counters();
    assert_eq!((counters.triangles, counters.pixels_tested, counters.pixels_written), (2, 16, 8));
}

#[test]
fn depth_saturates_at_both_ends_and_drops_its_fraction() {
    let mut lent = Lent::new();
    let mut device = lent.enabled();
    // Integers −2, −1, 0, 1, each with the fraction 4095/4096.
    device.push(&CLEAR.encode());
    device.push(&strip(4, -2 * 4096 + 4095, 4096).encode());
    assert_eq!(device.depth()[..5], [0, 0, 0, 1, DEPTH_FAR]);
    // 65,534, 65,535, 65,536 and 65,537: only the first is nearer than the far plane.
    device.push(&CLEAR.encode());
    device.push(&strip(4, 65_534 * 4096, 4096).encode());
    assert_eq!(device.depth()[..4], [65_534, DEPTH_FAR, DEPTH_FAR, DEPTH_FAR]);
    assert_eq!(device.back()[..4], [7, 0, 0, 0]);
    // The ends of the number format: the sum wraps from 2¹⁹ − 1 to −2¹⁹.
    device.push(&CLEAR.encode());
    device.push(&strip(2, i32::MAX, 1).encode());
    assert_eq!(device.depth()[..2], [DEPTH_FAR, 0]);
    assert_eq!(device.counters().pixels_tested, 10);
    assert_eq!(device.counters().pixels_written, 6);
}

#[test]
fn an_equal_depth_does_not_overwrite_and_a_nearer_one_does() {
    let mut lent = Lent::new();
    let mut device = lent.enabled();
    device.push(&Clear { colour: Rgb332(1), depth: 500 }.encode());
    device.push(&strip(3, 499 * 4096, 4096).encode());
    assert_eq!(device.depth()[..4], [499, 500, 500, 500]);
    assert_eq!(device.back()[..4], [7, 1, 1, 1]);
    assert_eq!((device.counters().pixels_tested, device.counters().pixels_written), (3, 1));
}

#[test]
fn a_swap_shows_what_was_drawn_and_draws_to_the_other_buffer() {
    let mut lent = Lent::new();
    let mut device = lent.enabled();
    device.push(&Clear { colour: Rgb332(1), depth: 9 }.encode());
    assert_eq!((device.front()[0], device.back()[0]), (0, 1));
    device.push(&swap());
    assert_eq!((device.front()[0], device.back()[0]), (1, 0));
    device.push(&strip(1, 0, 0).encode());
    assert_eq!((device.front()[0], device.back()[0]), (1, 7));
    assert_eq!(device.depth()[..2], [0, 9], "one depth buffer serves both");
    device.push(&swap());
    assert_eq!((device.front()[0], device.back()[0]), (7, 1));
}

/// Returns a span of a screen axis: mostly short, now and then any.
fn any_span(rng: &mut Rng, size: u32) -> Span {
    let length = if rng.below(24) == 0 { size } else { 40 };
    let first = rng.below(size);
    let last = (first + rng.below(length)).min(size - 1);
    Span::new(first as u16, last as u16)
}

/// Mostly the usual mode.
fn any_mode(rng: &mut Rng) -> PixelMode {
    let mut bit = || rng.below(8) == 0;
    PixelMode { keep_depth: bit(), keep_colour: bit(), depth_grey: bit() }
}

/// Any words at all, but for a box on the screen and a header that is right.
fn garbage(rng: &mut Rng) -> FlatTriangle {
    let depth = [0; 3].map(|_| PacketDepth::from_bits(rng.word() as i32));
    FlatTriangle {
        colour: Rgb332(rng.word() as u8),
        mode: any_mode(rng),
        shape: TriangleShape {
            columns: any_span(rng, WIDTH),
            rows: any_span(rng, HEIGHT),
            edges: [0; 3].map(|_| rng.word() as i32),
            steps: [0; 2].map(|_| EdgeSteps(rng.word())),
            depth: depth[0],
            depth_step_x: depth[1],
            depth_step_y: depth[2],
        },
    }
}

/// Borders through the box: edge values that the steps bring to zero, or to a wrap, within it.
fn near_the_border(rng: &mut Rng) -> FlatTriangle {
    // 2³¹ − 2²⁶ is where the model changes from spans to single pixels.
    const CENTRES: [i32; 8] = [0, 0, 0, 0, i32::MAX, i32::MIN, i32::MAX - (1 << 26), i32::MIN + (1 << 26)];
    let step_bits = rng.below(16);
    let mut step = || rng.within(i16::MIN.into(), i16::MAX.into()) >> step_bits;
    let steps = [EdgeSteps::new(step(), step()), EdgeSteps::new(step(), step())];
    let reach = 40 << (16 - step_bits);
    let edges = [0; 3].map(|_| CENTRES[rng.below(8) as usize].wrapping_add(rng.within(-reach / 2, reach)));
    let garbage = garbage(rng);
    FlatTriangle { shape: TriangleShape { steps, edges, ..garbage.shape }, ..garbage }
}

/// What setup makes of three vertices: small, large, or reaching into the guard band.
fn real(rng: &mut Rng) -> FlatTriangle {
    loop {
        let size = 16 << rng.below(9);
        let (x, y) = (rng.within(-size, 320 * 16 + size), rng.within(-size, 240 * 16 + size));
        let mut near = |centre: i32| (centre + rng.within(-size, size)).clamp(-GUARD_BAND, GUARD_BAND);
        let corners = [(near(x), near(y)), (near(x), near(y)), (near(x), near(y))];
        let vertices = corners.map(|(x, y)| (x, y, f64::from(rng.below(65_536))));
        if let Some(triangle) = set_up(vertices, rng.word() as u8) {
            return triangle;
        }
    }
}

/// Colours before any of these shapes: of any words, or of slow steps from a colour, which end in range.
fn gouraud(rng: &mut Rng) -> GouraudTriangle {
    let shape = match rng.below(4) {
        0 => garbage(rng),
        1 => near_the_border(rng),
        _ => real(rng),
    }
    .shape;
    let slow = rng.below(3) > 0;
    let mut channels =
        |reach: i32| Channels([0; 3].map(|_| if slow { rng.within(-reach, reach) } else { rng.word() as i32 }));
    let within_21_bits = |channels: Channels| Channels(channels.0.map(|channel| channel & 0x1f_ffff));
    GouraudTriangle {
        colour: within_21_bits(channels(300 << 12)),
        colour_step_x: within_21_bits(channels(0x1000)),
        colour_step_y: within_21_bits(channels(0x1000)),
        mode: any_mode(rng),
        shape,
    }
}

fn compare_with_reference(seed: u64, count: usize, make: fn(&mut Rng) -> Packet) -> Reference {
    let mut rng = Rng(seed);
    let mut lent = Lent::new();
    let mut device = lent.enabled();
    let mut reference = Reference::new();
    for index in 0..count {
        let packet = make(&mut rng);
        let (words, shape) = match packet {
            Packet::FlatTriangle(triangle) => (triangle.encode().to_vec(), triangle.shape),
            Packet::GouraudTriangle(triangle) => (triangle.encode().to_vec(), triangle.shape),
            other => panic!("{other:?} is no triangle"),
        };
        assert_eq!(Packet::decode(fpga_regs::packet::Header(words[0]), &words[1..]), Ok(packet));
        if index % 16 == 0 {
            let clear = Clear { colour: Rgb332(rng.word() as u8), depth: u16::MAX - (rng.below(256) as u16) }.encode();
            device.push(&clear);
            reference.take(&clear);
        }
        device.push(&words);
        reference.take(&words);
        assert_eq!(device.counters(), reference.counters, "triangle {index}: {packet:?}");
        for row in shape.rows.first()..=shape.rows.last() {
            let start = usize::from(row) * WIDTH as usize;
            let columns = shape.columns;
            let part = start + usize::from(columns.first())..=start + usize::from(columns.last());
            let what = format_args!("triangle {index}, row {row}: {packet:?}").to_string();
            assert_eq!(device.back()[part.clone()], reference.colours[1][part.clone()], "colours of {what}");
            assert_eq!(device.depth()[part.clone()], reference.depths[part], "depths of {what}");
        }
        // Nothing outside the boxes changed either.
        if index % 16 == 15 {
            reference.assert_same_pictures(&device);
        }
    }
    reference
}

/// Panics unless a comparison drew enough to be worth something.
fn assert_drew(reference: &Reference, count: u32, pixels_tested: u32) {
    let counters = reference.counters;
    println!("{counters:?}");
    assert_eq!(counters.triangles, count);
    assert!(counters.pixels_tested > pixels_tested, "only {} pixels", counters.pixels_tested);
    assert!(counters.pixels_written > pixels_tested / 8 && counters.pixels_written < counters.pixels_tested);
}

#[test]
fn triangles_of_garbage_words_are_drawn_as_the_reference_draws_them() {
    assert_drew(&compare_with_reference(1, 50_000, |rng| Packet::FlatTriangle(garbage(rng))), 50_000, 1_000_000);
}

#[test]
fn triangles_with_borders_and_wraps_in_the_box_are_drawn_as_the_reference_draws_them() {
    assert_drew(
        &compare_with_reference(2, 60_000, |rng| Packet::FlatTriangle(near_the_border(rng))),
        60_000,
        1_000_000,
    );
}

#[test]
fn triangles_from_setup_are_drawn_as_the_reference_draws_them() {
    assert_drew(&compare_with_reference(3, 40_000, |rng| Packet::FlatTriangle(real(rng))), 40_000, 10_000_000);
}

#[test]
fn gouraud_triangles_are_drawn_as_the_reference_draws_them() {
    assert_drew(&compare_with_reference(4, 40_000, |rng| Packet::GouraudTriangle(gouraud(rng))), 40_000, 5_000_000);
}
