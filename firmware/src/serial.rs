//! Serial lines, whatever UART drives them: text, bytes out, bytes both ways.

mod link;

pub use link::{Link, LinkInterrupt};

use crate::mmio::poll;
use core::fmt;
use embedded_io::{ErrorType, Write};

/// Looks at a UART before a full transmitter is given up. A byte takes 87 µs at 115,200 baud, and a
/// read of a peripheral at least 50 ns.
const TRANSMIT_POLLS: u32 = 1_000_000;

/// What a UART does. Its driver sets it up; copies name the same UART, one for each direction.
pub trait Uart: Clone {
    /// Sends a byte if there is room, and returns whether there was.
    fn try_send(&self, byte: u8) -> bool;

    /// Returns whether the last byte has left.
    fn is_idle(&self) -> bool;

    /// Takes what came in; `None` when nothing did.
    fn receive(&self) -> Option<ReceivedWord>;

    /// Turns the receive interrupt on or off. It stands for as long as there is something to take.
    fn listen(&self, on: bool);
}

/// What a receiver gave.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReceivedWord {
    /// A byte.
    Byte(u8),
    /// A broken byte, or a good one after others were lost; it is dropped, so that a reader's
    /// check of a whole message fails rather than takes it for something else.
    Damaged,
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
    /// Returns clock / (16 · baud), rounded to the nearest, in `parts` of one (a power of two, at most 64).
    #[must_use]
    pub const fn divisor(self, parts: u32) -> u32 {
        let baud = self.baud as u64;
        ((self.clock_hertz as u64 * parts as u64 / 8 + baud) / (2 * baud)) as u32
    }
}

/// Why bytes could not be sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum SerialError {
    /// The transmitter stayed full: its clock is off, or flow control holds it.
    TransmitterStuck,
}

impl fmt::Display for SerialError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
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

/// A line that only sends bytes, and waits for room itself. Fails when none comes.
pub struct Transmitter<U> {
    uart: U,
}

impl<U: Uart> Transmitter<U> {
    /// Returns the line of a UART that is set up.
    #[must_use]
    pub const fn new(uart: U) -> Self {
        Self { uart }
    }

    fn send(&self, byte: u8) -> Result<(), SerialError> {
        if poll(TRANSMIT_POLLS, || self.uart.try_send(byte)) { Ok(()) } else { Err(SerialError::TransmitterStuck) }
    }
}

impl<U> ErrorType for Transmitter<U> {
    type Error = SerialError;
}

impl<U: Uart> Write for Transmitter<U> {
    /// Sends as much as there is room for, at least one byte unless there is none to send.
    fn write(&mut self, bytes: &[u8]) -> Result<usize, SerialError> {
        let Some((first, rest)) = bytes.split_first() else { return Ok(0) };
        self.send(*first)?;
        Ok(1 + rest.iter().take_while(|byte| self.uart.try_send(**byte)).count())
    }

    fn flush(&mut self) -> Result<(), SerialError> {
        if poll(TRANSMIT_POLLS, || self.uart.is_idle()) { Ok(()) } else { Err(SerialError::TransmitterStuck) }
    }
}

/// A line that only sends text: a carriage return before every line feed.
pub struct Console<U> {
    out: Transmitter<U>,
}

impl<U: Uart> Console<U> {
    /// Returns the line of a UART that is set up.
    #[must_use]
    pub const fn new(uart: U) -> Self {
        Self { out: Transmitter::new(uart) }
    }

    /// Waits until the last byte has left.
    ///
    /// # Errors
    /// [`SerialError::TransmitterStuck`].
    pub fn flush(&mut self) -> Result<(), SerialError> {
        self.out.flush()
    }
}

impl<U: Uart> fmt::Write for Console<U> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for byte in text.bytes() {
            if byte == b'\n' {
                self.out.send(b'\r').map_err(|_| fmt::Error)?;
            }
            self.out.send(byte).map_err(|_| fmt::Error)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A UART that takes nothing.
    #[derive(Clone)]
    struct Stuck;

    impl Uart for Stuck {
        fn try_send(&self, _: u8) -> bool {
            false
        }
        fn is_idle(&self) -> bool {
            false
        }
        fn receive(&self) -> Option<ReceivedWord> {
            None
        }
        fn listen(&self, _: bool) {}
    }

    #[test]
    fn a_stuck_transmitter_is_given_up() {
        let mut line = Transmitter::new(Stuck);
        assert_eq!(line.write(b"x"), Err(SerialError::TransmitterStuck));
        assert_eq!(line.flush(), Err(SerialError::TransmitterStuck));
        assert_eq!(fmt::Write::write_str(&mut Console::new(Stuck), "x"), Err(fmt::Error));
        assert_eq!(line.write(b""), Ok(0));
    }

    #[test]
    fn divisors_are_rounded_to_the_nearest() {
        // 24 MHz / (16 · 115,200) = 13.0208 = 13 + 1.33 / 64.
        assert_eq!(Config { clock_hertz: 24_000_000, baud: 115_200 }.divisor(64), 13 << 6 | 1);
        // PL011 TRM's example: 4 MHz, 230,400 baud: 1.085 = 1 + 5.44 / 64.
        assert_eq!(Config { clock_hertz: 4_000_000, baud: 230_400 }.divisor(64), 1 << 6 | 5);
        // The DE1-SoC: 100 MHz / (16 · 115,200) = 54.25.
        assert_eq!(Config { clock_hertz: 100_000_000, baud: 115_200 }.divisor(1), 54);
        assert_eq!(Config { clock_hertz: 100_000_000, baud: 38_400 }.divisor(1), 163);
    }
}
