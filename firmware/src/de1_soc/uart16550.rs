//! UART0: a DesignWare 16550 with 32-bit registers (Intel's HPS manual 683126, chapter 22;
//! registers of `alt_uart.h`).

use crate::mmio::{Bus, Mmio, Register, Registers, poll};
use crate::serial::{Config, ReceivedWord, Uart};

/// Registers of the UART. The divisor lies behind the first two while LCR says so.
#[derive(Debug, Clone, Copy)]
pub enum Offset {
    /// RBR and THR; DLL.
    Data = 0x00,
    /// IER; DLH.
    InterruptEnable = 0x04,
    /// IIR when read, FCR when written.
    Fifo = 0x08,
    /// LCR.
    LineControl = 0x0C,
    /// MCR.
    ModemControl = 0x10,
    /// LSR.
    LineStatus = 0x14,
    /// USR.
    Status = 0x7C,
}

impl Register for Offset {
    fn offset(self) -> usize {
        self as usize
    }
}

/// LCR: 8 bits, no parity, one stop bit.
const EIGHT_BITS: u32 = 0b11;
/// LCR: the divisor shows.
const DIVISOR_ACCESS: u32 = 1 << 7;
/// FCR: FIFOs on and emptied; a receive interrupt when a quarter is full, or after four bytes' silence.
const FIFOS: u32 = 0b01 << 6 | 0b111;
/// IER: data came.
const RECEIVE_INTERRUPT: u32 = 1 << 0;
/// IIR: the id field, and that of a silence after data.
const INTERRUPT_ID: u32 = 0xF;
const SILENCE: u32 = 0xC;
/// LSR: data came.
const DATA_READY: u32 = 1 << 0;
/// LSR: overrun, parity, framing error or break.
const DATA_ERRORS: u32 = 0b1111 << 1;
/// LSR: the transmit FIFO is empty.
const TRANSMIT_EMPTY: u32 = 1 << 5;
/// USR: the transmit FIFO, of 128 bytes, is not full.
const TRANSMIT_ROOM: u32 = 1 << 1;
/// LSR: the last byte has left.
const TRANSMIT_IDLE: u32 = 1 << 6;

/// Looks at a transmitter before it is set up although it sends: U-Boot's last 128 bytes take 11 ms,
/// and a look at least 50 ns.
const DRAIN_POLLS: u32 = 400_000;

/// One UART.
#[derive(Clone, Copy)]
pub struct Uart16550<B = Mmio> {
    registers: Registers<Offset, B>,
}

impl<B: Bus> Uart16550<B> {
    /// Returns a UART as it is.
    #[must_use]
    pub const fn new(registers: Registers<Offset, B>) -> Self {
        Self { registers }
    }

    /// Sets the UART up for sending and receiving, without interrupts, once what it sends has left.
    pub fn configure(&self, config: &Config) {
        // Whether it drained or not: set-up is what helps one that is stuck.
        let _ = poll(DRAIN_POLLS, || self.is_idle());
        let divisor = config.divisor(1);
        self.registers.write(Offset::InterruptEnable, 0);
        self.registers.write(Offset::LineControl, DIVISOR_ACCESS | EIGHT_BITS);
        self.registers.write(Offset::Data, divisor & 0xFF);
        self.registers.write(Offset::InterruptEnable, divisor >> 8);
        self.registers.write(Offset::LineControl, EIGHT_BITS);
        self.registers.write(Offset::Fifo, FIFOS);
        self.registers.write(Offset::ModemControl, 0);
    }

    fn status(&self) -> u32 {
        self.registers.read(Offset::LineStatus)
    }
}

impl<B: Bus> Uart for Uart16550<B> {
    fn try_send(&self, byte: u8) -> bool {
        // The second is the first's sign for those whose USR is left out and reads 0.
        let room = self.registers.read(Offset::Status) & TRANSMIT_ROOM != 0 || self.status() & TRANSMIT_EMPTY != 0;
        if room {
            self.registers.write(Offset::Data, u32::from(byte));
        }
        room
    }

