//! The snoop control unit (ARM DDI 0407, chapter 2).

use super::{Answer, no_register};

/// The unit's registers.
#[derive(Default)]
pub struct Scu {
    control: u32,
    access: u32,
    secure_access: u32,
    power: u32,
}

impl Scu {
    /// Returns whether it keeps the cores coherent.
    pub fn enabled(&self) -> bool {
        self.control & 1 != 0
    }

    /// Reads a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn read(&self, offset: u32) -> Answer<u32> {
        Ok(match offset {
            0x00 => self.control,
            // Two cores, 32 KiB of tags each.
            0x04 => 0x501,
            0x08 => self.power,
            0x0C => 0,
            0x50 => self.access,
            0x54 => self.secure_access,
            _ => return no_register(offset),
        })
    }

    /// Writes a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn write(&mut self, offset: u32, value: u32) -> Answer<()> {
        match offset {
            0x00 => self.control = value,
            0x08 => self.power = value,
            // Invalidates tags, at once.
            0x0C => {}
            0x50 => self.access = value,
            0x54 => self.secure_access = value,
            _ => return no_register(offset),
        }
        Ok(())
    }
}
