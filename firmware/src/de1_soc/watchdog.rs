//! The first L4 watchdog: resets the board when the program stops advancing
//! (a DesignWare watchdog, Intel's HPS manual 683126, chapter 25; registers of `alt_l4wd.h`).
//!
//! Once it runs, only its own block reset stops it. Boot ROM and preloader use it, too; U-Boot leaves it off.

use super::reset_manager::{Peripheral, ResetManager};
use crate::mmio::{Bus, Mmio, Register, Registers};

/// Registers of the watchdog.
#[derive(Debug, Clone, Copy)]
pub enum Offset {
    /// CR.
    Control = 0x00,
    /// TORR: the first time-out and the later ones.
    Timeout = 0x04,
    /// CRR: begins the time-out anew.
    Restart = 0x0C,
}

impl Register for Offset {
    fn offset(self) -> usize {
        self as usize
    }
}

/// CR: on, and a reset at once, without an interrupt before it.
const ENABLE: u32 = 1;
/// What CRR wants.
const RESTART: u32 = 0x76;
/// The time-out is 2^(16 + this) ticks of 25 MHz.
const PERIOD: u32 = 10;

/// How long the program may take from one [`feed`](Watchdog::feed) to the next, in microseconds: 2.68 s.
pub const LIMIT_US: u32 = ((1 << (16 + PERIOD)) as u64 * 1_000_000 / super::memory_map::WATCHDOG_HERTZ as u64) as u32;

/// The watchdog.
pub struct Watchdog<B = Mmio> {
    registers: Registers<Offset, B>,
    resets: ResetManager<B>,
}

impl<B: Bus> Watchdog<B> {
    /// Returns the driver of the first L4 watchdog. It is as it was left.
    #[must_use]
    pub const fn new(registers: Registers<Offset, B>, resets: ResetManager<B>) -> Self {
        Self { registers, resets }
    }

    /// Starts it, afresh if it runs: without [`feed`](Self::feed) it resets the board after
    /// [`LIMIT_US`].
    pub fn start(&mut self) {
        self.stop();
        self.resets.release(Peripheral::Watchdog0);
        self.registers.write(Offset::Timeout, PERIOD << 4 | PERIOD);
        self.registers.write(Offset::Control, ENABLE);
        self.feed();
    }

    /// Begins the time-out anew. Only a running, released watchdog may be fed.
    pub fn feed(&mut self) {
        self.registers.write(Offset::Restart, RESTART);
    }

    /// Stops it, by its block reset.
    pub fn stop(&mut self) {
        self.resets.hold(Peripheral::Watchdog0);
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::mmio::mock::MockBus;
    use std::collections::BTreeMap;

    const RESETS: usize = 0xFFD0_5014;

    #[test]
    fn it_is_set_up_out_of_its_reset_and_before_it_runs() {
        let bus = MockBus::new(BTreeMap::from([(RESETS, 0)]));
        let resets = ResetManager::new(Registers::on(bus.clone(), 0xFFD0_5000));
        let mut watchdog = Watchdog::new(Registers::on(bus.clone(), 0xFFD0_2000), resets);
        watchdog.start();
        watchdog.stop();
        assert_eq!(
            bus.take_writes(),
            [(RESETS, 0x40), (RESETS, 0), (0xFFD0_2004, 0xAA), (0xFFD0_2000, 1), (0xFFD0_200C, 0x76), (RESETS, 0x40),]
        );
    }

    #[test]
    fn the_limit_is_2_7_seconds() {
        assert_eq!(LIMIT_US, 2_684_354);
    }
}
