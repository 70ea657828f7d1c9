//! The system timer: 64 bits at 1 MHz, and comparators ("BCM2835 ARM Peripherals", chapter 12).

use crate::mmio::{Register, Registers};
use embedded_hal::delay::DelayNs;

/// Reads of a time that stands still before a wait gives up.
const STANDSTILL_READS: u32 = 100_000;
/// Reads that find the upper word changed, before the last one is taken as it is.
const READ_ATTEMPTS: u32 = 4;

/// Attempts to set the comparator before its time has come.
const ARM_ATTEMPTS: u32 = 8;

/// Ticks in a second, and so microseconds are ticks.
pub const HERTZ: u32 = 1_000_000;

#[derive(Clone, Copy)]
enum Offset {
    Status = 0x00,
    CounterLow = 0x04,
    CounterHigh = 0x08,
    Compare1 = 0x10,
}

impl Register for Offset {
    fn offset(self) -> usize {
        self as usize
    }
}

/// Comparator 1, in the status register.
const MATCH_1: u32 = 1 << 1;

/// The time. It runs from power on; copies tell the same time.
#[derive(Clone, Copy)]
pub struct SystemTimer {
    registers: Registers<Offset>,
}

impl SystemTimer {
    /// Returns the driver of the timer at `address`.
    ///
    /// # Safety
    /// A BCM2835 system timer answers at `address`, and no other driver writes to it.
    #[must_use]
    pub const unsafe fn at(address: usize) -> Self {
        // SAFETY: the caller's promise is the same.
        Self { registers: unsafe { Registers::at(address) } }
    }

    /// Returns the microseconds since power on.
    #[must_use]
    pub fn microseconds(self) -> u64 {
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

    /// Returns an interrupt by comparator 1, every `period_microseconds` once it is armed.
    #[must_use]
    pub const fn ticker(self, period_microseconds: u64) -> Ticker {
        Ticker { timer: self, period: period_microseconds, next: 0 }
    }
}

/// Waits by the system timer; at least as long as asked. Gives up when the time stands still.
impl DelayNs for SystemTimer {
    fn delay_ns(&mut self, nanoseconds: u32) {
        // The microsecond that has begun counts for nothing.
        let wanted = u64::from(nanoseconds.div_ceil(1_000)) + 1;
        let start = self.microseconds();
        let (mut last, mut standstill) = (start, 0);
        while last.wrapping_sub(start) < wanted && standstill < STANDSTILL_READS {
            let now = self.microseconds();
            standstill = if now == last { standstill + 1 } else { 0 };
            last = now;
        }
    }
}

/// An interrupt at regular times.
pub struct Ticker {
    timer: SystemTimer,
    period: u64,
    /// When the next one comes.
    next: u64,
}

impl Ticker {
    /// Drops the interrupt that came.
    pub fn acknowledge(&mut self) {
        self.timer.registers.write(Offset::Status, MATCH_1);
    }

    /// Prepares the next interrupt, unless it is already; those that were missed are left out.
    ///
    /// Returns whether one will come. The comparator compares for equality: set too late, as by an
    /// emulator that was held up, it would raise nothing until the counter's lower half has gone round.
    #[must_use]
    pub fn arm(&mut self) -> bool {
        (0..ARM_ATTEMPTS).any(|_| {
            let now = self.timer.microseconds();
            if self.next <= now {
                let last = if now - self.next < self.period { self.next } else { now };
                self.next = last + self.period;
                self.timer.registers.write(Offset::Compare1, self.next as u32);
            }
            self.next > self.timer.microseconds()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn timer(memory: &mut [u32; 5]) -> SystemTimer {
        // SAFETY: plain memory stands in for the device and outlives the driver.
        unsafe { SystemTimer::at((&raw mut *memory).expose_provenance()) }
    }

    #[test]
    fn a_time_that_stands_still_ends_a_wait() {
        let mut memory = [0, 0x1234_5678, 9, 0, 0];
        let mut timer = timer(&mut memory);
        assert_eq!(timer.microseconds(), 0x9_1234_5678);
        timer.delay_ms(1);
    }

    #[test]
    fn ticks_keep_their_distance_and_missed_ones_are_left_out() {
        for (now, last, next) in [
            (1_000, 900, 1_900),
            (1_899, 900, 1_900),
            // Late by a period and more.
            (3_000, 900, 4_000),
            // Not over yet.
            (1_000, 1_500, 1_500),
        ] {
            let mut memory = [0, now, 0, 0, 0];
            let mut ticker = timer(&mut memory).ticker(1_000);
            ticker.next = last;
            assert!(ticker.arm());
            ticker.acknowledge();
            assert_eq!((ticker.next, memory[0]), (next, 2), "last {last} at {now}");
            // It is set only when it changes.
            assert_eq!(u64::from(memory[4]), if next == last { 0 } else { next });
        }
    }
}
