//! From the first instruction to where a core's own set-up begins.
//!
//! The vector table of cortex-a-rt jumps to `_start`. The one below stands in front of
//! cortex-a-rt's, because a boot loader (U-Boot's `go`) hands over with MMU and caches on and the
//! image still in them, and because all cores may come this way:
//!
//! 0. keep what U-Boot's `go` passes ([`arguments_of_go`]);
//! 1. mask interrupts; park every core but the first in `wfi`;
//! 2. write the core's caches back, level by level, by set and way (ARM DDI 0406, §B2.2.7), then
//!    the PL310, where the board has one, and turn that off;
//! 3. turn MMU, data cache and high vectors off, empty TLB, instruction cache and predictor, and go on with
//!    the last two: without, every instruction of step 5 would be fetched from the SDRAM;
//! 4. take an abort that the boot loader caused and left pending, and forget it: nothing has been
//!    done yet that it could tell about;
//! 5. go on in cortex-a-rt: stacks, floating point, `.bss`, `.data`, `kmain`.
//!
//! No store to memory happens before step 5. `kmain` calls `bring_up` of its core
//! ([`cortex_a9`](crate::cortex_a9::start), [`cortex_a7`](crate::cortex_a7)) first of all.

use super::exceptions::{self, Hooks};
use super::translation_table::TranslationTable;
use cortex_ar::register::{SysReg, SysRegRead};

core::arch::global_asm!(
    r#"
    .section .text._start, "ax"
    .global _start
    .type _start, %function
    _start:
        mcr     p15, 0, r0, c13, c0, 2      // TPIDRURW: argc
        mcr     p15, 0, r1, c13, c0, 4      // TPIDRPRW: argv
        cpsid   if
        mrc     p15, 0, r0, c0, c0, 5       // MPIDR: which core
        ands    r0, r0, #3
    0:
        wfine
        bne     0b

        mrc     p15, 1, r10, c0, c0, 1      // CLIDR: what caches there are
        ubfx    r9, r10, #24, #3            // levels up to the point of coherency
        mov     r8, #0                      // level - 1
    1:
        cmp     r8, r9
        bhs     5f
        add     r0, r8, r8, lsl #1
        lsr     r0, r10, r0
        and     r0, r0, #7                  // the level's kind: 0 none, 1 instructions alone
        cmp     r0, #2
        blo     4f
        lsl     r0, r8, #1
        mcr     p15, 2, r0, c0, c0, 0       // CSSELR
        isb
        mrc     p15, 1, r1, c0, c0, 0       // CCSIDR
        and     r2, r1, #7
        add     r2, r2, #4                  // log2 of the bytes in a line
        ubfx    r3, r1, #3, #10             // ways - 1
        clz     r4, r3                      // where the way stands
        ubfx    r5, r1, #13, #15            // sets - 1
    2:
        mov     r6, r3
    3:
        lsl     r7, r6, r4
        orr     r7, r7, r5, lsl r2
        orr     r7, r7, r8, lsl #1
        mcr     p15, 0, r7, c7, c14, 2      // DCCISW: clean and invalidate
        subs    r6, r6, #1
        bpl     3b
        subs    r5, r5, #1
        bpl     2b
        dsb
    4:
        add     r8, r8, #1
        b       1b

    5:
        ldr     r0, =_l2_cache_controller
        cmp     r0, #0                      // none
        beq     7f
        ldr     r1, [r0, #0x100]            // CONTROL
        tst     r1, #1
        beq     7f
        mov     r1, #0xff                   // all eight ways
        str     r1, [r0, #0x7fc]            // clean and invalidate by way
        mov     r2, #0x1000000              // at most so many polls
    6:
        ldr     r1, [r0, #0x7fc]
        tst     r1, #0xff
        subsne  r2, r2, #1
        bne     6b
        mov     r1, #0
        str     r1, [r0, #0x730]            // sync
        dsb
        str     r1, [r0, #0x100]            // off
        dsb
    7:
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
        mrc     p15, 0, r0, c1, c0, 0       // SCTLR
        orr     r0, r0, #0x1800             // I, Z
        mcr     p15, 0, r0, c1, c0, 0
        isb

        ldr     r0, =_pending_abort_vectors
        mcr     p15, 0, r0, c12, c0, 0      // VBAR
        isb
        cpsie   a
        dsb
        isb
        cpsid   a
        ldr     r0, =_vector_table
        mcr     p15, 0, r0, c12, c0, 0
        isb
        b       _default_start
        .ltorg
    .size _start, . - _start

        .balign 32
    _pending_abort_vectors:
        b       .
        b       .
        b       .
        b       .
        subs    pc, lr, #8                  // a data abort: go on where it came
        b       .
        b       .
        b       .
    "#
);

unsafe extern "C" {
    /// The MiB below the stacks that must not be mapped (memory.x).
    static _stack_guard: u8;
}

/// A thread-id register, which keeps a word of the boot loader's: nothing here has threads.
struct ThreadId<const NUMBER: u32>;

impl<const NUMBER: u32> SysReg for ThreadId<NUMBER> {
    const CP: u32 = 15;
    const CRN: u32 = 13;
    const OP1: u32 = 0;
    const CRM: u32 = 0;
    const OP2: u32 = NUMBER;
}

impl<const NUMBER: u32> SysRegRead for ThreadId<NUMBER> {}

/// Returns r0 and r1 as they were at the first instruction: from U-Boot's `go`, how many words it
/// was given and where a list of pointers to them lies. From elsewhere, anything.
#[must_use]
pub fn arguments_of_go() -> [u32; 2] {
    // SAFETY: reads of two registers that only `_start` writes.
    unsafe { [ThreadId::<2>::read_raw(), ThreadId::<4>::read_raw()] }
}

/// ACTLR, on the Cortex-A7 and the Cortex-A9: the core takes part in coherency. Without, it caches no
/// shareable memory.
pub(crate) const ACTLR_SMP: u32 = 1 << 6;

/// Sets fault reports up.
///
/// # Panics
/// When `table` maps the stack guard of memory.x: the two must agree.
pub(crate) fn take_reports(table: &TranslationTable, hooks: Hooks) {
    exceptions::install(hooks);
    // Aborts that come late, of posted writes, are reported, too: they are masked since the reset.
    // SAFETY: their handler has its stack and its words since the line above.
    unsafe { core::arch::asm!("cpsie a", options(nomem, nostack, preserves_flags)) };
    let guard = (&raw const _stack_guard).addr() as u32;
    assert!(table.is_hole(guard), "the stack guard at {guard:#010x} is mapped");
}
