//! The two bridges from the processor to the FPGA (Intel's HPS manual 683126, chapters 8 and 9; the
//! order is U-Boot's `do_bridge_reset`).
//!
//! An access through a bridge that is in reset, or to an FPGA that is not configured, stops the
//! processor for good. So they are opened only when the FPGA manager says that the FPGA runs, and
//! closed again when it stops.

use super::reset_manager::ResetManager;
use super::system_manager::SystemManager;
use crate::mmio::{Bus, Mmio, Register, Registers};

/// The interconnect's REMAP. It cannot be read back.
#[derive(Debug, Clone, Copy)]
pub struct Remap;

impl Register for Remap {
    fn offset(self) -> usize {
        0
    }
}

/// REMAP: the on-chip RAM at address 0, as U-Boot leaves it (the L2 cache's filter has SDRAM there), no bridge.
const CLOSED: u32 = 1 << 0;
/// REMAP: both bridges' windows beside it. Bit 3 is the wide bridge's, bit 4 the lightweight one's.
const OPEN: u32 = CLOSED | 1 << 3 | 1 << 4;

/// Both HPS-to-FPGA bridges.
pub struct Bridges<B = Mmio> {
    interconnect: Registers<Remap, B>,
    resets: ResetManager<B>,
    system: SystemManager<B>,
}

impl<B: Bus> Bridges<B> {
    /// Returns the bridges as they were left.
    #[must_use]
    pub const fn new(interconnect: Registers<Remap, B>, resets: ResetManager<B>, system: SystemManager<B>) -> Self {
        Self { interconnect, resets, system }
    }

    /// Closes both: from now on an access to their windows is a data abort, not a hang.
    pub fn close(&mut self) {
        self.interconnect.write(Remap, CLOSED);
        self.interconnect.settle();
        self.resets.hold_bridges();
        self.system.disconnect_fpga_modules();
    }

    /// Opens both, out of a fresh reset.
    ///
    /// The FPGA is configured, or the first access stops the processor.
    pub fn open(&mut self) {
        self.close();
        self.resets.release_bridges();
        self.interconnect.write(Remap, OPEN);
        self.interconnect.settle();
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::mmio::mock::{Access, MockBus};
    use std::collections::BTreeMap;

    #[test]
    fn windows_appear_after_the_reset_and_go_before_it_and_each_step_has_arrived() {
        let bus = MockBus::new(BTreeMap::new());
        let resets = ResetManager::new(Registers::on(bus.clone(), 0xFFD0_5000));
        let system = SystemManager::new(Registers::on(bus.clone(), 0xFFD0_8000));
        let mut bridges = Bridges::new(Registers::on(bus.clone(), 0xFF80_0000), resets, system);
        bridges.open();
        use Access::{Settle, Write};
        let closing = [Write(0xFF80_0000, 0x01), Settle, Write(0xFFD0_501C, 0x7), Settle, Write(0xFFD0_8028, 0)];
        let opening = [Write(0xFFD0_501C, 0x4), Settle, Write(0xFF80_0000, 0x19), Settle];
        assert_eq!(bus.take_journal(), [&closing[..], &opening].concat());
        bridges.close();
        assert_eq!(bus.take_journal(), closing);
    }
}
