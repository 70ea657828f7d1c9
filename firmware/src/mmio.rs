//! Typed access to memory-mapped registers.
//!
//! A device is an enum of register offsets and a [`Registers`] of it. Addresses are held, never
//! references: a reference to a register would let the compiler read it when it likes.
//!
//! A driver that is generic over the [`Bus`] also runs on a PC, against a model of its device that
//! keeps a journal.

use core::marker::PhantomData;

#[cfg(test)]
pub(crate) mod mock;

/// Names the 32-bit registers of one kind of device.
pub trait Register: Copy {
    /// Returns the register's distance from the device's base address, in bytes; a multiple of 4.
    fn offset(self) -> usize;
}

/// What carries a register access.
pub trait Bus: Clone {
    /// Reads the 32-bit register at `address`, once.
    fn read(&self, address: usize) -> u32;

    /// Writes the 32-bit register at `address`, once.
    fn write(&self, address: usize, value: u32);

    /// Returns when the writes before have reached their devices: two devices see them in no order else.
    fn settle(&self);
}

/// The processor's own bus. Only [`Registers::at`] makes one, for its device.
#[derive(Clone, Copy)]
pub struct Mmio(());

impl Bus for Mmio {
    #[inline(always)]
    fn read(&self, address: usize) -> u32 {
        // SAFETY: `Registers::at`'s caller vouched for the device.
        unsafe { core::ptr::with_exposed_provenance::<u32>(address).read_volatile() }
    }

    #[inline(always)]
    fn write(&self, address: usize, value: u32) {
        // SAFETY: as in `read`.
        unsafe { core::ptr::with_exposed_provenance_mut::<u32>(address).write_volatile(value) }
    }

    #[inline(always)]
    fn settle(&self) {
        #[cfg(target_arch = "arm")]
        cortex_ar::asm::dsb();
    }
}

/// The registers of one device, all of them 32 bits wide.
///
/// Copies name the same device. Which copy touches which register is settled by the driver that
/// makes them; each says so.
pub struct Registers<R, B = Mmio> {
    base: usize,
    bus: B,
    kind: PhantomData<fn(R)>,
}

impl<R, B: Clone> Clone for Registers<R, B> {
    fn clone(&self) -> Self {
        Self { base: self.base, bus: self.bus.clone(), kind: PhantomData }
    }
}

impl<R, B: Copy> Copy for Registers<R, B> {}

impl<R: Register> Registers<R> {
    /// Returns the registers of the device at `address`.
    ///
    /// # Safety
    /// - A device with the registers that `R` names answers at `address`, from now on; once the
    ///   MMU is on, it is mapped as Device memory.
    /// - No other driver writes to that device.
    ///
    /// # Panics
    /// When `address` is zero or no multiple of 4 (at compile time, where it is a constant).
    #[must_use]
    pub const unsafe fn at(address: usize) -> Self {
        Self::on(Mmio(()), address)
    }
}

impl<R: Register, B: Bus> Registers<R, B> {
    /// Returns the registers of the device that is at `address` of a bus.
    ///
    /// # Panics
    /// As [`at`](Registers::at).
    #[must_use]
    pub const fn on(bus: B, address: usize) -> Self {
        assert!(address != 0, "no device answers at address 0");
        assert!(address.is_multiple_of(4), "a register block starts at a multiple of 4");
        Self { base: address, bus, kind: PhantomData }
    }

    /// Reads a register.
    #[inline(always)]
    pub fn read(&self, register: R) -> u32 {
        self.read_at(register, 0)
    }

    /// Writes a register.
    #[inline(always)]
    pub fn write(&self, register: R, value: u32) {
        self.write_at(register, 0, value);
    }

    /// Reads word `index` of an array of registers that begins at `first`.
    #[inline(always)]
    pub fn read_at(&self, first: R, index: usize) -> u32 {
        self.bus.read(self.address(first, index))
    }

    /// Writes word `index` of an array of registers that begins at `first`.
    #[inline(always)]
    pub fn write_at(&self, first: R, index: usize, value: u32) {
        self.bus.write(self.address(first, index), value);
    }

    /// Writes a register with some bits set and some cleared; the others keep their value.
    /// Read and write are two accesses: an interrupt handler must not change it in between.
    pub fn change(&self, register: R, clear: u32, set: u32) {
        self.write(register, (self.read(register) & !clear) | set);
    }

    /// Returns when the writes before, to this device and all others, have arrived.
    pub fn settle(&self) {
        self.bus.settle();
    }

    #[inline(always)]
    fn address(&self, first: R, index: usize) -> usize {
        self.base + first.offset() + 4 * index
    }
}

/// Asks for `condition` until it holds, at most `polls` times.
///
/// Returns whether the condition came true: no wait in this firmware is without a bound.
#[must_use]
pub fn poll(polls: u32, mut condition: impl FnMut() -> bool) -> bool {
    (0..polls).any(|_| condition())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Clone, Copy)]
    enum Device {
        Control = 0x4,
        Array = 0x8,
    }

    impl Register for Device {
        fn offset(self) -> usize {
            self as usize
        }
    }

    #[test]
    fn every_access_lands_at_its_offset() {
        let mut memory = [0u32; 5];
        let address = (&raw mut memory).expose_provenance();
        // SAFETY: plain memory stands in for the device and outlives the accesses.
        let registers = unsafe { Registers::<Device>::at(address) };
        registers.write(Device::Control, 0xf0);
        registers.change(Device::Control, 0x10, 0x01);
        registers.write_at(Device::Array, 2, 7);
        assert_eq!(registers.read(Device::Control), 0xe1);
        assert_eq!(registers.read_at(Device::Array, 2), 7);
        assert_eq!(memory, [0, 0xe1, 0, 0, 7]);
    }

    #[test]
    fn a_poll_gives_up() {
        let mut reads = 0;
        assert!(!poll(3, || {
            reads += 1;
            false
        }));
        assert_eq!(reads, 3);
        assert!(poll(3, || true));
        assert!(!poll(0, || true));
    }
}
