//! The reset manager: which blocks are in reset, why the last reset came, and a new one
//! (Intel's HPS manual 683126, chapter 4; registers of `alt_rstmgr.h`).
//!
//! U-Boot leaves every block in reset that it does not use. An access to such a block has no
//! answer: whoever drives one releases it first.

use super::reset_cause::ResetCause;
use crate::mmio::{Bus, Mmio, Register, Registers};

/// Registers of the reset manager. In the module registers a one holds the block in reset.
#[derive(Debug, Clone, Copy)]
pub enum Offset {
    /// STAT: why resets came; a one clears.
    Status = 0x00,
    /// CTRL.
    Control = 0x04,
    /// MPUMODRST.
    Processor = 0x10,
    /// PERMODRST.
    Peripherals = 0x14,
    /// BRGMODRST.
    Bridges = 0x1C,
}

impl Register for Offset {
    fn offset(self) -> usize {
        self as usize
    }
}

/// CTRL: asks for a warm reset.
const WARM_RESET: u32 = 1 << 1;
/// MPUMODRST: the second core.
const CORE_1: u32 = 1 << 1;
/// BRGMODRST: all three bridges.
const ALL_BRIDGES: u32 = 0b111;
/// BRGMODRST: the FPGA-to-HPS bridge, which nothing here uses.
const FPGA_TO_HPS: u32 = 0b100;

/// A block; the value is its bit in PERMODRST.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Peripheral {
    /// The USB host controller that is wired to the board's connectors.
    Usb1 = 3,
    /// The first L4 watchdog.
    Watchdog0 = 6,
    /// The UART behind the board's USB serial converter.
    Uart0 = 16,
    /// Pins 29 to 57.
    Gpio1 = 26,
}

/// The reset manager. Its changes are a read and a write each: not for interrupt handlers.
#[derive(Clone, Copy)]
pub struct ResetManager<B = Mmio> {
    registers: Registers<Offset, B>,
}

impl<B: Bus> ResetManager<B> {
    /// Returns the driver of a reset manager.
    #[must_use]
    pub const fn new(registers: Registers<Offset, B>) -> Self {
        Self { registers }
    }

    /// Takes a block out of reset. It may be touched at once.
    pub fn release(&self, peripheral: Peripheral) {
        self.registers.change(Offset::Peripherals, 1 << peripheral as u32, 0);
        self.registers.settle();
    }

    /// Puts a block into reset.
    pub fn hold(&self, peripheral: Peripheral) {
        self.registers.change(Offset::Peripherals, 0, 1 << peripheral as u32);
        self.registers.settle();
    }

    /// Puts the second core into reset, where U-Boot left it: the program runs on one core.
    pub fn hold_core_1(&self) {
        self.registers.change(Offset::Processor, 0, CORE_1);
    }

    /// Puts all bridges between processor and FPGA into reset.
    pub fn hold_bridges(&self) {
        self.registers.write(Offset::Bridges, ALL_BRIDGES);
        self.registers.settle();
    }

    /// Takes both HPS-to-FPGA bridges out of reset.
    pub fn release_bridges(&self) {
        self.registers.write(Offset::Bridges, FPGA_TO_HPS);
        self.registers.settle();
    }

    /// Returns why resets came since the last call, and forgets it: the hardware keeps the causes
    /// of warm resets until software clears them.
    #[must_use]
    pub fn take_cause(&self) -> ResetCause {
        let status = self.registers.read(Offset::Status);
        self.registers.write(Offset::Status, status);
        ResetCause(status)
    }

    /// Asks for a warm reset, which comes a little later: boot ROM, preloader and U-Boot run again.
    pub fn request_warm_reset(&self) {
        self.registers.change(Offset::Control, 0, WARM_RESET);
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::mmio::mock::{Access, MockBus};
    use std::collections::BTreeMap;

    #[test]
    fn releasing_a_block_leaves_the_others_as_they_are() {
        let bus = MockBus::new(BTreeMap::from([(0x1014, 0xFFFF_FFBF)]));
        let manager = ResetManager::new(Registers::on(bus.clone(), 0x1000));
        manager.release(Peripheral::Uart0);
        manager.release(Peripheral::Gpio1);
        manager.hold(Peripheral::Watchdog0);
        assert_eq!(bus.take_writes(), [(0x1014, 0xFFFE_FFBF), (0x1014, 0xFBFE_FFBF), (0x1014, 0xFBFE_FFFF)]);
    }

    #[test]
    fn causes_are_taken_once() {
        let bus = MockBus::new(BTreeMap::from([(0x1000, 1 << 14)]));
        let manager = ResetManager::new(Registers::on(bus.clone(), 0x1000));
        assert!(manager.take_cause().is_watchdog());
        assert_eq!(bus.take_journal(), [Access::Read(0x1000, 1 << 14), Access::Write(0x1000, 1 << 14)]);
    }

    #[test]
    fn a_warm_reset_keeps_the_other_bits_of_control() {
        let bus = MockBus::new(BTreeMap::from([(0x1004, 0x0010_0000)]));
        ResetManager::new(Registers::on(bus.clone(), 0x1000)).request_warm_reset();
        assert_eq!(bus.take_writes(), [(0x1004, 0x0010_0002)]);
    }
}
