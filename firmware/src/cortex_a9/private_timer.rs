//! This core's private timer: 32 bits, counting down (ARM DDI 0407, §4.2).

use crate::mmio::{Register, Registers};

const ENABLE: u32 = 1 << 0;
const AUTO_RELOAD: u32 = 1 << 1;
const INTERRUPT_ENABLE: u32 = 1 << 2;

#[derive(Clone, Copy)]
enum Offset {
    Load = 0x0,
    Counter = 0x4,
    Control = 0x8,
    InterruptStatus = 0xC,
}

impl Register for Offset {
    fn offset(self) -> usize {
        self as usize
    }
}

/// The private timer, either a periodic interrupt or a stopwatch.
pub struct PrivateTimer {
    registers: Registers<Offset>,
    hertz: u32,
}

impl PrivateTimer {
    /// Returns the driver of the timer at `address`, which counts `hertz` times a second.
    ///
    /// # Safety
    /// A Cortex-A9 private timer answers at `address`, and no other driver writes to it, but for
    /// one [`TimerInterrupt`].
    #[must_use]
    pub const unsafe fn at(address: usize, hertz: u32) -> Self {
        // SAFETY: the caller's promise is the same.
        Self { registers: unsafe { Registers::at(address) }, hertz }
    }

    /// Returns the part that an interrupt handler holds.
    #[must_use]
    pub fn interrupt(&self) -> TimerInterrupt {
        TimerInterrupt { registers: self.registers }
    }

    /// Raises an interrupt `per_second` times a second (at least 1; rounded to the timer's ticks).
    pub fn start_periodic(&mut self, per_second: u32) {
        let period = (self.hertz / per_second.max(1)).max(1);
        self.stop();
        self.registers.write(Offset::Load, period - 1);
        self.registers.write(Offset::Control, ENABLE | AUTO_RELOAD | INTERRUPT_ENABLE);
    }

    /// Starts a stopwatch that raises no interrupt and wraps after 2³² ticks.
    pub fn start_stopwatch(&mut self) {
        self.stop();
        self.registers.write(Offset::Load, u32::MAX);
        self.registers.write(Offset::Control, ENABLE | AUTO_RELOAD);
    }

    /// Returns the ticks since [`start_stopwatch`](Self::start_stopwatch).
    #[must_use]
    pub fn elapsed_ticks(&self) -> u32 {
        u32::MAX - self.registers.read(Offset::Counter)
    }

    /// Stops the timer and drops its pending interrupt.
    pub fn stop(&mut self) {
        self.registers.write(Offset::Control, 0);
        self.registers.write(Offset::InterruptStatus, 1);
    }

    /// Returns how many ticks make a second.
    #[must_use]
    pub fn hertz(&self) -> u32 {
        self.hertz
    }
}

/// The private timer's side in the interrupt handler.
pub struct TimerInterrupt {
    registers: Registers<Offset>,
}

impl TimerInterrupt {
    /// Drops the pending interrupt.
    pub fn acknowledge(&mut self) {
        self.registers.write(Offset::InterruptStatus, 1);
    }
}
