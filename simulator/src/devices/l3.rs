//! The L3 interconnect's remap register: which windows answer. It is write-only.

use super::{Answer, no_register};

/// OCRAM stays at address 0 for masters that see it there.
const KEEP: u32 = 1 << 0;

/// The interconnect.
pub struct L3 {
    remap: u32,
}

impl Default for L3 {
    /// Both bridges' windows closed, as U-Boot leaves them.
    fn default() -> Self {
        Self { remap: KEEP }
    }
}

impl L3 {
    /// Returns whether a bridge's window answers: 0 wide, 1 lightweight.
    pub fn opens(&self, bridge: u32) -> bool {
        self.remap >> (3 + bridge) & 1 != 0
    }

    /// Reads a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn read(&self, offset: u32) -> Answer<u32> {
        if offset == 0 {
            return Err("remap is write only: keep a copy of what was written".into());
        }
        no_register(offset)
    }

    /// Writes a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn write(&mut self, offset: u32, value: u32) -> Answer<()> {
        match offset {
            0x00 if value & KEEP == 0 => Err(format!("bit 0 of remap, which U-Boot keeps set; {value:#x} clears it")),
            0x00 => {
                self.remap = value & 0x1B;
                Ok(())
            }
            // Slave security: the program is secure.
            0x08..=0xA0 => Ok(()),
            _ => no_register(offset),
        }
    }
}
