//! The Cortex-A7's part of the start. Its L2 cache is the core's own: it goes on and off with L1.

use crate::armv7a::exceptions::Hooks;
use crate::armv7a::mmu;
use crate::armv7a::start::{ACTLR_SMP, take_reports};
use crate::armv7a::translation_table::TranslationTable;
use cortex_ar::register::Actlr;

/// Sets fault reports, MMU and caches up, in this order. Interrupts stay masked.
///
/// # Safety
/// - Called once, first of all, on core 0 as `_start` left it.
/// - `table` maps code, data and stacks where the linker put them.
///
/// # Panics
/// When `table` maps the stack guard of memory.x: the two must agree.
pub unsafe fn bring_up(table: &'static TranslationTable, hooks: Hooks) {
    take_reports(table, hooks);
    // SAFETY: the MMU and the caches are off, as the bit's change wants it (ARM DDI 0464, §4.3.31).
    unsafe { Actlr::write(Actlr(Actlr::read().0 | ACTLR_SMP)) };
    // SAFETY: `_start` emptied the caches and turned them off; the caller vouches for the table,
    // and this core takes part in coherency since the line above.
    unsafe { mmu::enable(table) };
}
