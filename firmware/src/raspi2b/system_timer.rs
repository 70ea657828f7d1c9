//! The system timer: 64 bits at 1 MHz, and comparators ("BCM2835 ARM Peripherals", chapter 12).

use crate::mmio::{Register, Registers};
use embedded_hal::delay::DelayNs;

/// Reads of a time that stands still before a wait gives up.
const STANDSTILL_READS: u32 = 100_000;
/// Reads that find the upper word changed, before the last one is taken as it is.
const READ_ATTEMPTS: u32 = 4;

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

    /// Returns the alarm, comparator 1; it is not set.
    #[must_use]
    pub const fn alarm(self) -> Alarm {
        Alarm { registers: self.registers }
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

/// An interrupt at a time. Copies name the same comparator.
#[derive(Clone, Copy)]
pub struct Alarm {
    registers: Registers<Offset>,
}

impl Alarm {
    /// Lets the alarm come at `microseconds` of the timer's time, less than 35 minutes from now, in
    /// place of an earlier setting. Returns `false` when that time is over: the comparator compares
    /// for equality, so no alarm comes then until the counter's lower half has gone round.
    #[must_use]
    pub fn set(self, microseconds: u64) -> bool {
        let time = microseconds as u32;
        self.registers.write(Offset::Compare1, time);
        time.wrapping_sub(self.registers.read(Offset::CounterLow)).cast_signed() > 0
    }

    /// Drops the interrupt, when the alarm has come.
    pub fn acknowledge(self) {
        self.registers.write(Offset::Status, MATCH_1);
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
    fn an_alarm_that_comes_too_late_is_told() {
        for (now, time, comes) in [
            (1_000, 1_001, true),
            (1_000, 1_000, false),
            (1_000, 999, false),
            // The lower half wraps.
            (u32::MAX, 1 << 32, true),
            (5, (7 << 32) - 1, false),
        ] {
            let mut memory = [0, now, 0, 0, 0];
            let alarm = timer(&mut memory).alarm();
            assert_eq!(alarm.set(time), comes, "{time} at {now}");
            alarm.acknowledge();
            assert_eq!((memory[0], memory[4]), (2, time as u32));
        }
    }
}
