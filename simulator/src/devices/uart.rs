//! UART0: a DesignWare 16550 with FIFOs of 128 bytes, on l4_sp (100 MHz).
//!
//! Bytes take their time on the line, in both directions, so a receiver that is not emptied in
//! time loses some. Modelled is what U-Boot and a bare-metal driver use; parity, breaks, modem lines
//! and loopback are not.

use std::collections::VecDeque;

use super::{Answer, no_register, read_only};
use crate::time::{Clocks, L4_SP_CLOCK};

const FIFO_DEPTH: usize = 128;
/// Bits of a byte on the line: start, eight, stop.
const BITS: u64 = 10;
/// U-Boot's divisor for 115,200 baud.
const UBOOT_DIVISOR: u32 = 54;

const LCR_DLAB: u32 = 1 << 7;
const LCR_8_BITS: u32 = 0b11;
const LSR_DATA_READY: u32 = 1 << 0;
const LSR_OVERRUN: u32 = 1 << 1;
const LSR_TRANSMIT_EMPTY: u32 = 1 << 5;
const LSR_IDLE: u32 = 1 << 6;
const IER_RECEIVE: u32 = 1 << 0;
const IER_TRANSMIT: u32 = 1 << 1;
const IER_LINE: u32 = 1 << 2;

/// The UART and both directions of its line.
pub struct Uart {
    transmit: VecDeque<u8>,
    /// When the byte that is being shifted out is done.
    shifted_out: Option<Clocks>,
    sent: Vec<u8>,
    receive: VecDeque<u8>,
    /// Bytes that the other end sends, and when the next one is in.
    line: VecDeque<u8>,
    shifted_in: Option<Clocks>,
    /// When a byte came in or was taken last, for the time-out interrupt.
    receive_touched: Clocks,
    divisor: u32,
    interrupt_enable: u32,
    fifo_control: u32,
    line_control: u32,
    modem_control: u32,
    scratch: u32,
    overrun: bool,
    /// THRE interrupt: raised when the transmitter runs empty, dropped by reading IIR.
    transmit_empty_pending: bool,
    lost: u64,
}

impl Uart {
    /// Returns the UART as U-Boot sets it up: 115,200 baud, 8 data bits, FIFOs on, no interrupts.
    pub fn as_uboot_leaves_it() -> Self {
        Self { divisor: UBOOT_DIVISOR, fifo_control: 1, line_control: LCR_8_BITS, ..Self::after_reset() }
    }

    /// Returns the UART as its module reset leaves it.
    pub fn after_reset() -> Self {
        Self {
            transmit: VecDeque::new(),
            shifted_out: None,
            sent: Vec::new(),
            receive: VecDeque::new(),
            line: VecDeque::new(),
            shifted_in: None,
            receive_touched: 0,
            divisor: 0,
            interrupt_enable: 0,
            fifo_control: 0,
            line_control: 0,
            modem_control: 0,
            scratch: 0,
            overrun: false,
            transmit_empty_pending: false,
            lost: 0,
        }
    }

    /// Resets the module; the line's other end does not notice.
    pub fn reset(&mut self) {
        let (sent, line, lost) = (std::mem::take(&mut self.sent), std::mem::take(&mut self.line), self.lost);
        *self = Self { sent, line, lost, ..Self::after_reset() };
    }

    /// Starts over as U-Boot sets it up; the line's other end does not notice.
    pub fn restart(&mut self) {
        self.reset();
        let Self { divisor, fifo_control, line_control, .. } = Self::as_uboot_leaves_it();
        (self.divisor, self.fifo_control, self.line_control) = (divisor, fifo_control, line_control);
    }

    /// Sends bytes from the line's other end, one after the other.
    pub fn feed(&mut self, bytes: &[u8], now: Clocks) {
        self.line.extend(bytes);
        if self.shifted_in.is_none() && !self.line.is_empty() {
            self.shifted_in = Some(now + self.byte_time());
        }
    }

