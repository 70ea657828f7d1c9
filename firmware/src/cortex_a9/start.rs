//! The Cortex-A9's part of the start: snoop control unit, L2 cache, MMU and L1 caches.

use super::Cluster;
use super::l2c310::{Config, L2Error, L2c310};
use crate::armv7a::exceptions::Hooks;
use crate::armv7a::mmu;
use crate::armv7a::start::{ACTLR_SMP, take_reports};
use crate::armv7a::translation_table::TranslationTable;
use crate::mmio::{Register, Registers};
use cortex_ar::register::Actlr;

/// Registers of the snoop control unit (ARM DDI 0407, §2.2).
#[derive(Clone, Copy)]
enum SnoopControl {
    Control = 0x00,
    InvalidateTags = 0x0C,
}

impl Register for SnoopControl {
    fn offset(self) -> usize {
        self as usize
    }
}

/// ACTLR: this core broadcasts its maintenance (ARM DDI 0388).
const ACTLR_FW: u32 = 1 << 0;

/// How far the start came.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Report {
    /// Whether the L2 cache is on; the program runs without it, too, but slower.
    pub l2: Result<(), L2Error>,
}

/// Sets fault reports, snoop control unit, L2 cache, MMU and L1 caches up, in this order.
/// Interrupts stay masked.
///
/// # Safety
/// - Called once, first of all, on core 0 as `_start` left it.
/// - `cluster` gives the true addresses, and `table` maps them as Device memory and code, data and
///   stacks where the linker put them.
///
/// # Panics
/// When `table` maps the stack guard of memory.x: the two must agree.
pub unsafe fn bring_up(cluster: &Cluster, table: &'static TranslationTable, hooks: Hooks) -> Report {
    take_reports(table, hooks);
    // SAFETY: the caller gives the true address, and only this function touches the unit.
    let snoop_control = unsafe { Registers::at(cluster.snoop_control_unit()) };
    // Four bits for each core.
    snoop_control.write(SnoopControl::InvalidateTags, 0xFFFF);
    snoop_control.change(SnoopControl::Control, 0, 1);
    // SAFETY: the snoop control unit is on, and the caches are off.
    unsafe { Actlr::write(Actlr(Actlr::read().0 | ACTLR_SMP | ACTLR_FW)) };

    // SAFETY: the caller gives the true address; `_start` wrote the cache back and turned it off.
    let l2 = unsafe { L2c310::at(cluster.l2_cache_controller) }.enable(&Config::CYCLONE_V);
    // SAFETY: `_start` emptied the L1 caches and turned them off; the caller vouches for the
    // table, and this core takes part in coherency since two lines above.
    unsafe { mmu::enable(table) };
    Report { l2 }
}
