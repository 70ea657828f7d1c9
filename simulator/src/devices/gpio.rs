//! A DesignWare GPIO block with 29 pins.

use super::{Answer, no_register, read_only};

/// Pins of a block.
const PINS: u32 = (1 << 29) - 1;

/// The block.
pub struct Gpio {
    data: u32,
    direction: u32,
    /// Levels that the board drives.
    outside: u32,
    interrupt_enable: u32,
    interrupt_mask: u32,
    edge_triggered: u32,
    active_high: u32,
    latched: u32,
    debounce: u32,
    synchronised: u32,
}

impl Gpio {
    /// Returns the block after reset, on pins at these levels.
    pub fn new(outside: u32) -> Self {
        Self {
            data: 0,
            direction: 0,
            outside,
            interrupt_enable: 0,
            interrupt_mask: 0,
            edge_triggered: 0,
            active_high: 0,
            latched: 0,
            debounce: 0,
            synchronised: 0,
        }
    }

    /// Resets the module; the board's levels stay.
    pub fn reset(&mut self) {
        *self = Self::new(self.outside);
    }

    /// Returns the pins' levels.
    pub fn pins(&self) -> u32 {
        self.data & self.direction | self.outside & !self.direction
    }

    /// Returns the levels of the pins that are outputs, others 0.
    pub fn driven(&self) -> u32 {
        self.data & self.direction
    }

    /// Lets the board drive a pin.
    pub fn set_outside(&mut self, pin: u32, level: bool) {
        let before = self.active();
        self.outside = self.outside & !(1 << pin) | u32::from(level) << pin;
        self.latched |= self.active() & !before & self.edge_triggered & self.interrupt_enable;
    }

    /// Pins whose level is the one that interrupts.
    fn active(&self) -> u32 {
        !(self.pins() ^ self.active_high) & PINS
    }

    fn raw_status(&self) -> u32 {
        (self.latched & self.edge_triggered | self.active() & !self.edge_triggered) & self.interrupt_enable
    }

    fn status(&self) -> u32 {
        self.raw_status() & !self.interrupt_mask
    }

    /// Returns the interrupt line.
    pub fn interrupt(&self) -> bool {
        self.status() != 0
    }

    /// Reads a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn read(&self, offset: u32) -> Answer<u32> {
        Ok(match offset {
            0x00 => self.data,
            0x04 => self.direction,
            0x30 => self.interrupt_enable,
            0x34 => self.interrupt_mask,
            0x38 => self.edge_triggered,
            0x3C => self.active_high,
            0x40 => self.status(),
            0x44 => self.raw_status(),
            0x48 => self.debounce,
            0x50 => self.pins(),
            0x60 => self.synchronised,
            _ => return no_register(offset),
        })
    }

    /// Writes a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn write(&mut self, offset: u32, value: u32) -> Answer<()> {
        let value = value & PINS;
        match offset {
            0x00 => self.data = value,
            0x04 => self.direction = value,
            0x30 => self.interrupt_enable = value,
            0x34 => self.interrupt_mask = value,
            0x38 => self.edge_triggered = value,
            0x3C => self.active_high = value,
            0x40 | 0x44 | 0x50 => return read_only("the register"),
            0x48 => self.debounce = value,
            0x4C => self.latched &= !value,
            0x60 => self.synchronised = value & 1,
            _ => return no_register(offset),
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_falling_edge_interrupts_until_it_is_acknowledged() {
        let mut gpio = Gpio::new(PINS);
        for (offset, value) in [(0x38, 1 << 25), (0x3C, 0), (0x30, 1 << 25)] {
            gpio.write(offset, value).unwrap();
        }
        assert!(!gpio.interrupt());
        gpio.set_outside(25, false);
        assert_eq!((gpio.interrupt(), gpio.read(0x50)), (true, Ok(PINS & !(1 << 25))));
        gpio.set_outside(25, true);
        assert!(gpio.interrupt());
        gpio.write(0x4C, 1 << 25).unwrap();
        assert!(!gpio.interrupt());
    }

    #[test]
    fn only_outputs_drive_their_pins() {
        let mut gpio = Gpio::new(0);
        gpio.write(0x00, 1 << 24).unwrap();
        assert_eq!(gpio.pins(), 0);
        gpio.write(0x04, 1 << 24).unwrap();
        assert_eq!((gpio.pins(), gpio.driven()), (1 << 24, 1 << 24));
    }
}
