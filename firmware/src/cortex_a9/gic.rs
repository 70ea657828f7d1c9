//! The interrupt controller of the Cortex-A9 MPCore (GICv1, ARM DDI 0407 chapter 3, ARM IHI 0048).
//!
//! Every interrupt goes to core 0 as IRQ, in the secure state that the core starts in. The crate
//! `arm-gic` (0.10) does not serve here: it acknowledges through registers that GICv1 lacks, sets
//! no targets, and setting one priority zeroes those of its three neighbours.

use crate::mmio::{Register, Registers};

/// What the interface answers when nothing is pending.
const SPURIOUS: u32 = 1023;

#[derive(Clone, Copy)]
enum DistributorOffset {
    Control = 0x000,
    Type = 0x004,
    Group = 0x080,
    SetEnable = 0x100,
    ClearEnable = 0x180,
    ClearPending = 0x280,
    Priority = 0x400,
    Targets = 0x800,
    Configuration = 0xC00,
}

impl Register for DistributorOffset {
    fn offset(self) -> usize {
        self as usize
    }
}

#[derive(Clone, Copy)]
enum InterfaceOffset {
    Control = 0x00,
    PriorityMask = 0x04,
    Acknowledge = 0x0C,
    EndOfInterrupt = 0x10,
}

impl Register for InterfaceOffset {
    fn offset(self) -> usize {
        self as usize
    }
}

/// The number of an interrupt, 0 to 1019: 0–15 software, 16–31 this core's own, from 32 shared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct InterruptId(pub u16);

impl InterruptId {
    /// This core's private timer (ARM DDI 0407, §3.1.2).
    pub const PRIVATE_TIMER: Self = Self(29);
}

/// The distributor: which interrupts get through, and where to.
pub struct Distributor {
    registers: Registers<DistributorOffset>,
}

impl Distributor {
    /// Returns the driver of the distributor at `address`.
    ///
    /// # Safety
    /// A GIC distributor answers at `address`, and no other driver writes to it.
    #[must_use]
    pub const unsafe fn at(address: usize) -> Self {
        // SAFETY: the caller's promise is the same.
        Self { registers: unsafe { Registers::at(address) } }
    }

    /// Disables and clears all interrupts, sends them to core 0 at one priority, takes those from
    /// devices by their level, and turns the distributor on.
    pub fn configure(&mut self) {
        self.registers.write(DistributorOffset::Control, 0);
        let words = (self.interrupts() / 32) as usize;
        for word in 0..words {
            self.registers.write_at(DistributorOffset::ClearEnable, word, u32::MAX);
            self.registers.write_at(DistributorOffset::ClearPending, word, u32::MAX);
            self.registers.write_at(DistributorOffset::Group, word, 0);
        }
        // A byte for each interrupt. Targets of the first 32 are read only: they are this core's.
        for word in 0..words * 8 {
            self.registers.write_at(DistributorOffset::Priority, word, 0xA0A0_A0A0);
            self.registers.write_at(DistributorOffset::Targets, word, 0x0101_0101);
        }
        // Two bits for each interrupt. The first 32 are not devices' and have their own.
        for word in 2..words * 2 {
            self.registers.write_at(DistributorOffset::Configuration, word, 0);
        }
        self.registers.write(DistributorOffset::Control, 1);
    }

    /// Lets an interrupt through.
    pub fn enable(&mut self, interrupt: InterruptId) {
        let (word, bit) = (usize::from(interrupt.0 / 32), 1 << (interrupt.0 % 32));
        self.registers.write_at(DistributorOffset::SetEnable, word, bit);
    }

    /// Keeps an interrupt back.
    pub fn disable(&mut self, interrupt: InterruptId) {
        let (word, bit) = (usize::from(interrupt.0 / 32), 1 << (interrupt.0 % 32));
        self.registers.write_at(DistributorOffset::ClearEnable, word, bit);
    }

