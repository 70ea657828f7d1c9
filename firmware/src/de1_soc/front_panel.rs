//! The FPGA's keys, switches, LEDs and hex displays as pins.
//!
//! An access to a register of theirs goes over the bridge and takes as long as 400 instructions. So
//! the pins live on copies: [`sample`](FrontPanel::sample) reads all inputs at once,
//! [`show`](FrontPanel::show) writes the outputs that have changed.

use core::cell::Cell;
use core::convert::Infallible;

use embedded_hal::digital::{ErrorType, InputPin, OutputPin, StatefulOutputPin};
use fpga_regs::board_io::{BoardRegister, DIGITS, HexHigh, HexLow, Keys, Leds, Switches};

use crate::mmio::{Bus, Mmio, Register, Registers};

impl Register for BoardRegister {
    fn offset(self) -> usize {
        self as usize
    }
}

/// An output register: what pins want it to hold, and what it holds.
struct Output {
    register: BoardRegister,
    wanted: Cell<u32>,
    shown: Cell<Option<u32>>,
}

impl Output {
    const fn new(register: BoardRegister) -> Self {
        Self { register, wanted: Cell::new(0), shown: Cell::new(None) }
    }
}

/// The front panel.
pub struct FrontPanel<B = Mmio> {
    registers: Registers<BoardRegister, B>,
    keys: Cell<Keys>,
    switches: Cell<Switches>,
    leds: Output,
    hex_low: Output,
    hex_high: Output,
}

impl<B: Bus> FrontPanel<B> {
    /// Returns the panel with nothing pressed and nothing lit. Touches nothing: the bridge may be closed.
    #[must_use]
    pub fn new(registers: Registers<BoardRegister, B>) -> Self {
        Self {
            registers,
            keys: Cell::new(Keys::default()),
            switches: Cell::new(Switches::default()),
            leds: Output::new(BoardRegister::Leds),
            hex_low: Output::new(BoardRegister::HexLow),
            hex_high: Output::new(BoardRegister::HexHigh),
        }
    }

    /// Reads keys and switches. The bridge is open.
    pub fn sample(&self) {
        self.keys.set(Keys(self.registers.read(BoardRegister::Keys)));
        self.switches.set(Switches(self.registers.read(BoardRegister::Switches)));
    }

    /// Writes LEDs and displays that are to show something else. The bridge is open.
    pub fn show(&self) {
        for output in [&self.leds, &self.hex_low, &self.hex_high] {
            let wanted = output.wanted.get();
            if output.shown.replace(Some(wanted)) != Some(wanted) {
                self.registers.write(output.register, wanted);
            }
        }
    }

    /// Forgets what the registers hold: the FPGA was configured again.
    pub fn forget(&self) {
        for output in [&self.leds, &self.hex_low, &self.hex_high] {
            output.shown.set(None);
        }
    }

    /// Returns push button KEY0 to KEY3; high is pressed. One that the board has not is never pressed.
    #[must_use]
    pub fn key(&self, number: u32) -> Pin<'_, B> {
        Pin { panel: self, of: Of::Keys, number }
    }

    /// Returns slide switch SW0 to SW9; high is up. One that the board has not is never up.
    #[must_use]
    pub fn switch(&self, number: u32) -> Pin<'_, B> {
        Pin { panel: self, of: Of::Switches, number }
    }

    /// Returns LEDR0 to LEDR9; high is lit. One that the board has not takes what it is told.
    #[must_use]
    pub fn led(&self, number: u32) -> Led<'_, B> {
        Led { panel: self, number }
    }

    /// Shows digits (0 to 15) on HEX0, the rightmost, to HEX5; `None` leaves one dark.
    pub fn set_digits(&self, digits: [Option<u8>; 6]) {
        let [hex0, hex1, hex2, hex3, hex4, hex5] =
            digits.map(|digit| digit.map_or(0, |digit| DIGITS[usize::from(digit & 0xF)]));
        let low = HexLow::default().with_hex0(hex0).with_hex1(hex1).with_hex2(hex2).with_hex3(hex3);
        self.hex_low.wanted.set(low.0);
        self.hex_high.wanted.set(HexHigh::default().with_hex4(hex4).with_hex5(hex5).0);
    }
}

