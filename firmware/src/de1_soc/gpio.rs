//! Pins of a GPIO block (DesignWare; registers of `alt_gpio.h`).

use crate::mmio::{Bus, Mmio, Register, Registers};
use core::convert::Infallible;
use embedded_hal::digital::{ErrorType, InputPin, OutputPin, StatefulOutputPin};

/// Registers of a block; a bit for each pin.
#[derive(Debug, Clone, Copy)]
pub enum Offset {
    /// SWPORTA_DR: what outputs drive.
    Output = 0x00,
    /// SWPORTA_DDR: 1 is an output.
    Direction = 0x04,
    /// EXT_PORTA: the pins' levels.
    Level = 0x50,
}

impl Register for Offset {
    fn offset(self) -> usize {
        self as usize
    }
}

/// An output. Not for interrupt handlers: a change is a read and a write.
pub struct Output<B = Mmio> {
    registers: Registers<Offset, B>,
    mask: u32,
}

impl<B: Bus> Output<B> {
    /// Makes bit `bit` (0…28) of a block an output, low at first. The block is out of reset.
    #[must_use]
    pub fn new(registers: Registers<Offset, B>, bit: u32) -> Self {
        let pin = Self { registers, mask: 1 << bit };
        pin.registers.change(Offset::Output, pin.mask, 0);
        pin.registers.change(Offset::Direction, 0, pin.mask);
        pin
    }
}

impl<B> ErrorType for Output<B> {
    type Error = Infallible;
}

impl<B: Bus> OutputPin for Output<B> {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.registers.change(Offset::Output, self.mask, 0);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.registers.change(Offset::Output, 0, self.mask);
        Ok(())
    }
}

impl<B: Bus> StatefulOutputPin for Output<B> {
    fn is_set_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.registers.read(Offset::Output) & self.mask != 0)
    }

    fn is_set_low(&mut self) -> Result<bool, Infallible> {
        self.is_set_high().map(|high| !high)
    }
}

/// An input.
pub struct Input<B = Mmio> {
    registers: Registers<Offset, B>,
    mask: u32,
}

impl<B: Bus> Input<B> {
    /// Makes bit `bit` (0…28) of a block an input. The block is out of reset.
    #[must_use]
    pub fn new(registers: Registers<Offset, B>, bit: u32) -> Self {
        let pin = Self { registers, mask: 1 << bit };
        pin.registers.change(Offset::Direction, pin.mask, 0);
        pin
    }
}

impl<B> ErrorType for Input<B> {
    type Error = Infallible;
}

impl<B: Bus> InputPin for Input<B> {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.registers.read(Offset::Level) & self.mask != 0)
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        self.is_high().map(|high| !high)
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::mmio::mock::MockBus;
    use std::collections::BTreeMap;

    #[test]
    fn an_output_is_low_before_it_drives_and_leaves_its_neighbours() {
        let bus = MockBus::new(BTreeMap::from([(0x1000, 0x0100_0001), (0x1004, 0x0200_0001)]));
        let mut led = Output::new(Registers::on(bus.clone(), 0x1000), 24);
        assert_eq!(bus.take_writes(), [(0x1000, 1), (0x1004, 0x0300_0001)]);
        led.set_high().unwrap();
        led.toggle().unwrap();
        assert_eq!(bus.take_writes(), [(0x1000, 0x0100_0001), (0x1000, 1)]);
    }

    #[test]
    fn an_input_reads_the_level_and_not_the_latch() {
        let bus = MockBus::new(BTreeMap::from([(0x1000, 0), (0x1004, u32::MAX), (0x1050, 1 << 25)]));
        let mut key = Input::new(Registers::on(bus.clone(), 0x1000), 25);
        assert_eq!(bus.take_writes(), [(0x1004, !(1 << 25))]);
        assert_eq!((key.is_high(), key.is_low()), (Ok(true), Ok(false)));
    }
}
