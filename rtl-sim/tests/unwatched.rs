//! Nobody looks at the pins: VGA's clocks are left out, and nothing else notices. When someone looks again, the next
//! picture is whole.

mod common;

use common::pair::Pair;
use common::random::Random;
use common::shapes::any_triangle;
use fpga_regs::Port;
use fpga_regs::packet::{Clear, swap};
use fpga_regs::registers::{Control, Register};
use fpga_regs::screen::{DEPTH_FAR, Rgb332};
use rtl_sim::Rtl;

/// VGA clocks in a bus clock of the board, in 1/65,536.
const RATIO: u32 = (65_536.0 * 25.175 / 50.0) as u32;
/// Bus clocks of a frame on the board.
const FRAME: u64 = 834_160;
/// Bus clocks at a time: not a line's.
const STEP: u64 = 1_000;

fn enabled(units: u32) -> Rtl {
    let mut rtl = Rtl::new(units);
    rtl.write(Register::Control, Control::default().with_enable(true).0);
    rtl.set_hurry(false);
    rtl.set_vga_ratio(RATIO);
    rtl.set_scan(true);
    rtl
}

/// Returns what the bus sees in three frames with three swaps, one of which waits for each blank; `looks` says in which
/// steps someone looks.
fn run(looks: fn(u64) -> bool) -> Vec<(u64, u64, bool, bool, u32)> {
    let mut rtl = enabled(1);
    (0..3).for_each(|_| rtl.push(&swap()));
    let seen = (0..3 * FRAME / STEP).map(|step| {
        rtl.set_watched(looks(step));
        rtl.clock(STEP);
        let status = rtl.read(Register::Status);
        (rtl.swaps(), rtl.scan_left().0, rtl.busy(), rtl.swap_pending(), status)
    });
    seen.collect()
}

#[test]
fn the_bus_sees_the_same_in_every_clock_whether_or_not_anyone_looks() {
    let watched = run(|_| true);
    assert_eq!(watched[watched.len() - 1].0 - watched[0].0, 3, "swaps");
    // Never, and now and then, for longer and shorter than a line.
    let others: [fn(u64) -> bool; 3] = [|_| false, |step| step % 97 > 50, |step| step % 2 == 0];
    for (which, looks) in others.into_iter().enumerate() {
        for (step, (watched, unwatched)) in watched.iter().zip(run(looks)).enumerate() {
            assert_eq!(*watched, unwatched, "step {step} of {which}");
        }
    }
}

#[test]
fn a_picture_is_whole_wherever_the_raster_is_when_someone_looks_again() {
    let mut pair = Pair::new(8);
    let mut random = Random::new(1);
    pair.rtl.set_hurry(false);
    pair.rtl.set_scan(true);
    pair.rtl.set_vga_ratio(RATIO);
    for place in 0..5 {
        pair.rtl.set_watched(false);
        pair.push(&Clear { colour: Rgb332(random.word() as u8), depth: DEPTH_FAR }.encode());
        for _ in 0..10 {
            pair.push(&any_triangle(&mut random).encode());
        }
        pair.push(&swap());
        let swaps = pair.rtl.swaps();
        pair.rtl.run(FRAME);
        assert_eq!(pair.rtl.swaps(), swaps + 1);
        // In the visible part, the blank and between.
        pair.rtl.run(FRAME * place / 5 + 777);
        assert_ne!(pair.rtl.swaps_scanned(), Some(swaps + 1));
        pair.rtl.set_watched(true);
        pair.rtl.run(2 * FRAME);
        let (frame, of) = pair.rtl.scanned().expect("two frames were scanned out");
        assert_eq!(of, swaps + 1);
        for (index, pixel) in frame.pixels().iter().enumerate() {
            let (x, y) = (index % 640, index / 640);
            let expected = Rgb332(pair.model.front()[y / 2 * 320 + x / 2]).to_rgb888();
            assert_eq!(*pixel, expected, "({x}, {y}) of picture {place}");
        }
    }
}
