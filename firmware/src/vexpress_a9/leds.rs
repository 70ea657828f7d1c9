//! The eight user LEDs of the motherboard (SYS_LED).

use crate::mmio::{Register, Registers};
use core::convert::Infallible;
use embedded_hal::digital::{ErrorType, OutputPin, StatefulOutputPin};

#[derive(Clone, Copy)]
struct UserLeds;

impl Register for UserLeds {
    fn offset(self) -> usize {
        0
    }
}

/// One LED; high is on. Not for interrupt handlers: a change is a read and a write.
pub struct Led {
    register: Registers<UserLeds>,
    bit: u32,
}

impl Led {
    /// Returns all eight, the rightmost first, turned off.
    ///
    /// # Safety
    /// SYS_LED answers at `address`, and no other driver writes to it.
    #[must_use]
    pub unsafe fn all(address: usize) -> [Self; 8] {
        // SAFETY: the caller's promise is the same.
        let register = unsafe { Registers::at(address) };
        register.write(UserLeds, 0);
        core::array::from_fn(|index| Self { register, bit: 1 << index })
    }
}

impl ErrorType for Led {
    type Error = Infallible;
}

impl OutputPin for Led {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.register.change(UserLeds, self.bit, 0);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.register.change(UserLeds, 0, self.bit);
        Ok(())
    }
}

impl StatefulOutputPin for Led {
    fn is_set_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.register.read(UserLeds) & self.bit != 0)
    }

    fn is_set_low(&mut self) -> Result<bool, Infallible> {
        self.is_set_high().map(|high| !high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leds_are_independent() {
        let mut memory = [0xFFu32];
        // SAFETY: plain memory stands in for the device and outlives the driver.
        let mut leds = unsafe { Led::all((&raw mut memory).expose_provenance()) };
        leds[0].set_high().unwrap();
        leds[7].set_high().unwrap();
        leds[0].toggle().unwrap();
        assert_eq!(leds[7].is_set_high(), Ok(true));
        assert_eq!(memory, [0x80]);
    }
}
