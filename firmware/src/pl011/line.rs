//! What sending and receiving share: registers, set-up, one byte each way.

use crate::mmio::{Register, Registers, poll};

/// Reads of the flags before a full transmitter is given up. A byte takes 87 µs at 115,200 baud,
/// and a read of a peripheral at least 50 ns.
const TRANSMIT_POLLS: u32 = 1_000_000;

const FLAG_BUSY: u32 = 1 << 3;
const FLAG_RECEIVE_EMPTY: u32 = 1 << 4;
const FLAG_TRANSMIT_FULL: u32 = 1 << 5;
const LINE_CONTROL_8_BITS_FIFO: u32 = 0b11 << 5 | 1 << 4;
const CONTROL_ENABLE_BOTH: u32 = 1 << 9 | 1 << 8 | 1 << 0;
/// Receive and receive-timeout interrupts.
pub(super) const RECEIVE_INTERRUPTS: u32 = 1 << 4 | 1 << 6;
/// Overrun, break, parity and framing error, beside the byte.
const DATA_ERRORS: u32 = 0xF << 8;

#[derive(Clone, Copy)]
pub(super) enum Offset {
    Data = 0x00,
    Flags = 0x18,
    IntegerBaudRate = 0x24,
    FractionalBaudRate = 0x28,
    LineControl = 0x2C,
    Control = 0x30,
    InterruptMask = 0x38,
}

impl Register for Offset {
    fn offset(self) -> usize {
        self as usize
    }
}

/// How a line runs: 8 data bits, no parity, one stop bit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Config {
    /// The UART's clock, in hertz.
    pub clock_hertz: u32,
    /// Bits per second.
    pub baud: u32,
}

impl Config {
    /// The baud rate divisor in 1/64, rounded to the nearest: clock / (16 · baud).
    const fn divisor_64ths(self) -> u32 {
        let baud = self.baud as u64;
        ((self.clock_hertz as u64 * 8 + baud) / (2 * baud)) as u32
    }
}

/// Why bytes could not be sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum SerialError {
    /// The transmitter stayed full: its clock is off, or flow control holds it.
    TransmitterStuck,
}

impl core::fmt::Display for SerialError {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::TransmitterStuck => formatter.write_str("the serial transmitter stayed full"),
        }
    }
}

impl core::error::Error for SerialError {}

impl embedded_io::Error for SerialError {
    fn kind(&self) -> embedded_io::ErrorKind {
        embedded_io::ErrorKind::TimedOut
    }
}

/// What the receiver gave.
pub(super) enum ReceivedWord {
    Byte(u8),
    /// A broken byte, or a good one after others were lost; it is dropped, so that a reader's
    /// check of a whole message fails rather than takes it for something else.
    Damaged,
}

/// One PL011. Copies are its receiving and its sending side.
#[derive(Clone, Copy)]
pub(super) struct Line {
    pub(super) registers: Registers<Offset>,
}

impl Line {
    pub(super) const fn new(registers: Registers<Offset>) -> Self {
        Self { registers }
    }

    pub(super) fn configure(self, config: &Config) {
        let divisor = config.divisor_64ths();
        self.registers.write(Offset::Control, 0);
        self.registers.write(Offset::InterruptMask, 0);
        self.registers.write(Offset::IntegerBaudRate, divisor >> 6);
        self.registers.write(Offset::FractionalBaudRate, divisor & 0x3F);
        // Takes the baud rate over, too.
        self.registers.write(Offset::LineControl, LINE_CONTROL_8_BITS_FIFO);
        self.registers.write(Offset::Control, CONTROL_ENABLE_BOTH);
    }

    /// Sends as much as there is room for, at least one byte unless there is none to send.
    pub(super) fn write(self, bytes: &[u8]) -> Result<usize, SerialError> {
        let Some((first, rest)) = bytes.split_first() else { return Ok(0) };
        self.send(*first)?;
        let mut sent = 1;
        for byte in rest {
            if self.is_full() {
                break;
            }
            self.registers.write(Offset::Data, u32::from(*byte));
            sent += 1;
        }
        Ok(sent)
    }

    pub(super) fn send_text(self, byte: u8) -> Result<(), SerialError> {
        if byte == b'\n' {
            self.send(b'\r')?;
        }
        self.send(byte)
    }

    pub(super) fn flush(self) -> Result<(), SerialError> {
        self.wait(|| self.registers.read(Offset::Flags) & FLAG_BUSY == 0)
    }

    pub(super) fn receive(self) -> Option<ReceivedWord> {
        if self.registers.read(Offset::Flags) & FLAG_RECEIVE_EMPTY != 0 {
            return None;
        }
        let word = self.registers.read(Offset::Data);
        Some(if word & DATA_ERRORS == 0 { ReceivedWord::Byte((word & 0xFF) as u8) } else { ReceivedWord::Damaged })
    }

    fn send(self, byte: u8) -> Result<(), SerialError> {
        self.wait(|| !self.is_full())?;
        self.registers.write(Offset::Data, u32::from(byte));
        Ok(())
    }

    fn is_full(self) -> bool {
        self.registers.read(Offset::Flags) & FLAG_TRANSMIT_FULL != 0
    }

    fn wait(self, condition: impl FnMut() -> bool) -> Result<(), SerialError> {
        if poll(TRANSMIT_POLLS, condition) { Ok(()) } else { Err(SerialError::TransmitterStuck) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn divisors_are_rounded_to_the_nearest_64th() {
        // 24 MHz / (16 · 115,200) = 13.0208 = 13 + 1.33 / 64.
        assert_eq!(Config { clock_hertz: 24_000_000, baud: 115_200 }.divisor_64ths(), 13 << 6 | 1);
        // PL011 TRM's example: 4 MHz, 230,400 baud: 1.085 = 1 + 5.44 / 64.
        assert_eq!(Config { clock_hertz: 4_000_000, baud: 230_400 }.divisor_64ths(), 1 << 6 | 5);
    }

    #[test]
    fn a_stuck_transmitter_is_given_up() {
        let mut memory = [0u32; 16];
        memory[0x18 / 4] = FLAG_TRANSMIT_FULL | FLAG_BUSY;
        // SAFETY: plain memory stands in for the device and outlives the driver.
        let line = Line::new(unsafe { Registers::at((&raw mut memory).expose_provenance()) });
        assert_eq!(line.write(b"x"), Err(SerialError::TransmitterStuck));
        assert_eq!(line.flush(), Err(SerialError::TransmitterStuck));
        assert_eq!(line.write(b""), Ok(0));
    }
}