#[derive(Clone, Copy)]
enum Of {
    Keys,
    Switches,
}

/// A key or a switch, as it was at the last [`sample`](FrontPanel::sample).
pub struct Pin<'a, B> {
    panel: &'a FrontPanel<B>,
    of: Of,
    number: u32,
}

impl<B> ErrorType for Pin<'_, B> {
    type Error = Infallible;
}

impl<B: Bus> InputPin for Pin<'_, B> {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        let levels = match self.of {
            Of::Keys => self.panel.keys.get().pressed().into(),
            Of::Switches => self.panel.switches.get().up(),
        };
        Ok(u32::from(levels).checked_shr(self.number).is_some_and(|level| level & 1 == 1))
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        self.is_high().map(|high| !high)
    }
}

/// An LED; it changes at the next [`show`](FrontPanel::show).
pub struct Led<'a, B> {
    panel: &'a FrontPanel<B>,
    number: u32,
}

impl<B> Led<'_, B> {
    fn mask(&self) -> u32 {
        Leds::default().with_lit(1u16.checked_shl(self.number).unwrap_or(0) & 0x3FF).0
    }
}

impl<B> ErrorType for Led<'_, B> {
    type Error = Infallible;
}

impl<B: Bus> OutputPin for Led<'_, B> {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.panel.leds.wanted.update(|leds| leds & !self.mask());
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.panel.leds.wanted.update(|leds| leds | self.mask());
        Ok(())
    }
}

impl<B: Bus> StatefulOutputPin for Led<'_, B> {
    fn is_set_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.panel.leds.wanted.get() & self.mask() != 0)
    }

    fn is_set_low(&mut self) -> Result<bool, Infallible> {
        self.is_set_high().map(|high| !high)
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::mmio::mock::{Access, MockBus};
    use std::collections::BTreeMap;

    type TestBus = MockBus<BTreeMap<usize, u32>>;

    const BASE: usize = fpga_regs::de1_soc::BOARD_IO;

    fn panel(keys: u32, switches: u32) -> (FrontPanel<TestBus>, TestBus) {
        let bus = MockBus::new(BTreeMap::from([(BASE, keys), (BASE + 4, switches)]));
        (FrontPanel::new(Registers::on(bus.clone(), BASE)), bus)
    }

    #[test]
    fn pins_are_what_the_last_sample_found_and_cost_no_access() {
        let (panel, bus) = panel(0b0101, 0x201);
        assert_eq!(panel.key(0).is_high(), Ok(false), "not sampled yet");
        panel.sample();
        assert_eq!(bus.take_journal(), [Access::Read(BASE, 0b0101), Access::Read(BASE + 4, 0x201)]);
        assert_eq!([0, 1, 2, 3].map(|number| panel.key(number).is_high().unwrap()), [true, false, true, false]);
        assert_eq!([0, 1, 8, 9].map(|number| panel.switch(number).is_low().unwrap()), [false, true, true, false]);
        assert_eq!((panel.key(4).is_high(), panel.switch(99).is_high()), (Ok(false), Ok(false)));
        assert_eq!(bus.take_journal(), []);
    }

    #[test]
    fn only_what_has_changed_is_written() {
        let (panel, bus) = panel(0, 0);
        panel.led(9).set_high().unwrap();
        panel.led(0).toggle().unwrap();
        panel.led(10).set_high().unwrap();
        panel.set_digits([Some(0), Some(6), None, None, Some(0xA), Some(8)]);
        panel.show();
        let hex = [(BASE + 0xC, 0x0000_7D3F), (BASE + 0x10, 0x0000_7F77)];
        assert_eq!(bus.take_writes(), [&[(BASE + 8, 0x201)][..], &hex].concat());
        panel.show();
        assert_eq!(bus.take_writes(), []);
        panel.led(9).set_low().unwrap();
        panel.show();
        assert_eq!(bus.take_writes(), [(BASE + 8, 0x001)]);
        panel.forget();
        panel.show();
        assert_eq!(bus.take_writes(), [&[(BASE + 8, 0x001)][..], &hex].concat());
    }
}