    fn is_idle(&self) -> bool {
        self.status() & TRANSMIT_IDLE != 0
    }

    fn receive(&self) -> Option<ReceivedWord> {
        let status = self.status();
        if status & DATA_READY == 0 {
            // DesignWare's UART can say "silence" with nothing to read, for ever; a read ends it.
            if self.registers.read(Offset::Fifo) & INTERRUPT_ID == SILENCE {
                let _ = self.registers.read(Offset::Data);
            }
            return None;
        }
        let byte = (self.registers.read(Offset::Data) & 0xFF) as u8;
        Some(if status & DATA_ERRORS == 0 { ReceivedWord::Byte(byte) } else { ReceivedWord::Damaged })
    }

    fn listen(&self, on: bool) {
        self.registers.write(Offset::InterruptEnable, if on { RECEIVE_INTERRUPT } else { 0 });
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::mmio::mock::{Access, MockBus};
    use std::collections::BTreeMap;

    type TestBus = MockBus<BTreeMap<usize, u32>>;

    const BASE: usize = 0xFFC0_2000;
    const SERIAL: Config = Config { clock_hertz: 100_000_000, baud: 115_200 };

    fn uart(status: u32) -> (Uart16550<TestBus>, TestBus) {
        let bus = MockBus::new(BTreeMap::from([(BASE + 0x14, status)]));
        (Uart16550::new(Registers::on(bus.clone(), BASE)), bus)
    }

    #[test]
    fn it_is_set_up_for_115_200_baud_8n1() {
        let (uart, bus) = uart(0x60);
        uart.configure(&SERIAL);
        let expected = [(4, 0), (0xC, 0x83), (0, 54), (4, 0), (0xC, 0x03), (8, 0x47), (0x10, 0)];
        assert_eq!(bus.take_writes(), expected.map(|(offset, value)| (BASE + offset, value)));
    }

    #[test]
    fn one_that_never_drains_is_set_up_all_the_same() {
        let (uart, bus) = uart(0);
        uart.configure(&SERIAL);
        assert_eq!(bus.take_writes().len(), 7);
    }

    #[test]
    fn a_byte_goes_only_where_there_is_room() {
        let (full, bus) = uart(0x01);
        assert!(!full.try_send(b'x'));
        assert_eq!(bus.take_writes(), []);
        let (empty, bus) = uart(0x60);
        assert!(empty.try_send(b'x'));
        assert_eq!(bus.take_writes(), [(BASE, u32::from(b'x'))]);
        let (filling, bus) = uart(0x00);
        bus.devices(|memory| memory.insert(BASE + 0x7C, 0b010));
        assert!(filling.try_send(b'y'));
        assert_eq!(bus.take_writes(), [(BASE, u32::from(b'y'))]);
    }

    #[test]
    fn broken_bytes_are_taken_and_told() {
        let (good, bus) = uart(0x61);
        bus.devices(|memory| memory.insert(BASE, 0x41));
        assert_eq!(good.receive(), Some(ReceivedWord::Byte(0x41)));
        for error in 1..=4 {
            let (broken, bus) = uart(0x61 | 1 << error);
            assert_eq!(broken.receive(), Some(ReceivedWord::Damaged));
            assert!(bus.take_journal().contains(&Access::Read(BASE, 0)), "the byte is taken out");
        }
    }

    #[test]
    fn a_silence_without_data_is_ended_by_a_read() {
        let (uart, bus) = uart(0x60);
        assert_eq!(uart.receive(), None);
        assert!(!bus.take_journal().contains(&Access::Read(BASE, 0)));
        bus.devices(|memory| memory.insert(BASE + 8, 0xCC));
        assert_eq!(uart.receive(), None);
        assert!(bus.take_journal().contains(&Access::Read(BASE, 0)));
    }
}
