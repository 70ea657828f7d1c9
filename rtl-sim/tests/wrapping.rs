//! Edge values that wrap inside the box: signs then say nothing about neighbours, and every tile must
//! be visited. No setup makes such words, but a stream may hold them.

mod common;

use common::pair::Pair;
use common::random::Random;
use fpga_regs::packet::{Clear, EdgeSteps, FlatTriangle, PixelMode, Span, TriangleShape};
use fpga_regs::screen::{DEPTH_FAR, HEIGHT, PacketDepth, Rgb332, WIDTH};
use rtl_sim::UNITS;

/// Returns a triangle of which one edge wraps, and the others are positive all over the screen.
fn wrapping(random: &mut Random) -> FlatTriangle {
    let mut span = |size: u32| {
        let first = random.within(0, size as i32 - 1);
        let last = random.within(first, (first + 60).min(size as i32 - 1));
        Span::new(first as u16, last as u16)
    };
    let (columns, rows) = (span(WIDTH), span(HEIGHT));
    let mut steps = || EdgeSteps::new(random.within(-32768, 32767), random.within(-32768, 32767));
    let steps = [steps(), steps()];
    let mut edges = [1 << 29; 3];
    // It wraps after some tens of pixels.
    let distance = random.within(0, 1 << 20);
    edges[random.within(0, 2) as usize] = if random.one_in(2) { i32::MIN + distance } else { i32::MAX - distance };
    let depth = |value| PacketDepth::from_bits(value);
    let shape = TriangleShape {
        columns,
        rows,
        edges,
        steps,
        depth: depth(random.within(0, 60_000 << 12)),
        depth_step_x: depth(random.within(-4096, 4096)),
        depth_step_y: depth(random.within(-4096, 4096)),
    };
    FlatTriangle { colour: Rgb332(random.word() as u8), mode: PixelMode::USUAL, shape }
}

#[test]
fn every_pixel_inside_edges_that_wrap_is_drawn() {
    for units in UNITS {
        let mut pair = Pair::new(units);
        let mut random = Random::new(31);
        for round in 0..20 {
            pair.push(&Clear { colour: Rgb332(round), depth: DEPTH_FAR }.encode());
            for _ in 0..40 {
                pair.push(&wrapping(&mut random).encode());
            }
            pair.compare(&format!("round {round} of triangles that wrap"));
        }
        let counters = pair.model.counters();
        assert!(counters.pixels_written > 100_000, "{} pixels are hardly a test", counters.pixels_written);
    }
}
