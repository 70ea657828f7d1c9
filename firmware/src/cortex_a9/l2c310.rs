//! The L2 cache controller, PL310 (ARM DDI 0246). QEMU's takes every write and caches nothing.

use crate::mmio::{Register, Registers, poll};

/// Reads of a maintenance register before it is given up: a whole 512 KiB cache is written back
/// in well under a tenth of them.
const MAINTENANCE_POLLS: u32 = 10_000_000;
/// All eight ways.
const ALL_WAYS: u32 = 0xFF;

#[derive(Clone, Copy)]
enum Offset {
    Control = 0x100,
    AuxiliaryControl = 0x104,
    TagRamLatency = 0x108,
    DataRamLatency = 0x10C,
    Sync = 0x730,
    InvalidateLine = 0x770,
    InvalidateWays = 0x77C,
    CleanLine = 0x7B0,
}

impl Register for Offset {
    fn offset(self) -> usize {
        self as usize
    }
}

/// How the cache is set up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Config {
    /// TAG_RAM latency control register.
    pub tag_ram_latency: u32,
    /// DATA_RAM latency control register.
    pub data_ram_latency: u32,
    /// Bits set in AUX_CTRL: 22 shared-attribute override, 28 data prefetch, 29 instruction prefetch.
    pub auxiliary_control: u32,
}

impl Config {
    /// What U-Boot and Linux write on the Cyclone V (`socfpga_pl310_clear`, `socfpga.dtsi`).
    pub const CYCLONE_V: Self =
        Self { tag_ram_latency: 0x000, data_ram_latency: 0x010, auxiliary_control: 1 << 22 | 1 << 28 | 1 << 29 };
}

/// Why the L2 cache could not be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum L2Error {
    /// A maintenance operation did not end.
    Stuck,
}

impl core::fmt::Display for L2Error {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Stuck => formatter.write_str("L2 cache maintenance did not end"),
        }
    }
}

impl core::error::Error for L2Error {}

/// The L2 cache controller.
pub struct L2c310 {
    registers: Registers<Offset>,
}

impl L2c310 {
    /// Returns the driver of the controller at `address`.
    ///
    /// # Safety
    /// A PL310 answers at `address`, and no other driver writes to it.
    #[must_use]
    pub const unsafe fn at(address: usize) -> Self {
        // SAFETY: the caller's promise is the same.
        Self { registers: unsafe { Registers::at(address) } }
    }

    /// Sets the cache up, empties it and turns it on. Does nothing when it is on already.
    ///
    /// The cache must hold nothing that memory lacks, as after reset or after `_start`: its lines
    /// are dropped, not written back.
    ///
    /// # Errors
    /// [`L2Error::Stuck`], and the cache stays off.
    pub fn enable(&mut self, config: &Config) -> Result<(), L2Error> {
        if self.is_enabled() {
            return Ok(());
        }
        self.registers.write(Offset::TagRamLatency, config.tag_ram_latency);
        self.registers.write(Offset::DataRamLatency, config.data_ram_latency);
        self.registers.change(Offset::AuxiliaryControl, 0, config.auxiliary_control);
        self.registers.write(Offset::InvalidateWays, ALL_WAYS);
        self.wait(Offset::InvalidateWays, ALL_WAYS)?;
        self.drain()?;
        self.registers.write(Offset::Control, 1);
        Ok(())
    }

    /// Returns whether the cache is on.
    #[must_use]
    pub fn is_enabled(&self) -> bool {
        self.registers.read(Offset::Control) & 1 == 1
    }

    /// Writes the lines of a range back to memory. L1 is to be cleaned first.
    ///
    /// # Errors
    /// [`L2Error::Stuck`].
    pub fn clean(&mut self, address: u32, bytes: u32) -> Result<(), L2Error> {
        for line in crate::armv7a::cache_geometry::lines(address, bytes) {
            self.registers.write(Offset::CleanLine, line);
            self.wait(Offset::CleanLine, 1)?;
        }
        self.drain()
    }

    /// Drops the lines of a range. L1 is to be invalidated afterwards.
    ///
    /// # Safety
    /// As for L1: nothing else lies in the lines that the range touches, and what was written there
    /// last may be lost.
    ///
    /// # Errors
    /// [`L2Error::Stuck`].
    pub unsafe fn invalidate(&mut self, address: u32, bytes: u32) -> Result<(), L2Error> {
        for line in crate::armv7a::cache_geometry::lines(address, bytes) {
            self.registers.write(Offset::InvalidateLine, line);
            self.wait(Offset::InvalidateLine, 1)?;
        }
        self.drain()
    }

    /// Waits until the controller's buffers are drained.
    ///
    /// # Errors
    /// [`L2Error::Stuck`].
    pub fn drain(&mut self) -> Result<(), L2Error> {
        self.registers.write(Offset::Sync, 0);
        self.wait(Offset::Sync, 1)
    }

    /// Waits for a maintenance register's busy bits to clear.
    fn wait(&self, register: Offset, busy: u32) -> Result<(), L2Error> {
        if poll(MAINTENANCE_POLLS, || self.registers.read(register) & busy == 0) { Ok(()) } else { Err(L2Error::Stuck) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Plain memory reads back what is written, so its way operation never ends.
    #[test]
    fn a_cache_that_hangs_stays_off() {
        let mut memory = [0u32; 0x800 / 4];
        // SAFETY: plain memory stands in for the device and outlives the driver.
        let mut cache = unsafe { L2c310::at((&raw mut memory).expose_provenance()) };
        assert_eq!(cache.enable(&Config::CYCLONE_V), Err(L2Error::Stuck));
        assert!(!cache.is_enabled());
        assert_eq!(memory[0x10C / 4], 0x010);
        assert_eq!(memory[0x104 / 4], 0x3040_0000);
    }
}
