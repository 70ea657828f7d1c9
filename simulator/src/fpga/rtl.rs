//! The FPGA as the verilated SystemVerilog of `rtl/`, clocked by virtual time; the screen is what its
//! VGA pins say.

use fpga_regs::registers::{Control, Register};
use rtl_sim::Rtl;
use send_wrapper::SendWrapper;

use super::{Fpga, Screen};
use crate::time::{CPU_HERTZ, Clocks};

/// Processor clocks in a clock of the fabric and of its bridges: 50 MHz, as `fpga/system.tcl` sets it.
const FABRIC_CLOCK: Clocks = 16;
const FABRIC_HERTZ: u64 = CPU_HERTZ / FABRIC_CLOCK;
/// VGA's clock.
const VGA_HERTZ: u64 = 25_175_000;
/// VGA clocks in a fabric clock, in 1/65,536, rounded.
const VGA_RATIO: u32 = ((VGA_HERTZ * 65_536 + FABRIC_HERTZ / 2) / FABRIC_HERTZ) as u32;
/// How often the design is brought up to now and its interrupt line looked at, while nothing accesses it: a line of
/// VGA, 31 µs: as many clocks as are left out at a time, and those run after them.
const LOOK: Clocks = 1_566 * FABRIC_CLOCK;

/// The design, verilated.
pub struct Verilated {
    /// Made and used in one thread; only the processor's library wants more to be possible.
    rtl: SendWrapper<Rtl>,
    units: u32,
    /// Fabric clocks that were left out.
    left_out: u64,
    /// Those of them in which a swap waited, since the counters were reset; to a line of VGA.
    waited: u64,
    /// Swaps before the last reset of the design.
    shown: u64,
    /// Fabric clocks at the design's reset.
    start: u64,
    /// When it is looked at next.
    look_at: Clocks,
    /// Someone waits for a picture.
    watched: bool,
}

impl Verilated {
    /// Returns the design with 1, 2, 4 or 8 pixel units.
    ///
    /// # Panics
    /// For another number.
    pub fn new(units: u32) -> Self {
        let mut rtl = Rtl::new(units);
        rtl.set_hurry(false);
        rtl.set_vga_ratio(VGA_RATIO);
        rtl.set_scan(true);
        rtl.set_watched(false);
        let start = rtl.clocks();
        Self { rtl: SendWrapper::new(rtl), units, left_out: 0, waited: 0, shown: 0, start, look_at: 0, watched: false }
    }

    /// Runs the design up to now.
    fn catch_up(&mut self, now: Clocks) {
        self.look_at = now + LOOK;
        let done = self.rtl.clocks() - self.start + self.left_out;
        let due = (now / FABRIC_CLOCK).saturating_sub(done);
        if due > 0 {
            let waits = self.rtl.busy();
            let left_out = self.rtl.run(due);
            self.left_out += left_out;
            if waits {
                self.waited += left_out;
            }
        }
        if self.watched && self.rtl.swaps_scanned() == Some(self.rtl.swaps()) {
            self.watch(false);
        }
    }

    fn watch(&mut self, on: bool) {
        if on != self.watched {
            self.watched = on;
            self.rtl.set_watched(on);
        }
    }
}

impl Fpga for Verilated {
    fn read(&mut self, offset: u32, now: Clocks) -> u32 {
        self.catch_up(now);
        let value = self.rtl.read_offset(offset);
        match Register::at(offset as usize) {
            Some(Register::BusyCycles | Register::StalledCycles) => value.wrapping_add(self.waited as u32),
            _ => value,
        }
    }

    fn write(&mut self, offset: u32, value: u32, now: Clocks) {
        self.catch_up(now);
        if offset == Register::Control as u32 && Control(value).reset() {
            self.waited = 0;
        }
        self.rtl.write_offset(offset, value);
    }

    fn push(&mut self, word: u32, now: Clocks) -> Clocks {
        self.catch_up(now);
        self.rtl.push_word(word) * FABRIC_CLOCK
    }

    fn advance(&mut self, now: Clocks) {
        if now >= self.look_at {
            self.catch_up(now);
        }
    }

    fn next_event(&self, _: Clocks) -> Clocks {
        self.look_at
    }

    fn interrupt(&self) -> bool {
        self.rtl.irq()
    }

    fn frames_shown(&self) -> u64 {
        self.shown + self.rtl.swaps()
    }

    fn screen(&mut self) -> Option<Screen> {
        Screen::new(self.rtl.scanned()?.0.pixels().to_vec())
    }

    fn scanned_out(&mut self, now: Clocks) -> Clocks {
        let swaps = self.rtl.swaps();
        if self.rtl.swaps_scanned() == Some(swaps) {
            return now;
        }
        self.watch(true);
        let (clocks, of) = self.rtl.scan_left();
        // The picture under way may have begun before the last swap; then look again at its end.
        let clocks = if of == swaps { clocks } else { clocks + 1 };
        now + clocks * CPU_HERTZ / VGA_HERTZ + LOOK
    }

    fn reset(&mut self, now: Clocks) {
        *self =
            Self { shown: self.frames_shown(), left_out: now / FABRIC_CLOCK, look_at: now, ..Self::new(self.units) };
    }
}
