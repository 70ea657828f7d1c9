//! A design that can be made to fail.

use fpga_regs::registers::{Control, Errors, Register, Status};

use super::{Fpga, Screen};
use crate::time::{Clocks, milliseconds};

/// For how long a word waits at a full FIFO before it is dropped: 2²² clocks of 50 MHz.
const PATIENCE: Clocks = milliseconds(84);

/// What is wrong with a design.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Faults {
    /// ID reads this.
    pub id: Option<u32>,
    /// VERSION reads this.
    pub version: Option<u32>,
    /// No word leaves the FIFO any more.
    pub fifo_stuck: bool,
    /// No access is ever answered.
    pub hangs: bool,
    /// The interrupt never rises.
    pub interrupt_lost: bool,
}

/// A design behind its faults.
pub struct Faulty {
    inner: Box<dyn Fpga + Send>,
    /// What is wrong with it now.
    pub faults: Faults,
    /// Words that are stuck.
    stuck: u16,
    overflow: bool,
}

impl Faulty {
    /// Returns a design without a fault.
    pub fn new(inner: Box<dyn Fpga + Send>) -> Self {
        Self { inner, faults: Faults::default(), stuck: 0, overflow: false }
    }
}

impl Fpga for Faulty {
    fn read(&mut self, offset: u32, now: Clocks) -> u32 {
        let value = self.inner.read(offset, now);
        match Register::at(offset as usize) {
            Some(Register::Id) => self.faults.id.unwrap_or(value),
            Some(Register::Version) => self.faults.version.unwrap_or(value),
            Some(Register::Status) if self.stuck > 0 => {
                let status = Status(value);
                let free = status.fifo_free().saturating_sub(self.stuck);
                status.with_fifo_free(free).with_busy(true).with_error(status.error() || self.overflow).0
            }
            Some(Register::Errors) if self.overflow => Errors(value).with_fifo_overflow(true).0,
            _ => value,
        }
    }

    fn write(&mut self, offset: u32, value: u32, now: Clocks) {
        match Register::at(offset as usize) {
            Some(Register::Control) if Control(value).reset() => (self.stuck, self.overflow) = (0, false),
            Some(Register::Errors) => self.overflow &= !Errors(value).fifo_overflow(),
            _ => {}
        }
        self.inner.write(offset, value, now);
    }

    fn push(&mut self, word: u32, now: Clocks) -> Clocks {
        if !self.faults.fifo_stuck {
            return self.inner.push(word, now);
        }
        let free = Status(self.inner.read(Register::Status as u32, now)).fifo_free();
        if self.stuck < free {
            self.stuck += 1;
            return 0;
        }
        // After the first the others are dropped at once, until there is space again.
        if std::mem::replace(&mut self.overflow, true) { 0 } else { PATIENCE }
    }

    fn advance(&mut self, now: Clocks) {
        self.inner.advance(now);
    }

    fn next_event(&self, now: Clocks) -> Clocks {
        self.inner.next_event(now)
    }

    fn interrupt(&self) -> bool {
        self.inner.interrupt() && !self.faults.interrupt_lost
    }

    fn frames_shown(&self) -> u64 {
        self.inner.frames_shown()
    }

    fn screen(&mut self) -> Option<Screen> {
        self.inner.screen()
    }

    fn scanned_out(&mut self, now: Clocks) -> Clocks {
        self.inner.scanned_out(now)
    }

    fn reset(&mut self, now: Clocks) {
        (self.stuck, self.overflow) = (0, false);
        self.inner.reset(now);
    }
}
