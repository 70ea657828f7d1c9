//! The global timer: 64-bit time since start, and delays (ARM DDI 0407, §4.4).

use crate::mmio::{Register, Registers};
use embedded_hal::delay::DelayNs;

/// Reads of a time that stands still before a wait gives up: the timer is off, or its clock is.
const STANDSTILL_READS: u32 = 100_000;
/// Reads that find the upper word changed, before the last one is taken as it is.
const READ_ATTEMPTS: u32 = 4;

#[derive(Clone, Copy)]
enum Offset {
    CounterLow = 0x00,
    CounterHigh = 0x04,
    Control = 0x08,
}

impl Register for Offset {
    fn offset(self) -> usize {
        self as usize
    }
}

/// The time. Copies tell the same time.
#[derive(Clone, Copy)]
pub struct GlobalTimer {
    registers: Registers<Offset>,
    hertz: u32,
}

impl GlobalTimer {
    /// Returns the driver of the timer at `address`, which counts `hertz` times a second.
    ///
    /// # Safety
    /// A Cortex-A9 global timer answers at `address`, and no other driver writes to it.
    #[must_use]
    pub const unsafe fn at(address: usize, hertz: u32) -> Self {
        // SAFETY: the caller's promise is the same.
        Self { registers: unsafe { Registers::at(address) }, hertz }
    }

    /// Starts the timer at zero, without comparator and interrupt.
    pub fn start(self) {
        self.registers.write(Offset::Control, 0);
        self.registers.write(Offset::CounterLow, 0);
        self.registers.write(Offset::CounterHigh, 0);
        self.registers.write(Offset::Control, 1);
    }

    /// Returns the ticks since the start.
    #[must_use]
    pub fn ticks(self) -> u64 {
        let mut high = self.registers.read(Offset::CounterHigh);
        let mut low = self.registers.read(Offset::CounterLow);
        for _ in 0..READ_ATTEMPTS {
            let again = self.registers.read(Offset::CounterHigh);
            if again == high {
                break;
            }
            high = again;
            low = self.registers.read(Offset::CounterLow);
        }
        u64::from(high) << 32 | u64::from(low)
    }

    /// Returns how many ticks make a second.
    #[must_use]
    pub fn hertz(self) -> u32 {
        self.hertz
    }

    /// Returns the time since the start in microseconds, rounded down.
    #[must_use]
    pub fn microseconds(self) -> u64 {
        self.ticks() / u64::from((self.hertz / 1_000_000).max(1))
    }

    /// Waits until `condition` holds, for at most `microseconds`. Returns whether it came true.
    #[must_use]
    pub fn wait(self, microseconds: u32, mut condition: impl FnMut() -> bool) -> bool {
        let ticks = u64::from(microseconds) * u64::from(self.hertz) / 1_000_000;
        self.wait_ticks(ticks + 1, &mut condition)
    }

    /// Asks `condition` at least once. Gives up early when the time stands still.
    fn wait_ticks(self, ticks: u64, condition: &mut dyn FnMut() -> bool) -> bool {
        let start = self.ticks();
        let mut last = start;
        let mut standstill = 0;
        loop {
            if condition() {
                return true;
            }
            let now = self.ticks();
            standstill = if now == last { standstill + 1 } else { 0 };
            last = now;
            if now.wrapping_sub(start) >= ticks || standstill >= STANDSTILL_READS {
                return false;
            }
        }
    }
}

/// Delays by the global timer; at least as long as asked.
#[derive(Clone, Copy)]
pub struct Delay {
    timer: GlobalTimer,
}

impl Delay {
    /// Returns delays by a timer that runs.
    #[must_use]
    pub const fn new(timer: GlobalTimer) -> Self {
        Self { timer }
    }
}

impl DelayNs for Delay {
    fn delay_ns(&mut self, nanoseconds: u32) {
        let ticks = (u64::from(nanoseconds) * u64::from(self.timer.hertz)).div_ceil(1_000_000_000);
        // The tick that has begun counts for nothing.
        self.timer.wait_ticks(ticks + 1, &mut || false);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_timer_that_stands_still_ends_a_wait() {
        let mut memory = [0x1234_5678u32, 9, 0];
        // SAFETY: plain memory stands in for the device and outlives the driver.
        let timer = unsafe { GlobalTimer::at((&raw mut memory).expose_provenance(), 200_000_000) };
        assert_eq!(timer.ticks(), 0x9_1234_5678);
        assert_eq!(timer.microseconds(), 0x9_1234_5678 / 200);
        assert!(!timer.wait(1_000_000, || false));
        assert!(timer.wait(0, || true));
        Delay::new(timer).delay_ms(1);
    }
}
