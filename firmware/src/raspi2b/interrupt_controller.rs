//! The interrupt controller of the peripherals ("BCM2835 ARM Peripherals", chapter 7).
//!
//! It sends what is enabled to core 0 as IRQ: the BCM2836's own controller, in front of the cores,
//! is left as reset leaves it, and that routes so.

use crate::mmio::{Register, Registers};

#[derive(Clone, Copy)]
enum Offset {
    Pending = 0x04,
    Enable = 0x10,
    Disable = 0x1C,
    DisableBasic = 0x24,
}

impl Register for Offset {
    fn offset(self) -> usize {
        self as usize
    }
}

/// The number of a peripheral's interrupt, 0 to 63.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Interrupt(pub u8);

impl Interrupt {
    const fn word(self) -> usize {
        (self.0 / 32) as usize
    }

    const fn bit(self) -> u32 {
        1 << (self.0 % 32)
    }
}

/// The controller. Copies name the same device: enabling and disabling is one write each.
#[derive(Clone, Copy)]
pub struct InterruptController {
    registers: Registers<Offset>,
}

impl InterruptController {
    /// Returns the driver of the controller at `address`.
    ///
    /// # Safety
    /// A BCM2835 interrupt controller answers at `address`, and no other driver writes to it.
    #[must_use]
    pub const unsafe fn at(address: usize) -> Self {
        // SAFETY: the caller's promise is the same.
        Self { registers: unsafe { Registers::at(address) } }
    }

    /// Disables every interrupt.
    pub fn configure(self) {
        self.registers.write(Offset::DisableBasic, u32::MAX);
        for word in 0..2 {
            self.registers.write_at(Offset::Disable, word, u32::MAX);
        }
    }

    /// Lets an interrupt through.
    pub fn enable(self, interrupt: Interrupt) {
        self.registers.write_at(Offset::Enable, interrupt.word(), interrupt.bit());
    }

    /// Keeps an interrupt back.
    pub fn disable(self, interrupt: Interrupt) {
        self.registers.write_at(Offset::Disable, interrupt.word(), interrupt.bit());
    }

    /// Returns an interrupt that is enabled and pending, the lowest first.
    #[must_use]
    pub fn pending(self) -> Option<Interrupt> {
        (0..2_u8).find_map(|word| {
            let pending = self.registers.read_at(Offset::Pending, word.into());
            (pending != 0).then(|| Interrupt(32 * word + pending.trailing_zeros() as u8))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interrupt_has_its_word_and_bit() {
        let mut memory = [0_u32; 10];
        // SAFETY: plain memory stands in for the device and outlives the driver.
        let controller = unsafe { InterruptController::at((&raw mut memory).expose_provenance()) };
        controller.configure();
        assert_eq!(memory, [0, 0, 0, 0, 0, 0, 0, u32::MAX, u32::MAX, u32::MAX]);
        controller.enable(Interrupt(9));
        controller.enable(Interrupt(57));
        controller.disable(Interrupt(31));
        assert_eq!(memory, [0, 0, 0, 0, 1 << 9, 1 << 25, 0, 1 << 31, u32::MAX, u32::MAX]);
    }

    #[test]
    fn the_lowest_pending_interrupt_comes_first() {
        for (pending, expected) in
            [([0, 0], None), ([0, 1 << 25], Some(57)), ([1 << 9 | 1 << 29, 1], Some(9)), ([1 << 31, 0], Some(31))]
        {
            let mut memory = [0xFF, pending[0], pending[1], 0];
            // SAFETY: as above.
            let controller = unsafe { InterruptController::at((&raw mut memory).expose_provenance()) };
            assert_eq!(controller.pending(), expected.map(Interrupt));
        }
    }
}
