//! A DesignWare watchdog on the peripherals' bus, on OSC1 (25 MHz).

use super::{Answer, no_register, read_only};
use crate::time::{Clocks, OSC1_CLOCK};

const KICK: u32 = 0x76;
const ENABLE: u32 = 1 << 0;
const INTERRUPT_FIRST: u32 = 1 << 1;

/// The watchdog.
pub struct L4Watchdog {
    control: u32,
    range: u32,
    /// When it counted from.
    since: Clocks,
    period: Clocks,
    interrupt: bool,
}

impl Default for L4Watchdog {
    fn default() -> Self {
        Self { control: INTERRUPT_FIRST, range: 0, since: 0, period: 0, interrupt: false }
    }
}

impl L4Watchdog {
    fn length(code: u32) -> Clocks {
        (1 << (16 + (code & 0xF))) * OSC1_CLOCK
    }

    fn runs(&self) -> bool {
        self.control & ENABLE != 0
    }

    /// Returns when it interrupts or bites.
    pub fn next_event(&self) -> Clocks {
        if self.runs() { self.since + self.period } else { Clocks::MAX }
    }

    /// Counts up to now; whether it resets the machine.
    pub fn advance(&mut self, now: Clocks) -> bool {
        while self.next_event() <= now {
            if self.control & INTERRUPT_FIRST == 0 || self.interrupt {
                return true;
            }
            self.interrupt = true;
            self.since += self.period;
            self.period = Self::length(self.range);
        }
        false
    }

    /// Returns the interrupt line.
    pub fn interrupt(&self) -> bool {
        self.interrupt
    }

    /// Reads a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn read(&mut self, offset: u32, now: Clocks) -> Answer<u32> {
        Ok(match offset {
            0x00 => self.control,
            0x04 => self.range,
            0x08 if self.runs() => (self.next_event().saturating_sub(now) / OSC1_CLOCK) as u32,
            0x08 => 0,
            0x10 => self.interrupt.into(),
            0x14 => std::mem::take(&mut self.interrupt).into(),
            0xFC => 0x4457_0120,
            _ => return no_register(offset),
        })
    }

    /// Writes a register.
    ///
    /// # Errors
    /// What the access lacked.
    pub fn write(&mut self, offset: u32, value: u32, now: Clocks) -> Answer<()> {
        match offset {
            0x00 => {
                if !self.runs() && value & ENABLE != 0 {
                    self.since = now;
                    self.period = Self::length(self.range >> 4);
                }
                // What runs cannot be stopped.
                self.control = value & 0x1F | self.control & ENABLE;
            }
            0x04 => self.range = value & 0xFF,
            0x0C if value & 0xFF == KICK => {
                self.since = now;
                self.period = Self::length(self.range);
                self.interrupt = false;
            }
            0x0C => return Err(format!("0x76, the word that restarts the watchdog, not {value:#x}")),
            0x08 | 0x10 | 0x14 | 0xFC => return read_only("the register"),
            _ => return no_register(offset),
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::{CPU_HERTZ, milliseconds};

    #[test]
    fn it_bites_when_nobody_kicks_it() {
        let mut watchdog = L4Watchdog::default();
        // 2^24 / 25 MHz = 0.67 s, at first and later.
        watchdog.write(0x04, 0x88, 0).unwrap();
        watchdog.write(0x00, ENABLE, 0).unwrap();
        watchdog.write(0x00, 0, 0).unwrap();
        let period = (1 << 24) * OSC1_CLOCK;
        assert!((0.67..0.68).contains(&(period as f64 / CPU_HERTZ as f64)));
        assert!(!watchdog.advance(period - 1));
        watchdog.write(0x0C, KICK, milliseconds(600)).unwrap();
        assert!(!watchdog.advance(milliseconds(600) + period - 1));
        assert!(watchdog.advance(milliseconds(600) + period));
    }

    #[test]
    fn it_interrupts_first_where_it_is_told_to() {
        let mut watchdog = L4Watchdog::default();
        watchdog.write(0x00, ENABLE | INTERRUPT_FIRST, 0).unwrap();
        let period = (1 << 16) * OSC1_CLOCK;
        assert!(!watchdog.advance(period));
        assert!(watchdog.interrupt());
        assert!(watchdog.advance(2 * period));
    }
}
