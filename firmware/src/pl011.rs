//! Serial lines: the PL011 UART (ARM DDI 0183).

mod line;
mod link;

pub use line::{Config, SerialError};
pub use link::{Link, LinkInterrupt};

use crate::mmio::Registers;
use core::fmt;
use embedded_io::{ErrorType, Write};
use line::Line;

/// A line that only sends text. Every line feed is sent with a carriage return before it.
///
/// It waits for room itself, and fails when none comes.
pub struct Console {
    line: Line,
}

impl Console {
    /// Sets a PL011 up for sending.
    ///
    /// # Safety
    /// A PL011 answers at `address`, and no other driver writes to it.
    #[must_use]
    pub unsafe fn new(address: usize, config: &Config) -> Self {
        // SAFETY: the caller's promise is the same.
        let line = Line::new(unsafe { Registers::at(address) });
        line.configure(config);
        Self { line }
    }

    /// Returns a line that was set up already, for a last word.
    ///
    /// # Safety
    /// A PL011 answers at `address` and is set up; whoever had it is not in the middle of a write
    /// that matters.
    #[must_use]
    pub unsafe fn steal(address: usize) -> Self {
        // SAFETY: the caller's promise is the same.
        Self { line: Line::new(unsafe { Registers::at(address) }) }
    }
}

impl fmt::Write for Console {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        text.bytes().try_for_each(|byte| self.line.send_text(byte)).map_err(|_| fmt::Error)
    }
}

/// A line that only sends bytes, and waits for room itself.
pub struct Transmitter {
    line: Line,
}

impl Transmitter {
    /// Sets a PL011 up for sending.
    ///
    /// # Safety
    /// A PL011 answers at `address`, and no other driver writes to it.
    #[must_use]
    pub unsafe fn new(address: usize, config: &Config) -> Self {
        // SAFETY: the caller's promise is the same.
        let line = Line::new(unsafe { Registers::at(address) });
        line.configure(config);
        Self { line }
    }
}

impl ErrorType for Transmitter {
    type Error = SerialError;
}

impl Write for Transmitter {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, SerialError> {
        self.line.write(bytes)
    }

    fn flush(&mut self) -> Result<(), SerialError> {
        self.line.flush()
    }
}