    /// Returns how many interrupts the controller has, a multiple of 32.
    #[must_use]
    pub fn interrupts(&self) -> u32 {
        ((self.registers.read(DistributorOffset::Type) & 0x1F) + 1) * 32
    }
}

/// This core's side of the controller.
pub struct Interface {
    registers: Registers<InterfaceOffset>,
}

impl Interface {
    /// Returns the driver of the interface at `address`.
    ///
    /// # Safety
    /// A GIC CPU interface answers at `address`, and no other driver writes to it.
    #[must_use]
    pub const unsafe fn at(address: usize) -> Self {
        // SAFETY: the caller's promise is the same.
        Self { registers: unsafe { Registers::at(address) } }
    }

    /// Lets interrupts of every priority through to the core.
    pub fn configure(&mut self) {
        self.registers.write(InterfaceOffset::PriorityMask, 0xFF);
        self.registers.write(InterfaceOffset::Control, 1);
    }

    /// Takes the next pending interrupt on; `None` when there is none. What is returned must be
    /// given to [`end`](Self::end), or no further interrupt comes.
    pub fn acknowledge(&mut self) -> Option<Acknowledged> {
        let word = self.registers.read(InterfaceOffset::Acknowledge);
        (word & 0x3FF != SPURIOUS).then_some(Acknowledged { word })
    }

    /// Says that an interrupt was served.
    pub fn end(&mut self, acknowledged: Acknowledged) {
        self.registers.write(InterfaceOffset::EndOfInterrupt, acknowledged.word);
    }
}

/// An interrupt that was taken on and not yet ended.
#[derive(Debug, PartialEq, Eq)]
#[must_use = "an interrupt that is never ended blocks the next ones"]
pub struct Acknowledged {
    word: u32,
}

impl Acknowledged {
    /// Returns which interrupt it is.
    #[must_use]
    pub fn interrupt(&self) -> InterruptId {
        InterruptId((self.word & 0x3FF) as u16)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn enabling_touches_one_bit_of_the_right_word() {
        let mut memory = [0u32; 0x1000 / 4];
        memory[1] = 2; // 96 interrupts
        // SAFETY: plain memory stands in for the device and outlives the driver.
        let mut distributor = unsafe { Distributor::at((&raw mut memory).expose_provenance()) };
        memory[0xC04 / 4] = 0x5555_5555;
        memory[0xC14 / 4] = 0xAAAA_AAAA;
        distributor.configure();
        distributor.enable(InterruptId(44));
        distributor.disable(InterruptId(72));
        assert_eq!(distributor.interrupts(), 96);
        assert_eq!(memory[0x104 / 4], 1 << 12);
        assert_eq!(memory[0x188 / 4], 1 << 8);
        assert_eq!((memory[0xC04 / 4], memory[0xC14 / 4]), (0x5555_5555, 0), "devices' interrupts are levels");
        assert_eq!(memory[0x45C / 4], 0xA0A0_A0A0, "the last priority");
        assert_eq!(memory[0x460 / 4], 0, "and no further one");
        assert_eq!(memory[0x85C / 4], 0x0101_0101);
        assert_eq!(memory[0], 1);
    }

    #[test]
    fn a_spurious_interrupt_is_none() {
        let mut memory = [0u32; 8];
        memory[3] = 1023;
        // SAFETY: as above.
        let mut interface = unsafe { Interface::at((&raw mut memory).expose_provenance()) };
        assert_eq!(interface.acknowledge(), None);
    }

    /// Bits 10 to 12 name the core that sent a software interrupt; the end must repeat them.
    #[test]
    fn an_end_repeats_the_acknowledged_word() {
        let mut memory = [0u32; 8];
        memory[3] = 1 << 10 | 5;
        // SAFETY: as above.
        let mut interface = unsafe { Interface::at((&raw mut memory).expose_provenance()) };
        let acknowledged = interface.acknowledge().expect("one is pending");
        assert_eq!(acknowledged.interrupt(), InterruptId(5));
        interface.end(acknowledged);
        assert_eq!(memory[4], 1 << 10 | 5);
    }
}
