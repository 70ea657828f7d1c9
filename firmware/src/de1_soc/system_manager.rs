//! The system manager: words that survive a warm reset, and switches of other blocks
//! (Intel's HPS manual 683126, chapter 6; registers of `alt_sysmgr.h`).

use crate::mmio::{Bus, Mmio, Register, Registers};

/// Registers of the system manager.
#[derive(Debug, Clone, Copy)]
pub enum Offset {
    /// WDDBG: what the watchdogs do while a debugger has stopped a core.
    WatchdogDebug = 0x10,
    /// FPGAINTF.MODULE: peripherals whose pins are the FPGA's.
    FpgaModules = 0x28,
    /// ISW.HANDOFF: eight words for software, which only a cold reset clears. U-Boot uses the first five.
    Handoff = 0x80,
}

impl Register for Offset {
    fn offset(self) -> usize {
        self as usize
    }
}

/// WDDBG: the first L4 watchdog stands still while either core is stopped.
const PAUSE_WATCHDOG_0: u32 = 0b11;
/// The two hand-off words that this program uses.
const NOTE: [usize; 2] = [6, 7];

/// The system manager.
#[derive(Clone, Copy)]
pub struct SystemManager<B = Mmio> {
    registers: Registers<Offset, B>,
}

impl<B: Bus> SystemManager<B> {
    /// Returns the driver of a system manager.
    #[must_use]
    pub const fn new(registers: Registers<Offset, B>) -> Self {
        Self { registers }
    }

    /// Leaves all peripherals' pins on the processor's side, as this board has them.
    pub fn disconnect_fpga_modules(&self) {
        self.registers.write(Offset::FpgaModules, 0);
    }

    /// Lets the first L4 watchdog stand still while a debugger has stopped a core.
    pub fn pause_watchdog_in_debug(&self) {
        self.registers.change(Offset::WatchdogDebug, 0, PAUSE_WATCHDOG_0);
    }

    /// Leaves a word for the next start; it survives every reset but a cold one.
    pub fn leave_note(&self, note: u32) {
        self.registers.write_at(Offset::Handoff, NOTE[0], note);
        self.registers.write_at(Offset::Handoff, NOTE[1], !note);
    }

    /// Returns the word that was left; `None` when there is none.
    #[must_use]
    pub fn note(&self) -> Option<u32> {
        let [note, inverse] = NOTE.map(|index| self.registers.read_at(Offset::Handoff, index));
        (note == !inverse).then_some(note)
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::mmio::mock::MockBus;
    use std::collections::BTreeMap;

    #[test]
    fn a_note_is_kept_twice_and_half_of_one_is_none() {
        let bus = MockBus::new(BTreeMap::new());
        let system = SystemManager::new(Registers::on(bus.clone(), 0xFFD0_8000));
        assert_eq!(system.note(), None, "both words are zero after power-on");
        system.leave_note(0x1234_5678);
        assert_eq!(bus.take_writes(), [(0xFFD0_8098, 0x1234_5678), (0xFFD0_809C, 0xEDCB_A987)]);
        assert_eq!(system.note(), Some(0x1234_5678));
        bus.devices(|memory| memory.insert(0xFFD0_8098, 1));
        assert_eq!(system.note(), None);
    }
}
