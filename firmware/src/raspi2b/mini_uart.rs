//! The console: the auxiliary block's mini UART, which only sends here ("BCM2835 ARM Peripherals",
//! §2.2).

use crate::mmio::{Register, Registers, poll};
use core::fmt;

/// Reads of the status before a full transmitter is given up. A byte takes 87 µs, and a read of
/// a peripheral at least 50 ns.
const TRANSMIT_POLLS: u32 = 1_000_000;
/// AUX_ENABLES: the mini UART answers.
const ENABLE_MINI_UART: u32 = 1 << 0;
/// AUX_MU_LCR_REG: eight bits. Both bits are needed, whatever the manual says of bit 1.
const EIGHT_BITS: u32 = 0b11;
/// AUX_MU_IIR_REG: empty both FIFOs.
const CLEAR_FIFOS: u32 = 0b11 << 1;
/// AUX_MU_CNTL_REG: send.
const TRANSMITTER_ON: u32 = 1 << 1;
/// AUX_MU_LSR_REG: there is room for a byte.
const TRANSMIT_ROOM: u32 = 1 << 5;

#[derive(Clone, Copy)]
enum Offset {
    Enables = 0x04,
    Data = 0x40,
    InterruptEnable = 0x44,
    InterruptIdentify = 0x48,
    LineControl = 0x4C,
    LineStatus = 0x54,
    Control = 0x60,
    BaudRate = 0x68,
}

impl Register for Offset {
    fn offset(self) -> usize {
        self as usize
    }
}

/// A line that only sends text. Every line feed is sent with a carriage return before it.
///
/// It waits for room itself, and fails when none comes.
pub struct Console {
    registers: Registers<Offset>,
}

impl Console {
    /// Sets the mini UART of the auxiliary block at `address` up for sending, eight bits.
    ///
    /// # Safety
    /// A BCM2835 auxiliary block answers at `address`, and no other driver writes to it.
    #[must_use]
    pub unsafe fn new(address: usize, clock_hertz: u32, baud: u32) -> Self {
        // SAFETY: the caller's promise is the same.
        let console = unsafe { Self::steal(address) };
        console.registers.change(Offset::Enables, 0, ENABLE_MINI_UART);
        console.registers.write(Offset::Control, 0);
        console.registers.write(Offset::InterruptEnable, 0);
        console.registers.write(Offset::LineControl, EIGHT_BITS);
        console.registers.write(Offset::InterruptIdentify, CLEAR_FIFOS);
        console.registers.write(Offset::BaudRate, divisor(clock_hertz, baud));
        console.registers.write(Offset::Control, TRANSMITTER_ON);
        console
    }

    /// Returns a line that was set up already, for a last word.
    ///
    /// # Safety
    /// A BCM2835 auxiliary block answers at `address`, its mini UART set up; whoever had it is not
    /// in the middle of a write that matters.
    #[must_use]
    pub const unsafe fn steal(address: usize) -> Self {
        // SAFETY: the caller's promise is the same.
        Self { registers: unsafe { Registers::at(address) } }
    }

    fn send(&self, byte: u8) -> fmt::Result {
        if !poll(TRANSMIT_POLLS, || self.registers.read(Offset::LineStatus) & TRANSMIT_ROOM != 0) {
            return Err(fmt::Error);
        }
        self.registers.write(Offset::Data, u32::from(byte));
        Ok(())
    }
}

impl fmt::Write for Console {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for byte in text.bytes() {
            if byte == b'\n' {
                self.send(b'\r')?;
            }
            self.send(byte)?;
        }
        Ok(())
    }
}

/// The baud rate register: clock / (8 · baud) − 1, rounded to the nearest.
const fn divisor(clock_hertz: u32, baud: u32) -> u32 {
    ((clock_hertz + 4 * baud) / (8 * baud)).saturating_sub(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::fmt::Write;

    #[test]
    fn a_stuck_transmitter_is_given_up() {
        let mut memory = [0_u32; 0x6C / 4];
        // SAFETY: plain memory stands in for the device and outlives the driver.
        let mut console = unsafe { Console::new((&raw mut memory).expose_provenance(), 250_000_000, 115_200) };
        assert_eq!(console.write_str("x"), Err(fmt::Error));
        // 250 MHz / (8 · 115,200) = 271.27.
        assert_eq!(memory[0x68 / 4], 270);
        assert_eq!((memory[1], memory[0x60 / 4]), (1, 2));
    }
}
