//! The seam between the driver and the bridge.

use crate::error::NotConfigured;
use crate::registers::Register;

/// The FPGA as the driver sees it: registers and a FIFO aperture.
///
/// Implemented by [`MmioPort`](crate::MmioPort) on the board, by the software model where there
/// is no FPGA, and by the mock in tests. Nothing above this trait knows which.
///
/// Registers and FIFO may sit on two bridges: no order holds between [`push`](Port::push) and
/// the register accesses. What must be in order travels in the stream.
pub trait Port {
    /// Returns whether the registers may be touched at all.
    ///
    /// On the DE1-SoC an access to the bridge of an FPGA that is not configured stops the
    /// processor for good, so the driver asks before its first access.
    ///
    /// # Errors
    /// [`NotConfigured`] when the FPGA is not in user mode.
    fn configured(&mut self) -> Result<(), NotConfigured> {
        Ok(())
    }

    /// Reads a register. It takes as long as about twenty posted writes.
    fn read(&mut self, register: Register) -> u32;

    /// Writes a register.
    fn write(&mut self, register: Register, value: u32);

    /// Pushes words into the FIFO, in order.
    ///
    /// The caller has made sure that they fit; a word too many is dropped by the device, which
    /// then sets `ERRORS.fifo_overflow`.
    fn push(&mut self, words: &[u32]);
}

impl<P: Port + ?Sized> Port for &mut P {
    fn configured(&mut self) -> Result<(), NotConfigured> {
        (**self).configured()
    }
    fn read(&mut self, register: Register) -> u32 {
        (**self).read(register)
    }
    fn write(&mut self, register: Register, value: u32) {
        (**self).write(register, value);
    }
    fn push(&mut self, words: &[u32]) {
        (**self).push(words);
    }
}

/// How the driver waits for the device.
pub trait Wait {
    /// Whether the device's interrupt reaches the processor. If so the driver enables all four causes
    /// (low water, swap, fence, error), and a wait may end early.
    const INTERRUPT: bool;

    /// Waits until the device raises its interrupt, or `micros` microseconds have passed, and
    /// returns how many have, rounded up: at least 1, so that a driver's time-out always ends.
    ///
    /// Without an interrupt it waits the whole time. The driver checks the device's registers
    /// afterwards either way, so a wait that ends too early costs a read and nothing else.
    fn wait(&mut self, micros: u32) -> u32;
}

impl<W: Wait + ?Sized> Wait for &mut W {
    const INTERRUPT: bool = W::INTERRUPT;
    fn wait(&mut self, micros: u32) -> u32 {
        (**self).wait(micros)
    }
}
