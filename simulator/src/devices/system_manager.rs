//! The system manager, as far as a program that U-Boot starts has to do with it.

use super::{Answer, no_register, read_only};
use crate::devices::ResetCause;

/// Hand-off words that U-Boot writes at each start; three more are the program's.
const UBOOT_WORDS: usize = 5;

/// The manager.
pub struct SystemManager {
    watchdog_debug: u32,
    interfaces: u32,
    individual: u32,
    modules: u32,
    handoff: [u32; 8],
    rom_control: u32,
    core1_start: u32,
    switch_state: [u32; 3],
    warm_ram: [u32; 5],
    usb_l3: u32,
}

impl SystemManager {
    /// Returns the manager as U-Boot leaves it.
    pub fn as_uboot_leaves_it() -> Self {
        Self {
            watchdog_debug: 0xF,
            interfaces: 1,
            individual: 0xFF,
            modules: 0,
            // Bridges in reset, remap closed, no module signals, no SDRAM ports.
            handoff: [7, 1, 0, 0, 0, 0, 0, 0],
            rom_control: 0,
            core1_start: 0,
            switch_state: [0x4953_5756, 0, 0],
            // A warm reset starts what lies in the on-chip RAM (U-Boot's `misc_gen5.c`).
            warm_ram: [0xAE9E_FEBC, 0, 0, 0, 0],
            usb_l3: 0,
        }
    }

    /// Returns the manager as U-Boot leaves it after a reset: the hand-off words that it does not
    /// write survive any but a cold one.
    pub fn after(&self, cause: ResetCause) -> Self {
        let mut fresh = Self::as_uboot_leaves_it();
        if !cause.is_cold() {
            fresh.handoff[UBOOT_WORDS..].copy_from_slice(&self.handoff[UBOOT_WORDS..]);
        }
        fresh
    }

    /// Returns whether signals may pass between processor and FPGA.
    pub fn fpga_interfaces(&self) -> bool {
        self.interfaces & 1 != 0
    }

    /// Reads a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn read(&self, offset: u32) -> Answer<u32> {
        Ok(match offset {
            0x000 => 0x0000_0001,
            0x004 => 0,
            0x010 => self.watchdog_debug,
            // BSEL 5: SD card.
            0x014 => 5,
            // Two cores, CAN.
            0x018 => 0b11,
            0x020 => self.interfaces,
            0x024 => self.individual,
            0x028 => self.modules,
            0x080..=0x09C => self.handoff[(offset as usize - 0x80) / 4],
            0x0C0 => self.rom_control,
            0x0C4 => self.core1_start,
            0x0C8..=0x0D0 => self.switch_state[(offset as usize - 0xC8) / 4],
            0x0E0..=0x0F0 => self.warm_ram[(offset as usize - 0xE0) / 4],
            0x118 => self.usb_l3,
            0x140..=0x170 => 0,
            _ => return no_register(offset),
        })
    }

    /// Writes a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn write(&mut self, offset: u32, value: u32) -> Answer<()> {
        match offset {
            0x000 | 0x004 | 0x014 | 0x018 => return read_only("the register"),
            0x010 => self.watchdog_debug = value & 0xF,
            0x020 => self.interfaces = value & 1,
            0x024 => self.individual = value & 0xFF,
            0x028 => self.modules = value,
            0x080..=0x09C => self.handoff[(offset as usize - 0x80) / 4] = value,
            0x0C0 => self.rom_control = value,
            0x0C4 => self.core1_start = value,
            0x0C8..=0x0D0 => self.switch_state[(offset as usize - 0xC8) / 4] = value,
            0x0E0..=0x0F0 => self.warm_ram[(offset as usize - 0xE0) / 4] = value,
            0x118 => self.usb_l3 = value,
            0x400.. => return Err("the pin mux is SPL's and is not changed later".into()),
            _ => return no_register(offset),
        }
        Ok(())
    }
}
