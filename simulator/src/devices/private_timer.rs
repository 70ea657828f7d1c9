//! The core's own timer and watchdog: 32 bits, PERIPHCLK, counting down (ARM DDI 0407, §4.2, §4.3).

use super::{Answer, no_register};
use crate::time::{Clocks, PERIPHERAL_CLOCK};

const ENABLE: u32 = 1 << 0;
const AUTO_RELOAD: u32 = 1 << 1;
const INTERRUPT: u32 = 1 << 2;
const WATCHDOG: u32 = 1 << 3;

/// One counter.
#[derive(Default)]
struct Counter {
    control: u32,
    load: u32,
    /// The count at `since`.
    count: u32,
    since: Clocks,
    event: bool,
}

impl Counter {
    fn clock(&self) -> Clocks {
        PERIPHERAL_CLOCK * u64::from((self.control >> 8 & 0xFF) + 1)
    }

    fn runs(&self) -> bool {
        self.control & ENABLE != 0
    }

    /// When the count reaches zero.
    fn zero_at(&self) -> Clocks {
        if self.runs() && (self.count > 0 || self.control & AUTO_RELOAD != 0) {
            self.since + u64::from(self.count) * self.clock()
        } else {
            Clocks::MAX
        }
    }

    /// Counts up to now; whether zero was reached.
    fn advance(&mut self, now: Clocks) -> bool {
        let mut reached = false;
        while self.zero_at() <= now {
            reached = true;
            self.event = true;
            self.since = self.zero_at();
            self.count = 0;
            if self.control & AUTO_RELOAD == 0 {
                break;
            }
            // The reload takes a clock of its own.
            self.since += self.clock();
            self.count = self.load;
            if self.load == 0 {
                break;
            }
        }
        reached
    }

    fn now(&self, now: Clocks) -> u32 {
        if !self.runs() {
            return self.count;
        }
        self.count.saturating_sub((now.saturating_sub(self.since) / self.clock()) as u32)
    }

    fn read(&self, offset: u32, now: Clocks) -> Answer<u32> {
        Ok(match offset {
            0x00 => self.load,
            0x04 => self.now(now),
            0x08 => self.control,
            0x0C => self.event.into(),
            _ => return no_register(offset),
        })
    }

    /// Keeps the count for a moment not before now, and the phase with it.
    fn settle(&mut self, now: Clocks) {
        if !self.runs() {
            self.since = now;
        } else if self.since < now {
            let passed = (now - self.since) / self.clock();
            self.count = self.count.saturating_sub(passed as u32);
            self.since += passed * self.clock();
        }
    }

    fn write(&mut self, offset: u32, value: u32, now: Clocks) -> Answer<()> {
        self.settle(now);
        match offset {
            0x00 | 0x04 => {
                if offset == 0x00 {
                    self.load = value;
                }
                (self.count, self.since) = (value, now);
            }
            0x08 => {
                let starts = !self.runs() && value & ENABLE != 0;
                self.control = value;
                if starts && self.count == 0 && value & AUTO_RELOAD != 0 {
                    self.count = self.load;
                }
            }
            0x0C => self.event &= value & 1 == 0,
            _ => return no_register(offset),
        }
        Ok(())
    }
}

/// Timer and watchdog.
#[derive(Default)]
pub struct PrivateTimer {
    timer: Counter,
    watchdog: Counter,
    /// The last word of the sequence that leaves watchdog mode.
    disable_key: u32,
    bitten: bool,
}

impl PrivateTimer {
    /// Counts up to now; whether the watchdog resets the machine.
    pub fn advance(&mut self, now: Clocks) -> bool {
        self.timer.advance(now);
        if self.watchdog.advance(now) && self.watchdog.control & WATCHDOG != 0 {
            self.bitten = true;
            return true;
        }
        false
    }

    /// Returns when something happens by itself.
    pub fn next_event(&self) -> Clocks {
        self.timer.zero_at().min(self.watchdog.zero_at())
    }

    /// Returns the timer's interrupt line.
    pub fn timer_interrupt(&self) -> bool {
        self.timer.event && self.timer.control & INTERRUPT != 0
    }

    /// Returns the watchdog's interrupt line, which it has as a timer.
    pub fn watchdog_interrupt(&self) -> bool {
        self.watchdog.event && self.watchdog.control & (INTERRUPT | WATCHDOG) == INTERRUPT
    }

    /// Reads a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn read(&mut self, offset: u32, now: Clocks) -> Answer<u32> {
        match offset {
            0x00..=0x0C => self.timer.read(offset, now),
            0x20..=0x2C => self.watchdog.read(offset - 0x20, now),
            0x30 => Ok(self.bitten.into()),
            _ => no_register(offset),
        }
    }

    /// Writes a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn write(&mut self, offset: u32, value: u32, now: Clocks) -> Answer<()> {
        match offset {
            0x00..=0x0C => self.timer.write(offset, value, now),
            // In watchdog mode the mode bit stays, and the counter is not written.
            0x24 if self.watchdog.control & WATCHDOG != 0 => Ok(()),
            0x28 => {
                let value = value | self.watchdog.control & WATCHDOG;
                self.watchdog.write(0x08, value, now)
            }
            0x20..=0x2C => self.watchdog.write(offset - 0x20, value, now),
            0x30 => {
                self.bitten &= value & 1 == 0;
                Ok(())
            }
            0x34 => {
                if self.disable_key == 0x1234_5678 && value == 0x8765_4321 {
                    self.watchdog.control &= !WATCHDOG;
                }
                self.disable_key = value;
                Ok(())
            }
            _ => no_register(offset),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_periodic_timer_keeps_its_period() {
        let mut timer = PrivateTimer::default();
        timer.write(0x00, 99, 0).unwrap();
        timer.write(0x08, ENABLE | AUTO_RELOAD | INTERRUPT, 0).unwrap();
        let mut ticks = 0;
        let mut now = 0;
        while now < 400 * 10 {
            now = timer.next_event();
            assert!(!timer.advance(now));
            assert!(timer.timer_interrupt());
            timer.write(0x0C, 1, now).unwrap();
            ticks += 1;
        }
        assert_eq!((ticks, now), (11, 4_396), "99 clocks to the first zero, 100 from each to the next");
    }

    #[test]
    fn the_watchdog_bites_unless_it_is_loaded() {
        let mut timer = PrivateTimer::default();
        timer.write(0x20, 1_000, 0).unwrap();
        timer.write(0x28, ENABLE | WATCHDOG, 0).unwrap();
        assert!(!timer.advance(3_999));
        timer.write(0x20, 1_000, 3_999).unwrap();
        assert!(!timer.advance(7_998));
        timer.write(0x28, 0, 7_998).unwrap();
        assert_eq!(timer.read(0x28, 7_998).unwrap() & WATCHDOG, WATCHDOG, "the mode stays");
        timer.write(0x28, ENABLE, 10_000).unwrap();
        assert!(!timer.advance(10_003), "one count is left");
        assert!(timer.advance(10_004));
        assert_eq!(timer.read(0x30, 10_004), Ok(1));
    }
}
