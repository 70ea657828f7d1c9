//! The reset manager: what is held in reset, and why the processor was reset last.

use super::{Answer, no_register};
use crate::devices::ResetCause;

/// Peripherals that U-Boot has out of reset when it starts a program: those that it uses itself
/// (UART0, SDMMC, OSC1 timer 0, SDRAM controller, L4 watchdog 0).
const UBOOT_RELEASED: u32 = 1 << 6 | 1 << 8 | 1 << 16 | 1 << 22 | 1 << 29;
/// All bits of PERMODRST.
const PERIPHERALS: u32 = 0x3FFF_FFFF;
/// STAT: power-on.
const STATUS_POWER_ON: u32 = 1 << 0;
const STATUS_BITS: u32 = 0x1F0C_F71F;

/// The manager.
pub struct ResetManager {
    status: u32,
    control: u32,
    counts: u32,
    /// A one holds in reset, in all of these.
    processors: u32,
    peripherals: u32,
    dma_requests: u32,
    bridges: u32,
    others: u32,
    requested: Option<ResetCause>,
}

impl ResetManager {
    /// Returns the manager as U-Boot leaves it after a power-on.
    pub fn as_uboot_leaves_it() -> Self {
        Self {
            status: STATUS_POWER_ON,
            control: 1 << 20,
            counts: 0x0008_0080,
            processors: 0b10,
            peripherals: PERIPHERALS & !UBOOT_RELEASED,
            dma_requests: 0xFF,
            bridges: 0b111,
            others: 0,
            requested: None,
        }
    }

    /// Returns the manager as U-Boot leaves it after a reset of its own; the status keeps what was not cleared.
    pub fn after(&self, cause: ResetCause) -> Self {
        let kept = if cause.is_cold() { 0 } else { self.status };
        Self { status: kept | 1 << cause.status_bit(), ..Self::as_uboot_leaves_it() }
    }

    /// Returns whether a peripheral is held in reset.
    pub fn holds_peripheral(&self, bit: u32) -> bool {
        self.peripherals >> bit & 1 != 0
    }

    /// Returns PERMODRST.
    pub fn peripherals(&self) -> u32 {
        self.peripherals
    }

    /// Returns whether a bridge is held in reset: 0 wide, 1 lightweight.
    pub fn holds_bridge(&self, bit: u32) -> bool {
        self.bridges >> bit & 1 != 0
    }

    /// Takes the reset that software asked for.
    pub fn take_request(&mut self) -> Option<ResetCause> {
        self.requested.take()
    }

    /// Returns whether software asked for a reset.
    pub fn requests(&self) -> bool {
        self.requested.is_some()
    }

    /// Reads a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn read(&self, offset: u32) -> Answer<u32> {
        Ok(match offset {
            0x00 => self.status,
            0x04 => self.control,
            0x08 => self.counts,
            0x10 => self.processors,
            0x14 => self.peripherals,
            0x18 => self.dma_requests,
            0x1C => self.bridges,
            0x20 => self.others,
            _ => return no_register(offset),
        })
    }

    /// Writes a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn write(&mut self, offset: u32, value: u32) -> Answer<()> {
        match offset {
            0x00 => self.status &= !(value & STATUS_BITS),
            0x04 => {
                self.requested = match value & 0b11 {
                    0 => None,
                    0b10 => Some(ResetCause::SoftwareWarm),
                    _ => Some(ResetCause::SoftwareCold),
                };
                self.control = value & !0b11;
            }
            0x08 => self.counts = value,
            0x10 if value & 0b1_1101 != 0 => {
                return Err(format!("core 0, its watchdogs, SCU and L2 out of reset: {value:#x} would end the run"));
            }
            0x10 if value & 0b10 == 0 => return Err("core 1 is not modelled: leave it in reset".into()),
            0x10 => {}
            0x14 => self.peripherals = value & PERIPHERALS,
            0x18 => self.dma_requests = value & 0xFF,
            0x1C => self.bridges = value & 0b111,
            0x20 => self.others = value,
            _ => return no_register(offset),
        }
        Ok(())
    }
}
