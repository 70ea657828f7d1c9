//! BUSY_CYCLES and STALLED_CYCLES, against clocks that are known. The model has none, so the streams do not compare them.

mod common;

use fpga_regs::Port;
use fpga_regs::packet::{Clear, swap};
use fpga_regs::registers::{Control, Register};
use fpga_regs::screen::{DEPTH_FAR, PIXELS, Rgb332};
use rtl_sim::{Rtl, UNITS};

const PATIENCE: u64 = 1_000_000;
/// Clocks of a clear besides those of its tiles, by the pipeline's table in `rtl/README.md`: its second word; the packet
/// decoded; setup; walk; queue; and the last tile in the evaluator's two stages and the pixel unit's two.
const CLEAR_OVERHEAD: u32 = 1 + 1 + 3 + 1 + 1 + 2 + 2;

fn enabled(units: u32) -> Rtl {
    let mut rtl = Rtl::new(units);
    rtl.set_hurry(false);
    rtl.write(Register::Control, Control::default().with_enable(true).0);
    rtl
}

fn clear() -> [u32; Clear::WORDS] {
    Clear { colour: Rgb332::BLACK, depth: DEPTH_FAR }.encode()
}

#[test]
fn a_clear_is_busy_for_its_tiles_and_the_pipeline() {
    for units in UNITS {
        let mut rtl = enabled(units);
        rtl.clock(100);
        assert_eq!(rtl.read(Register::BusyCycles), 0, "an idle device counts nothing");
        let clocks = PIXELS as u32 / units + CLEAR_OVERHEAD;
        for count in 1..=2 {
            rtl.push(&clear());
            rtl.rest(PATIENCE);
            rtl.clock(100);
            assert_eq!(rtl.read(Register::BusyCycles), count * clocks, "{count} clears at {units} units");
        }
        assert_eq!(rtl.read(Register::StalledCycles), 0);
        rtl.write(Register::Control, Control::default().with_enable(true).with_reset(true).0);
        // The reset is done in the next clock.
        rtl.clock(1);
        assert_eq!(rtl.read(Register::BusyCycles), 0, "after a reset");
    }
}

#[test]
fn a_packet_that_lacks_words_is_under_way() {
    for units in UNITS {
        let mut rtl = enabled(units);
        rtl.push(&clear()[..1]);
        rtl.clock(10);
        let (before, begin) = (rtl.read(Register::BusyCycles), rtl.clocks());
        rtl.clock(1234);
        let after = rtl.read(Register::BusyCycles);
        assert_eq!(u64::from(after - before), rtl.clocks() - begin, "at {units} units");
    }
}

#[test]
fn a_swap_stalls_for_as_long_as_vga_stands_still_and_not_while_all_before_it_is_drawn() {
    for units in UNITS {
        let mut rtl = enabled(units);
        rtl.push(&clear());
        rtl.push(&swap());
        let tiles = PIXELS as u64 / u64::from(units);
        rtl.clock(tiles - 100);
        assert_eq!(rtl.read(Register::StalledCycles), 0, "the clear is not drawn yet, at {units} units");
        rtl.clock(200);
        let (before, begin) = (rtl.read(Register::StalledCycles), rtl.clocks());
        rtl.clock(54_321);
        let (after, end) = (rtl.read(Register::StalledCycles), rtl.clocks());
        assert_eq!(u64::from(after - before), end - begin, "at {units} units");
        // Read a clock later: busy ever since the clear's first word, stalled ever since it was done.
        let busy = rtl.read(Register::BusyCycles);
        assert_eq!(busy - (after + 1), tiles as u32 + CLEAR_OVERHEAD, "at {units} units");
        assert!(rtl.swap_pending());
        rtl.set_vga_ratio(1 << 16);
        rtl.rest(PATIENCE);
        let stalled = rtl.read(Register::StalledCycles);
        rtl.clock(1000);
        assert_eq!(rtl.read(Register::StalledCycles), stalled, "nothing waits after the swap, at {units} units");
        assert_eq!(rtl.read(Register::FramesShown), 1);
    }
}
