//! Sleeping until an interrupt.

/// Sleeps until an interrupt comes, unless `ready` holds. Returns after it was served.
///
/// Interrupts are masked between the question and the sleep, so one that makes `ready` true is
/// not slept through: a pending interrupt ends the sleep although it is masked.
pub fn sleep_unless(ready: impl FnOnce() -> bool) {
    critical_section::with(|_| {
        if !ready() {
            cortex_ar::asm::dsb();
            cortex_ar::asm::wfi();
        }
    });
}
