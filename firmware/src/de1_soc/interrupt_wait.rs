//! Waiting for the FPGA, asleep.

use super::interrupts::{fpga_has_called, listen_to_fpga};
use crate::armv7a::sleep::sleep_unless;
use crate::cortex_a9::global_timer::GlobalTimer;
use fpga_regs::Wait;

/// Sleeps until the FPGA's interrupt or the end of the time; the board's tick ends a sleep, too, so
/// that the time is looked at.
pub struct InterruptWait {
    clock: GlobalTimer,
}

impl InterruptWait {
    /// Returns the wait by a clock that runs. The board's tick runs, too.
    #[must_use]
    pub const fn new(clock: GlobalTimer) -> Self {
        Self { clock }
    }
}

impl Wait for InterruptWait {
    const INTERRUPT: bool = true;

    fn wait(&mut self, micros: u32) -> u32 {
        let start = self.clock.microseconds();
        listen_to_fpga();
        loop {
            let elapsed = self.clock.microseconds().wrapping_sub(start);
            if elapsed >= u64::from(micros) || fpga_has_called() {
                // Rounded up.
                return u32::try_from(elapsed + 1).unwrap_or(u32::MAX);
            }
            sleep_unless(fpga_has_called);
        }
    }
}
