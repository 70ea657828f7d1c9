//! The console: a DesignWare 16550 with 32-bit registers, set up by U-Boot (115,200 baud, 8N1).

use crate::mmio::{Register, Registers, poll};
use core::fmt;

/// Reads of the status before a full transmitter is given up. A byte takes 87 µs, and a read of
/// a peripheral at least 50 ns.
const TRANSMIT_POLLS: u32 = 1_000_000;
/// LSR: the transmit holding register, or its FIFO, is empty.
const TRANSMIT_EMPTY: u32 = 1 << 5;

#[derive(Clone, Copy)]
enum Offset {
    TransmitHolding = 0x00,
    LineStatus = 0x14,
}

impl Register for Offset {
    fn offset(self) -> usize {
        self as usize
    }
}

/// A line that only sends, and waits for room itself.
pub struct Transmitter {
    registers: Registers<Offset>,
}

impl Transmitter {
    /// Returns the driver of the UART at `address`.
    ///
    /// # Safety
    /// A DesignWare 16550 answers at `address` and is set up; no other driver writes to it.
    #[must_use]
    pub const unsafe fn at(address: usize) -> Self {
        // SAFETY: the caller's promise is the same.
        Self { registers: unsafe { Registers::at(address) } }
    }

    fn send(&mut self, byte: u8) -> fmt::Result {
        let ready = || self.registers.read(Offset::LineStatus) & TRANSMIT_EMPTY != 0;
        if !poll(TRANSMIT_POLLS, ready) {
            return Err(fmt::Error);
        }
        self.registers.write(Offset::TransmitHolding, u32::from(byte));
        Ok(())
    }
}

/// Text: every line feed is sent with a carriage return before it.
impl fmt::Write for Transmitter {
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