    /// Takes what came out so far.
    pub fn take_sent(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.sent)
    }

    /// Returns whether something came out that nobody took.
    pub fn has_sent(&self) -> bool {
        !self.sent.is_empty()
    }

    /// Returns how many bytes found the receiver full and were lost.
    pub fn lost(&self) -> u64 {
        self.lost
    }

    fn byte_time(&self) -> Clocks {
        BITS * 16 * u64::from(self.divisor.max(1)) * L4_SP_CLOCK
    }

    fn depth(&self) -> usize {
        if self.fifo_control & 1 != 0 { FIFO_DEPTH } else { 1 }
    }

    /// Bytes at which the receiver interrupts.
    fn trigger(&self) -> usize {
        match (self.fifo_control & 1, self.fifo_control >> 6 & 3) {
            (0, _) | (_, 0) => 1,
            (_, 1) => FIFO_DEPTH / 4,
            (_, 2) => FIFO_DEPTH / 2,
            _ => FIFO_DEPTH - 2,
        }
    }

    /// When waiting bytes below the trigger interrupt: four bytes' time after the last was touched.
    fn time_out(&self) -> Option<Clocks> {
        (!self.receive.is_empty() && self.fifo_control & 1 != 0).then(|| self.receive_touched + 4 * self.byte_time())
    }

    /// Moves bytes on the line up to now.
    pub fn advance(&mut self, now: Clocks) {
        while let Some(done) = self.shifted_out.filter(|done| *done <= now) {
            if let Some(byte) = self.transmit.pop_front() {
                self.sent.push(byte);
            }
            self.shifted_out = (!self.transmit.is_empty()).then(|| done + self.byte_time());
            // The last byte has moved to the shift register.
            if self.transmit.len() == 1 {
                self.transmit_empty_pending = true;
            }
        }
        while let Some(done) = self.shifted_in.filter(|done| *done <= now) {
            if let Some(byte) = self.line.pop_front() {
                if self.receive.len() < self.depth() {
                    self.receive.push_back(byte);
                } else {
                    self.overrun = true;
                    self.lost += 1;
                }
                self.receive_touched = done;
            }
            self.shifted_in = (!self.line.is_empty()).then(|| done + self.byte_time());
        }
    }

    /// Returns when something happens by itself.
    pub fn next_event(&self, now: Clocks) -> Clocks {
        let times = [self.shifted_out, self.shifted_in, self.time_out().filter(|at| *at > now)];
        times.into_iter().flatten().min().unwrap_or(Clocks::MAX)
    }

    /// Returns the highest pending interrupt's number in IIR; 1 is none.
    fn interrupt_number(&self, now: Clocks) -> u32 {
        let enabled = |bit| self.interrupt_enable & bit != 0;
        if enabled(IER_LINE) && self.overrun {
            0b0110
        } else if enabled(IER_RECEIVE) && self.receive.len() >= self.trigger() {
            0b0100
        } else if enabled(IER_RECEIVE) && self.time_out().is_some_and(|at| at <= now) {
            0b1100
        } else if enabled(IER_TRANSMIT) && self.transmit_empty_pending {
            0b0010
        } else {
            0b0001
        }
    }

    /// Returns the interrupt line.
    pub fn interrupt(&self, now: Clocks) -> bool {
        self.interrupt_number(now) != 1
    }

    /// Bytes that wait behind the one in the shift register.
    fn waiting(&self) -> usize {
        self.transmit.len().saturating_sub(1)
    }

    fn line_status(&mut self) -> u32 {
        let mut status = 0;
        if !self.receive.is_empty() {
            status |= LSR_DATA_READY;
        }
        if std::mem::take(&mut self.overrun) {
            status |= LSR_OVERRUN;
        }
        if self.waiting() == 0 {
            status |= LSR_TRANSMIT_EMPTY;
        }
        if self.transmit.is_empty() {
            status |= LSR_IDLE;
        }
        status
    }

    /// Reads a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn read(&mut self, offset: u32, now: Clocks) -> Answer<u32> {
        let divisor_access = self.line_control & LCR_DLAB != 0;
        Ok(match offset {
            0x00 if divisor_access => self.divisor & 0xFF,
            0x00 => {
                self.receive_touched = now;
                self.receive.pop_front().map_or(0, u32::from)
            }
            0x04 if divisor_access => self.divisor >> 8,
            0x04 => self.interrupt_enable,
            0x08 => {
                let number = self.interrupt_number(now);
                if number == 0b0010 {
                    self.transmit_empty_pending = false;
                }
                number | if self.fifo_control & 1 != 0 { 0xC0 } else { 0 }
            }
            0x0C => self.line_control,
            0x10 => self.modem_control,
            0x14 => self.line_status(),
            0x18 => 0,
            0x1C => self.scratch,
            0x7C => {
                let flag = |bit: u32, set: bool| u32::from(set) << bit;
                flag(1, self.waiting() < self.depth())
                    | flag(2, self.waiting() == 0)
                    | flag(3, !self.receive.is_empty())
                    | flag(4, self.receive.len() == self.depth())
            }
            0x80 => self.waiting() as u32,
            0x84 => self.receive.len() as u32,
            0xF8 => 0x3331_312A,
            0xFC => 0x4457_0110,
            _ => return no_register(offset),
        })
    }

    /// Writes a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn write(&mut self, offset: u32, value: u32, now: Clocks) -> Answer<()> {
        let divisor_access = self.line_control & LCR_DLAB != 0;
        match offset {
            0x00 if divisor_access => self.divisor = self.divisor & !0xFF | value & 0xFF,
            0x00 => self.send(value as u8, now)?,
            0x04 if divisor_access => self.divisor = self.divisor & 0xFF | (value & 0xFF) << 8,
            0x04 => {
                // Enabling it with an idle transmitter raises it.
                let newly = value & !self.interrupt_enable & IER_TRANSMIT != 0;
                self.transmit_empty_pending |= newly && self.waiting() == 0;
                self.interrupt_enable = value & 0x8F;
            }
            0x08 => {
                if value & 0b10 != 0 {
                    self.receive.clear();
                }
                if value & 0b100 != 0 {
                    self.transmit.truncate(1);
                }
                self.fifo_control = value & 0b1100_0001;
            }
            0x0C => {
                if value & 0b0011_1111 & !0b100 != LCR_8_BITS {
                    return Err(format!("LCR {value:#x}: only 8 data bits without parity are modelled"));
                }
                self.line_control = value;
            }
            0x10 if value & 0x10 == 0 => self.modem_control = value,
            0x10 => return Err("loopback is not modelled".into()),
            0x14 | 0x18 | 0x7C..=0x84 | 0xF4..=0xFC => return read_only("the register"),
            0x1C => self.scratch = value & 0xFF,
            0x88 => {
                if value & 1 != 0 {
                    self.reset();
                }
            }
            _ => return no_register(offset),
        }
        Ok(())
    }

    fn send(&mut self, byte: u8, now: Clocks) -> Answer<()> {
        if self.divisor == 0 {
            return Err("a divisor: the UART has no baud rate".into());
        }
        if self.transmit.len() > self.depth() {
            return Err("room in the transmit FIFO: the byte would be lost; wait for LSR.THRE or USR.TFNF".into());
        }
        self.transmit.push_back(byte);
        self.transmit_empty_pending = false;
        if self.shifted_out.is_none() {
            self.shifted_out = Some(now + self.byte_time());
            self.transmit_empty_pending = true;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BYTE: Clocks = 10 * 16 * 54 * 8;

    #[test]
    fn bytes_take_their_time_and_are_not_lost_silently() {
        let mut uart = Uart::as_uboot_leaves_it();
        assert_eq!(uart.read(0x14, 0), Ok(0x60));
        uart.write(0x00, 0x41, 0).unwrap();
        assert_eq!(uart.read(0x14, 0), Ok(0x20), "the byte is in the shift register");
        for _ in 0..FIFO_DEPTH {
            uart.write(0x00, 0x42, 0).unwrap();
        }
        assert!(uart.write(0x00, 0x43, 0).unwrap_err().contains("room"));
        uart.advance(BYTE - 1);
        assert!(!uart.has_sent());
        uart.advance(BYTE);
        assert_eq!(uart.take_sent(), b"A");
        uart.advance(200 * BYTE);
        assert_eq!(uart.take_sent().len(), FIFO_DEPTH);
        assert_eq!(uart.next_event(200 * BYTE), Clocks::MAX);
    }

    #[test]
    fn a_receiver_that_nobody_empties_overruns() {
        let mut uart = Uart::as_uboot_leaves_it();
        uart.feed(&[7; FIFO_DEPTH + 2], 0);
        uart.advance(1000 * BYTE);
        assert_eq!((uart.lost(), uart.read(0x84, 0)), (2, Ok(FIFO_DEPTH as u32)));
        assert_eq!(uart.read(0x14, 0), Ok(0x63));
        assert_eq!(uart.read(0x14, 0), Ok(0x61), "the read took the overrun flag");
    }

    #[test]
    fn few_bytes_interrupt_after_a_time_out() {
        let mut uart = Uart::as_uboot_leaves_it();
        uart.write(0x08, 0b1000_0001, 0).unwrap();
        uart.write(0x04, IER_RECEIVE, 0).unwrap();
        uart.feed(b"x", 0);
        uart.advance(BYTE);
        assert!(!uart.interrupt(BYTE));
        assert_eq!(uart.next_event(BYTE), 5 * BYTE);
        assert!(uart.interrupt(5 * BYTE));
        assert_eq!(uart.read(0x08, 5 * BYTE), Ok(0xCC));
        assert_eq!(uart.read(0x00, 5 * BYTE), Ok(u32::from(b'x')));
        assert!(!uart.interrupt(5 * BYTE));
    }
}
