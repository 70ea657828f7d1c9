//! Turning the MMU and the caches on (ARM DDI 0406, chapters B3 and B4).

use super::cache;
use super::translation_table::TranslationTable;
use cortex_ar::asm::{dsb, isb};
use cortex_ar::register::{Sctlr, SysReg, SysRegWrite, TlbIAll};

/// TTBR0: table walks are inner and outer write-back, write-allocate, shareable
/// (IRGN = 0b01 in bits 0 and 6, S in bit 1, RGN = 0b01 in bits 4 and 3).
struct TranslationTableBase;

impl TranslationTableBase {
    const WALK_ATTRIBUTES: u32 = 1 << 6 | 1 << 3 | 1 << 1;
}

impl SysReg for TranslationTableBase {
    const CP: u32 = 15;
    const CRN: u32 = 2;
    const OP1: u32 = 0;
    const CRM: u32 = 0;
    const OP2: u32 = 0;
}

impl SysRegWrite for TranslationTableBase {}

/// TTBCR: zero takes every walk to TTBR0, in the short-descriptor format.
struct TranslationTableControl;

impl SysReg for TranslationTableControl {
    const CP: u32 = 15;
    const CRN: u32 = 2;
    const OP1: u32 = 0;
    const CRM: u32 = 0;
    const OP2: u32 = 2;
}

impl SysRegWrite for TranslationTableControl {}

/// DACR: domain 0 as a client, so that descriptors' permissions are checked; no other domain.
struct DomainAccess;

impl DomainAccess {
    const DOMAIN_0_CLIENT: u32 = 0b01;
}

impl SysReg for DomainAccess {
    const CP: u32 = 15;
    const CRN: u32 = 3;
    const OP1: u32 = 0;
    const CRM: u32 = 0;
    const OP2: u32 = 0;
}

impl SysRegWrite for DomainAccess {}

/// SCTLR: texture remap and access flag, which would give the descriptors' bits another meaning.
const REMAP: u32 = 1 << 28;
const ACCESS_FLAG: u32 = 1 << 29;

/// Turns MMU, data cache, instruction cache and branch prediction on; texture remap, access flag and the trap of
/// accesses that are not aligned, which U-Boot leaves on, off.
///
/// # Safety
/// - The MMU and the data cache are off, and the L1 caches hold nothing that memory lacks.
/// - `table` maps the running code, its data and stacks where they are now.
/// - The snoop control unit is on and this core takes part in it (ACTLR.SMP): without, the
///   Cortex-A9 does not cache shareable memory, and LDREX on it may never succeed.
pub unsafe fn enable(table: &'static TranslationTable) {
    // SAFETY: the caller vouches for the caches.
    unsafe { cache::invalidate_data() };
    cache::invalidate_instructions();
    TlbIAll::write();

    let base = (&raw const *table).addr() as u32;
    // SAFETY: the table lives for ever and is aligned to 16 KiB by its type; the caller vouches
    // for what it maps. The MMU is still off.
    unsafe {
        TranslationTableControl::write_raw(0);
        TranslationTableBase::write_raw(base | TranslationTableBase::WALK_ATTRIBUTES);
        DomainAccess::write_raw(DomainAccess::DOMAIN_0_CLIENT);
    }
    dsb();
    isb();
    Sctlr::modify(|control| {
        *control = Sctlr::new_with_raw_value(control.raw_value() & !(REMAP | ACCESS_FLAG));
        control.set_a(false);
        control.set_m(true);
        control.set_c(true);
        control.set_i(true);
        control.set_z(true);
    });
    dsb();
    isb();
}

/// Returns whether MMU and both caches are on.
#[must_use]
pub fn is_enabled() -> bool {
    let control = Sctlr::read();
    control.m() && control.c() && control.i()
}
