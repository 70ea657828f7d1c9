//! The PS/2 keyboard behind a PL050 (ARM DDI 0143).

use crate::mmio::{Register, Registers, poll};
use crate::ps2::{Decoder, KeyboardReport};
use heapless::spsc::{Consumer, Producer};

/// Reads of the status before a byte to the keyboard is given up.
const TRANSMIT_POLLS: u32 = 1_000_000;
/// Bytes taken at one interrupt at most: a keyboard buffers 16.
const BYTES_PER_INTERRUPT: u32 = 32;
/// What the interface's own clock must be, in hertz.
const INTERNAL_HERTZ: u32 = 8_000_000;

const CONTROL_ENABLE: u32 = 1 << 2;
const CONTROL_RECEIVE_INTERRUPT: u32 = 1 << 4;
const STATUS_RECEIVED: u32 = 1 << 4;
const STATUS_TRANSMIT_EMPTY: u32 = 1 << 6;
/// The command to a keyboard to send scan codes.
const ENABLE_SCANNING: u32 = 0xF4;
/// What a keyboard says when its own buffer overran.
const OVERRUN: u8 = 0x00;

#[derive(Clone, Copy)]
enum Offset {
    Control = 0x00,
    Status = 0x04,
    Data = 0x08,
    ClockDivisor = 0x0C,
}

impl Register for Offset {
    fn offset(self) -> usize {
        self as usize
    }
}

/// The keyboard, as a source of USB boot keyboard reports.
pub struct Keyboard {
    received: Consumer<'static, u8>,
    decoder: Decoder,
}

/// The keyboard's side in the interrupt handler.
pub struct KeyboardInterrupt {
    registers: Registers<Offset>,
    queue: Producer<'static, u8>,
    lost: bool,
}

impl Keyboard {
    /// Sets a PL050 up and tells the keyboard to send.
    ///
    /// Bytes come through the queue whose two ends are given. A keyboard that takes no command
    /// stays silent; that is no error, for there may be none.
    ///
    /// # Safety
    /// A PL050 answers at `address`, and no other driver writes to it.
    #[must_use]
    pub unsafe fn new(
        address: usize,
        clock_hertz: u32,
        (queue, received): (Producer<'static, u8>, Consumer<'static, u8>),
    ) -> (Self, KeyboardInterrupt) {
        // SAFETY: the caller's promise is the same.
        let registers = unsafe { Registers::at(address) };
        registers.write(Offset::ClockDivisor, (clock_hertz / INTERNAL_HERTZ).saturating_sub(1));
        registers.write(Offset::Control, CONTROL_ENABLE | CONTROL_RECEIVE_INTERRUPT);
        if poll(TRANSMIT_POLLS, || registers.read(Offset::Status) & STATUS_TRANSMIT_EMPTY != 0) {
            registers.write(Offset::Data, ENABLE_SCANNING);
        }
        let keyboard = Self { received, decoder: Decoder::new() };
        (keyboard, KeyboardInterrupt { registers, queue, lost: false })
    }

    /// Returns the next report that differs from the one before, `None` when no key changed
    /// since. Call it until it returns `None`: a short press is two reports.
    pub fn poll(&mut self) -> Option<KeyboardReport> {
        while let Some(byte) = self.received.dequeue() {
            if let Some(report) = self.decoder.push(byte) {
                return Some(report);
            }
        }
        None
    }
}

impl KeyboardInterrupt {
    /// Takes what the keyboard sent. When the queue overflows, all keys are released, as after a
    /// keyboard's own overrun: a release may be among what was lost.
    pub fn serve(&mut self) {
        for _ in 0..BYTES_PER_INTERRUPT {
            if self.registers.read(Offset::Status) & STATUS_RECEIVED == 0 {
                return;
            }
            let byte = (self.registers.read(Offset::Data) & 0xFF) as u8;
            if self.lost && self.queue.enqueue(OVERRUN).is_ok() {
                self.lost = false;
            }
            self.lost |= self.lost || self.queue.enqueue(byte).is_err();
        }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use heapless::spsc::Queue;
    use std::boxed::Box;

    #[test]
    fn an_overflow_releases_every_key() {
        let registers: &'static mut [u32; 4] = Box::leak(Box::new([0, STATUS_TRANSMIT_EMPTY, 0, 0]));
        let ends = Box::leak(Box::new(Queue::<u8, 4>::new())).split();
        let memory = &raw mut *registers;
        // SAFETY: plain memory stands in for the device and lives for ever.
        let (mut keyboard, mut interrupt) = unsafe { Keyboard::new(memory.expose_provenance(), 24_000_000, ends) };
        // SAFETY: the memory is alive; the driver accesses it by raw pointers alone.
        assert_eq!(unsafe { memory.read_volatile() }, [0x14, STATUS_TRANSMIT_EMPTY, 0xF4, 2]);
        // Stays received, so that one interrupt reads 32 times 'a'.
        // SAFETY: as above.
        unsafe { memory.write_volatile([0, STATUS_RECEIVED, 0x1C, 0]) };
        interrupt.serve();
        assert_eq!(keyboard.poll(), Some([0, 0, 4, 0, 0, 0, 0, 0]));
        assert_eq!(keyboard.poll(), None);
        interrupt.serve();
        assert_eq!(keyboard.poll(), Some([0; 8]));
        assert_eq!(keyboard.poll(), Some([0, 0, 4, 0, 0, 0, 0, 0]));
    }
}
