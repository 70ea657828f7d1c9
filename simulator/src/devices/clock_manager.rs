//! The clock manager, as SPL set it up. A program may look at it and turn clock gates; PLLs and
//! dividers stay as they are.

use super::map::Gate;
use super::{Answer, no_register};

/// The manager.
pub struct ClockManager {
    main_gates: u32,
    peripheral_gates: u32,
}

impl Default for ClockManager {
    /// All gates open.
    fn default() -> Self {
        Self { main_gates: 0x3FF, peripheral_gates: 0xFFF }
    }
}

impl ClockManager {
    /// Returns whether a clock runs.
    pub fn runs(&self, gate: Gate) -> bool {
        match gate {
            Gate::Main(bit) => self.main_gates >> bit & 1 != 0,
            Gate::Peripheral(bit) => self.peripheral_gates >> bit & 1 != 0,
            Gate::None => true,
        }
    }

    /// Reads a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn read(&self, offset: u32) -> Answer<u32> {
        Ok(match offset {
            // No safe mode, no bypass; all PLLs locked.
            0x00 | 0x04 => 0,
            0x08 => 0b111 << 6,
            // STAT: not busy.
            0x14 => 0,
            // VCO 1600 MHz = 25 · 64; MPU 1600 / 2.
            0x40 => 63 << 3,
            0x48 => 0,
            0xE0 => 1,
            0x60 => self.main_gates,
            // VCO 1000 MHz = 25 · 40.
            0x80 => 39 << 3,
            0xA0 => self.peripheral_gates,
            _ => return no_register(offset),
        })
    }

    /// Writes a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn write(&mut self, offset: u32, value: u32) -> Answer<()> {
        match offset {
            0x60 => self.main_gates = value & 0x3FF,
            0xA0 => self.peripheral_gates = value & 0xFFF,
            0x00..=0x14 | 0x40..=0xE8 => {
                return Err("PLLs and dividers stay as SPL set them: changing them is not modelled".into());
            }
            _ => return no_register(offset),
        }
        Ok(())
    }
}
