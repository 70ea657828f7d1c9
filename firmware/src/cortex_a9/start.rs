//! From the first instruction to MMU and caches on.
//!
//! The vector table of cortex-a-rt jumps to `_start`. The one below stands in front of
//! cortex-a-rt's, because a boot loader (U-Boot's `go`) hands over with MMU and caches on and the
//! image still in them, and because all cores may come this way:
//!
//! 1. mask interrupts; park every core but the first in `wfi`;
//! 2. write L1 back, by set and way, then the PL310, and turn that off;
//! 3. turn MMU, caches, branch prediction and high vectors off, and empty TLB, instruction cache
//!    and predictor;
//! 4. go on in cortex-a-rt: stacks, floating point, `.bss`, `.data`, `kmain`.
//!
//! No store to memory happens before step 4. `kmain` calls [`bring_up`] first of all.

use super::exceptions::{self, Hooks};
use super::l2c310::{Config, L2Error, L2c310};
use super::translation_table::TranslationTable;
use super::{Cluster, mmu};
use crate::mmio::{Register, Registers};
use cortex_ar::register::{Actlr, SysReg, SysRegWrite};

core::arch::global_asm!(
    r#"
    .section .text._start, "ax"
    .global _start
    .type _start, %function
    _start:
        cpsid   if
        mrc     p15, 0, r0, c0, c0, 5       // MPIDR: which core
        ands    r0, r0, #3
    0:
        wfine
        bne     0b

        mcr     p15, 2, r0, c0, c0, 0       // CSSELR = 0: the L1 data cache
        isb
        mrc     p15, 1, r0, c0, c0, 0       // CCSIDR
        ubfx    r1, r0, #13, #15            // sets - 1; four ways of 32-byte lines
    1:
        mov     r2, #3
    2:
        lsl     r3, r2, #30
        orr     r3, r3, r1, lsl #5
        mcr     p15, 0, r3, c7, c14, 2      // DCCISW: clean and invalidate
        subs    r2, r2, #1
        bpl     2b
        subs    r1, r1, #1
        bpl     1b
        dsb

        ldr     r0, =_l2_cache_controller
        ldr     r1, [r0, #0x100]            // CONTROL
        tst     r1, #1
        beq     4f
        mov     r1, #0xff                   // all eight ways
        str     r1, [r0, #0x7fc]            // clean and invalidate by way
        mov     r2, #0x1000000              // at most so many polls
    3:
        ldr     r1, [r0, #0x7fc]
        tst     r1, #0xff
        subsne  r2, r2, #1
        bne     3b
        mov     r1, #0
        str     r1, [r0, #0x730]            // sync
        dsb
        str     r1, [r0, #0x100]            // off
        dsb
    4:
        mrc     p15, 0, r0, c1, c0, 0       // SCTLR
        bic     r0, r0, #0x3800             // V (vectors at 0xFFFF0000), I, Z
        bic     r0, r0, #0x5                // C, M
        mcr     p15, 0, r0, c1, c0, 0
        isb
        mov     r0, #0
        mcr     p15, 0, r0, c8, c7, 0       // TLBIALL
        mcr     p15, 0, r0, c7, c5, 0       // ICIALLU
        mcr     p15, 0, r0, c7, c5, 6       // BPIALL
        dsb
        isb
        b       _default_start
        .ltorg
    .size _start, . - _start
    "#
);

unsafe extern "C" {
    /// The vectors, first in the image, aligned to 32 bytes (cortex-a-rt).
    static _vector_table: u8;
    /// The MiB below the stacks that must not be mapped (memory.x).
    static _stack_guard: u8;
}

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

/// VBAR: where the exception vectors are. cortex-a-rt leaves it at its reset value.
struct VectorBase;

impl SysReg for VectorBase {
    const CP: u32 = 15;
    const CRN: u32 = 12;
    const OP1: u32 = 0;
    const CRM: u32 = 0;
    const OP2: u32 = 0;
}

impl SysRegWrite for VectorBase {}

/// ACTLR bits: this core takes part in coherency, and broadcasts its maintenance (ARM DDI 0388).
const ACTLR_SMP: u32 = 1 << 6;
const ACTLR_FW: u32 = 1 << 0;

/// How far the start came.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Report {
    /// Whether the L2 cache is on; the program runs without it, too, but slower.
    pub l2: Result<(), L2Error>,
}

/// Sets vectors, fault reports, snoop control unit, L2 cache, MMU and L1 caches up, in this order.
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
    // SAFETY: the symbol marks the vector table, which stays there.
    unsafe { VectorBase::write_raw((&raw const _vector_table).addr() as u32) };
    exceptions::install(hooks);
    let guard = (&raw const _stack_guard).addr() as u32;
    assert!(table.is_hole(guard), "the stack guard at {guard:#010x} is mapped");

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
