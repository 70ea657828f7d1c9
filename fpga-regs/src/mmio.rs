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

    /// Each push begins at the aperture's start and goes to rising addresses, so that the processor makes
    /// bursts of its stores.
    fn push(&mut self, words: &[u32]) {
        for chunk in words.chunks(FIFO_APERTURE_WORDS) {
            let aperture = self.aperture.as_ptr().cast::<u32>();
            let (bursts, rest) = chunk.as_chunks();
            for (index, burst) in bursts.iter().enumerate() {
                // SAFETY: the chunk is no longer than the aperture, and `new`'s caller gave a live
                // FIFO agent.
                unsafe { write_burst(aperture.add(BURST_WORDS * index), burst) };
            }
            for (index, word) in rest.iter().enumerate() {
                // SAFETY: as above.
                unsafe { aperture.add(BURST_WORDS * bursts.len() + index).write_volatile(*word) };
            }
        }
    }
}

/// Words that one store instruction writes: 32 bytes, the longest burst of a Cortex-A9's port for Device memory.
const BURST_WORDS: usize = 8;

/// Writes eight words to eight rising addresses by one instruction.
///
/// An interrupt cannot make the processor write a word twice: it abandons a store to Device memory half-way
/// only when SCTLR.FI is set (ARM DDI 0406, §A3.5.7), and the Cortex-A9 has no such mode.
///
/// # Safety
/// As eight volatile writes. `destination` is a multiple of 4.
#[cfg(target_arch = "arm")]
#[inline(always)]
unsafe fn write_burst(destination: *mut u32, words: &[u32; BURST_WORDS]) {
    // SAFETY: reads the eight words and writes what the caller vouches for; no flag, no stack.
    unsafe {
        core::arch::asm!(
            "ldm {words}, {{r2, r3, r4, r5, r8, r9, r10, r12}}",
            "stm {destination}, {{r2, r3, r4, r5, r8, r9, r10, r12}}",
            words = in(reg) words,
            destination = in(reg) destination,
            out("r2") _, out("r3") _, out("r4") _, out("r5") _,
            out("r8") _, out("r9") _, out("r10") _, out("r12") _,
            options(nostack, preserves_flags)
        );
    }
}

/// The same on a PC, a word at a time.
///
/// # Safety
/// As eight volatile writes. `destination` is a multiple of 4.
#[cfg(not(target_arch = "arm"))]
unsafe fn write_burst(destination: *mut u32, words: &[u32; BURST_WORDS]) {
    for (index, word) in words.iter().enumerate() {
        // SAFETY: the caller's promise is the same.
        unsafe { destination.add(index).write_volatile(*word) };
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

    /// Whole bursts, and what is left of one: every length begins at the start and is in order.
    #[test]
    fn words_of_every_number_are_pushed_in_order() {
        for count in 0..=3 * BURST_WORDS {
            let mut registers = vec![0u32; REGISTER_BYTES / 4];
            let mut aperture = [0u32; FIFO_APERTURE_WORDS];
            // SAFETY: as above.
            let mut port = unsafe {
                MmioPort::new(
                    NonNull::new(registers.as_mut_ptr().cast()).unwrap(),
                    NonNull::new(&raw mut aperture).unwrap(),
                )
            };
            let words: Vec<u32> = (1..=count as u32).collect();
            port.push(&words);
            assert_eq!(aperture[..count], words);
            assert!(aperture[count..].iter().all(|word| *word == 0));
        }
    }
}
