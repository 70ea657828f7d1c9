//! The global timer: 64 bits, PERIPHCLK (ARM DDI 0407, §4.4).

use super::{Answer, no_register};
use crate::time::{Clocks, PERIPHERAL_CLOCK};

const ENABLE: u32 = 1 << 0;
const COMPARE: u32 = 1 << 1;
const INTERRUPT: u32 = 1 << 2;
const AUTO_INCREMENT: u32 = 1 << 3;

/// The timer.
#[derive(Default)]
pub struct GlobalTimer {
    control: u32,
    /// The count at `since`, from where it goes on while enabled.
    count: u64,
    since: Clocks,
    comparator: u64,
    increment: u32,
    event: bool,
}

impl GlobalTimer {
    fn clock(&self) -> Clocks {
        PERIPHERAL_CLOCK * u64::from((self.control >> 8 & 0xFF) + 1)
    }

    fn count(&self, now: Clocks) -> u64 {
        let passed = if self.control & ENABLE != 0 { (now - self.since) / self.clock() } else { 0 };
        self.count.wrapping_add(passed)
    }

    /// Makes `now` the moment that the count is kept for.
    fn settle(&mut self, now: Clocks) {
        let whole = (now - self.since) / self.clock() * self.clock();
        self.count = self.count(now);
        self.since = if self.control & ENABLE != 0 { self.since + whole } else { now };
    }

    fn compares(&self) -> bool {
        self.control & (ENABLE | COMPARE) == ENABLE | COMPARE
    }

    /// Lets the comparator see the time.
    pub fn advance(&mut self, now: Clocks) {
        while self.compares()
            && !(self.event && self.control & AUTO_INCREMENT == 0)
            && self.count(now) >= self.comparator
        {
            self.event = true;
            if self.control & AUTO_INCREMENT == 0 || self.increment == 0 {
                break;
            }
            self.comparator = self.comparator.wrapping_add(self.increment.into());
        }
    }

    /// Returns when the comparator is met.
    pub fn next_event(&self, now: Clocks) -> Clocks {
        if !self.compares() || self.event && self.control & AUTO_INCREMENT == 0 {
            return Clocks::MAX;
        }
        let left = self.comparator.saturating_sub(self.count);
        self.since.saturating_add(left.saturating_mul(self.clock())).max(now + 1)
    }

    /// Returns the interrupt line.
    pub fn interrupt(&self) -> bool {
        self.event && self.control & INTERRUPT != 0
    }

    /// Reads a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn read(&self, offset: u32, now: Clocks) -> Answer<u32> {
        Ok(match offset {
            0x00 => self.count(now) as u32,
            0x04 => (self.count(now) >> 32) as u32,
            0x08 => self.control,
            0x0C => self.event.into(),
            0x10 => self.comparator as u32,
            0x14 => (self.comparator >> 32) as u32,
            0x18 => self.increment,
            _ => return no_register(offset),
        })
    }

    /// Writes a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn write(&mut self, offset: u32, value: u32, now: Clocks) -> Answer<()> {
        self.settle(now);
        let low = |old: u64| old & !0xFFFF_FFFF | u64::from(value);
        let high = |old: u64| old & 0xFFFF_FFFF | u64::from(value) << 32;
        match offset {
            0x00 | 0x04 if self.control & ENABLE != 0 => {
                return Err("the timer off: its count is written only then".into());
            }
            0x00 => self.count = low(self.count),
            0x04 => self.count = high(self.count),
            0x08 => self.control = value & 0xFF0F,
            0x0C => self.event &= value & 1 == 0,
            0x10 => self.comparator = low(self.comparator),
            0x14 => self.comparator = high(self.comparator),
            0x18 => self.increment = value,
            _ => return no_register(offset),
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_counts_periphclk_and_compares() {
        let mut timer = GlobalTimer::default();
        timer.write(0x10, 100, 0).unwrap();
        timer.write(0x08, ENABLE | COMPARE | INTERRUPT, 1_000).unwrap();
        assert_eq!(timer.read(0x00, 1_000 + 4 * 99 + 3), Ok(99));
        assert_eq!(timer.next_event(1_000), 1_400);
        timer.advance(1_399);
        assert!(!timer.interrupt());
        timer.advance(1_400);
        assert!(timer.interrupt());
        assert!(timer.write(0x00, 0, 1_400).is_err());
    }

    #[test]
    fn it_repeats_by_its_increment() {
        let mut timer = GlobalTimer::default();
        timer.write(0x10, 10, 0).unwrap();
        timer.write(0x18, 10, 0).unwrap();
        timer.write(0x08, ENABLE | COMPARE | INTERRUPT | AUTO_INCREMENT, 0).unwrap();
        timer.advance(40);
        assert!(timer.interrupt());
        timer.write(0x0C, 1, 50).unwrap();
        assert!(!timer.interrupt());
        assert_eq!(timer.next_event(50), 80);
    }
}
