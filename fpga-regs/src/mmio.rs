//! The bridge itself: memory-mapped registers and the FIFO aperture.
#![allow(unsafe_code)]

use core::ptr::NonNull;

use volatile_register::RW;

use crate::port::Port;
use crate::registers::{Register, RegisterBlock};
use crate::screen::FIFO_APERTURE_WORDS;

/// A [`Port`] on the HPS-to-FPGA bridges.
///
/// Holds pointers, never references: a reference to a register block would let the compiler
/// read it when it likes.
pub struct MmioPort {
    registers: NonNull<RegisterBlock>,
    aperture: NonNull<[u32; FIFO_APERTURE_WORDS]>,
}

// SAFETY: the port owns the device (see `new`), so it may move to another core; register
// accesses carry no thread's state.
unsafe impl Send for MmioPort {}

impl MmioPort {
    /// Returns the port on a register agent and a FIFO aperture.
    ///
    /// # Safety
    /// - `registers` points at Halfspace's register agent and `aperture` at its FIFO agent, both
    ///   mapped as Device memory, for as long as the port lives.
    /// - The FPGA is configured and both bridges are open before the first access.
    /// - No other port is made on the same device.
    pub const unsafe fn new(registers: NonNull<RegisterBlock>, aperture: NonNull<[u32; FIFO_APERTURE_WORDS]>) -> Self {
        Self { registers, aperture }
    }

    /// Returns the cell of a register. Every register is a `u32` cell at its own offset.
    fn cell(&self, register: Register) -> *const RW<u32> {
        // SAFETY: `Register`'s offsets lie inside `RegisterBlock` (asserted at compile time).
        unsafe { self.registers.as_ptr().byte_add(register as usize).cast::<RW<u32>>() }
    }
}

impl Port for MmioPort {
    fn read(&mut self, register: Register) -> u32 {
        // SAFETY: `new`'s caller gave a live register agent; the cell is aligned and inside it,
        // and the shared reference lives for this one volatile access.
        unsafe { (*self.cell(register)).read() }
    }

    fn write(&mut self, register: Register, value: u32) {
        // SAFETY: as in `read`; the device ignores a write to a read-only register.
        unsafe { (*self.cell(register)).write(value) }
    }

    fn push(&mut self, words: &[u32]) {
        // Rising addresses, so that the processor can join the stores into bursts.
        for chunk in words.chunks(FIFO_APERTURE_WORDS) {
            for (index, word) in chunk.iter().enumerate() {
                // SAFETY: `index` is below the aperture's length, and `new`'s caller gave a
                // live FIFO agent.
                unsafe { self.aperture.as_ptr().cast::<u32>().add(index).write_volatile(*word) };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registers::REGISTER_BYTES;

    /// Plain memory shows which addresses are touched; a FIFO's behaviour is the mock's matter.
    #[test]
    fn accesses_go_to_the_registers_own_address_and_words_to_rising_ones() {
        let mut registers = vec![0u32; REGISTER_BYTES / 4];
        let mut aperture = [0u32; FIFO_APERTURE_WORDS];
        registers[Register::Status as usize / 4] = 0x1234;
        // SAFETY: both point at memory of the right size that outlives the port.
        let mut port = unsafe {
            MmioPort::new(
                NonNull::new(registers.as_mut_ptr().cast()).unwrap(),
                NonNull::new(&raw mut aperture).unwrap(),
            )
        };
        assert_eq!(port.read(Register::Status), 0x1234);
        port.write(Register::LowWater, 77);
        let words: Vec<u32> = (1..=FIFO_APERTURE_WORDS as u32 + 2).collect();
        port.push(&words);
        assert_eq!(registers[0x18 / 4], 77);
        assert_eq!(aperture[..3], [1025, 1026, 3]);
        assert_eq!(aperture[FIFO_APERTURE_WORDS - 1], 1024);
    }
}
