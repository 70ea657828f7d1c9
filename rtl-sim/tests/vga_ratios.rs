//! No frame tears, whatever the ratio of the two clocks: pictures from the pins while triangles are drawn to the other
//! buffer, and swaps that come at the edges of the window in which they may take place.

mod common;

use common::pair::Pair;
use common::random::Random;
use common::shapes::any_triangle;
use fpga_regs::packet::{Clear, swap};
use fpga_regs::screen::{DEPTH_FAR, Rgb332};

/// VGA clocks of a line, lines of a frame, and those of them that show.
const LINE: u64 = 800;
const LINES: u64 = 525;
const SHOWN: u64 = 480;
/// The last line in which a swap may take place.
const LAST: u64 = 522;
/// When the swaps come: a line, bus clocks after its beginning, and whether that is in time. The window is seen to end
/// a few clocks late: VGA's register, then the synchronizer.
const SWAPS: [(u64, u64, bool); 3] = [(SHOWN + 1, 0, true), (LAST, 600, true), (LAST + 1, 20, false)];
/// Bus clocks that the pair may leave out at a time while nothing happens.
const STRIDE: u64 = 1566;
/// Random triangles of a frame.
const TRIANGLES: usize = 15;

/// Runs both clocks to a line of the next vertical blank but the one that may be now.
fn to_line(pair: &mut Pair, line: u64) {
    let left = |pair: &Pair| pair.rtl.scan_left().0;
    while left(pair) > SHOWN * LINE {
        pair.rtl.run(STRIDE);
    }
    // In strides of at most three lines near it.
    while left(pair) <= SHOWN * LINE && left(pair) > 4 * LINE {
        pair.rtl.run(STRIDE);
    }
    while left(pair) != (LINES - line + SHOWN) * LINE {
        pair.rtl.clock(1);
    }
}

fn no_frame_tears(units: u32, vga_clocks_a_bus_clock: f64) {
    let mut pair = Pair::new(units);
    let mut random = Random::new(u64::from(units));
    pair.rtl.set_hurry(false);
    pair.rtl.set_scan(true);
    pair.rtl.set_vga_ratio((vga_clocks_a_bus_clock * 65536.0) as u32);
    // The front buffer after each swap; the first is what was there.
    let first = pair.rtl.swaps();
    let mut fronts = vec![pair.model.front().to_vec()];
    let mut shown = Vec::new();
    let mut check = |pair: &Pair, fronts: &[Vec<u8>]| {
        let Some((frame, swaps)) = pair.rtl.scanned() else { return };
        let number = (swaps - first) as usize;
        for (index, pixel) in frame.pixels().iter().enumerate() {
            let (x, y) = (index % 640, index / 640);
            let expected = Rgb332(fronts[number][y / 2 * 320 + x / 2]).to_rgb888();
            assert_eq!(*pixel, expected, "({x}, {y}) of frame {number} at {units} units");
        }
        shown.push(number);
    };
    for (line, clocks, in_time) in SWAPS {
        let colour = Rgb332(random.word() as u8);
        pair.push(&Clear { colour, depth: DEPTH_FAR }.encode());
        for _ in 0..TRIANGLES {
            pair.push(&any_triangle(&mut random).encode());
        }
        to_line(&mut pair, line);
        check(&pair, &fronts);
        pair.rtl.clock(clocks);
        let before = pair.rtl.swaps();
        pair.push(&swap());
        fronts.push(pair.model.front().to_vec());
        pair.rtl.clock(20);
        assert_eq!(pair.rtl.swaps() > before, in_time, "a swap in line {line} at {units} units");
    }
    // The last came too late: its frame shows one later.
    for line in [SHOWN + 1, SHOWN + 1] {
        to_line(&mut pair, line);
        check(&pair, &fronts);
    }
    assert_eq!(shown[shown.len() - 4..], [1, 2, 2, 3], "the frames that were shown, {shown:?}");
}

#[test]
fn none_tears_with_the_boards_clocks() {
    no_frame_tears(8, 25.175 / 50.0);
}

#[test]
fn none_tears_when_the_bus_is_slower_than_vga() {
    no_frame_tears(2, 25.175 / 20.0);
}
