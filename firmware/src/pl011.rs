//! A UART of QEMU's boards: the PL011 (ARM DDI 0183).

use crate::mmio::{Register, Registers};
use crate::serial::{Config, ReceivedWord, Uart};

const FLAG_BUSY: u32 = 1 << 3;
const FLAG_RECEIVE_EMPTY: u32 = 1 << 4;
const FLAG_TRANSMIT_FULL: u32 = 1 << 5;
const LINE_CONTROL_8_BITS_FIFO: u32 = 0b11 << 5 | 1 << 4;
const CONTROL_ENABLE_BOTH: u32 = 1 << 9 | 1 << 8 | 1 << 0;
/// Receive and receive-timeout interrupts.
const RECEIVE_INTERRUPTS: u32 = 1 << 4 | 1 << 6;
/// Overrun, break, parity and framing error, beside the byte.
const DATA_ERRORS: u32 = 0xF << 8;

#[derive(Clone, Copy)]
enum Offset {
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

/// One PL011.
#[derive(Clone, Copy)]
pub struct Pl011 {
    registers: Registers<Offset>,
}

impl Pl011 {
    /// Sets a PL011 up for sending and receiving, without interrupts.
    ///
    /// # Safety
    /// A PL011 answers at `address`, and no other driver writes to it.
    #[must_use]
    pub unsafe fn new(address: usize, config: &Config) -> Self {
        // SAFETY: the caller's promise is the same.
        let uart = unsafe { Self::steal(address) };
        let divisor = config.divisor(64);
        uart.registers.write(Offset::Control, 0);
        uart.registers.write(Offset::InterruptMask, 0);
        uart.registers.write(Offset::IntegerBaudRate, divisor >> 6);
        uart.registers.write(Offset::FractionalBaudRate, divisor & 0x3F);
        // Takes the baud rate over, too.
        uart.registers.write(Offset::LineControl, LINE_CONTROL_8_BITS_FIFO);
        uart.registers.write(Offset::Control, CONTROL_ENABLE_BOTH);
        uart
    }

    /// Returns a UART that was set up already, for a last word.
    ///
    /// # Safety
    /// A PL011 answers at `address` and is set up; whoever had it is not in the middle of a write
    /// that matters.
    #[must_use]
    pub unsafe fn steal(address: usize) -> Self {
        // SAFETY: the caller's promise is the same.
        Self { registers: unsafe { Registers::at(address) } }
    }

    fn flags(&self) -> u32 {
        self.registers.read(Offset::Flags)
    }
}

impl Uart for Pl011 {
    fn try_send(&self, byte: u8) -> bool {
        let room = self.flags() & FLAG_TRANSMIT_FULL == 0;
        if room {
            self.registers.write(Offset::Data, u32::from(byte));
        }
        room
    }

    fn is_idle(&self) -> bool {
        self.flags() & FLAG_BUSY == 0
    }

    fn receive(&self) -> Option<ReceivedWord> {
        if self.flags() & FLAG_RECEIVE_EMPTY != 0 {
            return None;
        }
        let word = self.registers.read(Offset::Data);
        Some(if word & DATA_ERRORS == 0 { ReceivedWord::Byte((word & 0xFF) as u8) } else { ReceivedWord::Damaged })
    }

    fn listen(&self, on: bool) {
        self.registers.write(Offset::InterruptMask, if on { RECEIVE_INTERRUPTS } else { 0 });
    }
}
