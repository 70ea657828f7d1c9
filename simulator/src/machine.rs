//! The whole board.

mod power_on;
mod uboot;

use std::sync::Arc;

pub use power_on::PowerOn;
use uboot::Go;

use crate::bus::Bus;
use crate::cache::Counts;
use crate::cpu::rsemu::Interpreter;
use crate::cpu::{Cpu, Pause, Registers};
use crate::devices::{Hardware, ResetCause};
use crate::fpga::{Fpga, Screen};
use crate::image::{Image, LOAD_ADDRESS};
use crate::time::{Clocks, milliseconds};
use crate::violation::Violation;

/// A place behind the program, where code may lie, for a loop that does nothing.
const TRAP: u32 = LOAD_ADDRESS + 0x00FF_FF00;
/// `wfi`, `b .-4`
const LOOP: [u32; 2] = [0xE320_F003, 0xEAFF_FFFD];
/// Longest time that a screen takes to be scanned out.
const SCAN_OUT: Clocks = milliseconds(50);

/// Why a run paused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Event {
    /// The time is over.
    Limit,
    /// The condition holds.
    Met,
    /// The processor was reset; U-Boot has started the program again, and the next run goes on there.
    Reset(ResetCause),
}

/// The DE1-SoC, with a program on its card.
pub struct Machine {
    bus: Arc<Bus>,
    cpu: Interpreter,
    card: Image,
    go: Go,
    console: Vec<u8>,
}

impl Machine {
    /// Runs until a condition holds, for at most `limit` of virtual time. The condition is asked
    /// after whatever happens outside of the processor.
    ///
    /// # Errors
    /// [`Violation`] when the program did what would not work on the board.
    pub fn run_until(&mut self, limit: Clocks, mut met: impl FnMut(&Self) -> bool) -> Result<Event, Violation> {
        let end = self.now().saturating_add(limit);
        loop {
            let now = self.now();
            let (reset, hung) = self.attend(now, end);
            if let Some(violation) = self.bus.take_violation() {
                return Err(Violation { disassembly: self.cpu.disassemble(violation.instruction), ..violation });
            }
            if let Some(cause) = reset {
                self.restart(cause);
                return Ok(Event::Reset(cause));
            }
            if met(self) {
                return Ok(Event::Met);
            }
            if now >= end {
                return Ok(Event::Limit);
            }
            if hung || self.cpu.run() == Pause::Asleep {
                let until = self.bus.hardware().next_event(self.now()).min(end);
                self.bus.set_now(until.max(self.now()));
            }
        }
    }

    /// Brings everything but the processor up to now; returns the reset that is due, and whether
    /// the processor waits for ever.
    fn attend(&mut self, now: Clocks, end: Clocks) -> (Option<ResetCause>, bool) {
        let mut hardware = self.bus.hardware();
        hardware.advance(now, &self.bus);
        self.bus.set_interrupt(hardware.interrupt());
        self.bus.set_deadline(hardware.next_event(now).min(end));
        self.console.extend(hardware.uart0.take_sent());
        (hardware.take_reset(), hardware.hung())
    }

    /// Runs for a time.
    ///
    /// # Errors
    /// As [`run_until`](Self::run_until).
    pub fn run(&mut self, time: Clocks) -> Result<Event, Violation> {
        self.run_until(time, |_| false)
    }

    /// Runs until so many frames were shown since power-on.
    ///
    /// # Errors
    /// As [`run_until`](Self::run_until).
    pub fn run_until_frame(&mut self, limit: Clocks, frames: u64) -> Result<Event, Violation> {
        self.run_until(limit, |machine| machine.frames_shown() >= frames)
    }

    fn restart(&mut self, cause: ResetCause) {
        self.bus.restart(cause);
        self.cpu = Interpreter::new(Arc::clone(&self.bus));
        self.load();
    }

    /// What boot ROM and U-Boot do.
    fn load(&mut self) {
        for (address, bytes) in &self.card.parts {
            self.bus.sdram().load(*address, bytes);
        }
        uboot::write_translation_table(self.bus.sdram());
        if self.go.caches_off {
            self.bus.caches.flush_loader();
        }
        self.cpu.start(&uboot::start(LOAD_ADDRESS, self.bus.sdram(), &self.go));
    }

    /// Makes the program hang: the processor sleeps in a circle, and serves interrupts.
    pub fn hang(&mut self) {
        for (place, word) in (TRAP..).step_by(4).zip(LOOP) {
            self.bus.sdram().set_word(place, word);
        }
        self.jump(TRAP);
    }

    /// Makes the program go on at another address, as a stray pointer does.
    pub fn jump(&mut self, address: u32) {
        self.cpu.jump(address);
    }

    /// Returns what the console's line has carried since power-on.
    pub fn console(&self) -> &[u8] {
        &self.console
    }

    /// Returns the console's line as text.
    pub fn console_text(&self) -> String {
        String::from_utf8_lossy(&self.console).into_owned()
    }

    /// Sends bytes to the board over the console's line.
    pub fn send(&mut self, bytes: &[u8]) {
        let now = self.now();
        self.bus.hardware().uart0.feed(bytes, now);
    }

    /// Returns the time since power-on.
    pub fn now(&self) -> Clocks {
        self.bus.now()
    }

    /// Returns how many frames were shown since power-on.
    pub fn frames_shown(&self) -> u64 {
        self.bus.hardware().fpga.frames_shown()
    }

    /// Runs until what shows now has been scanned out as a whole, and returns that screen.
    ///
    /// # Errors
    /// As [`run_until`](Self::run_until).
    pub fn screen(&mut self) -> Result<Option<Screen>, Violation> {
        let end = self.now() + SCAN_OUT;
        loop {
            let whole = self.bus.hardware().fpga.scanned_out(self.now()).min(end);
            if whole <= self.now() {
                break;
            }
            self.run(whole - self.now())?;
        }
        Ok(self.bus.hardware().fpga.screen())
    }

    /// Lends everything that is not memory: to look at, to press keys, to break.
    pub fn hardware<R>(&self, work: impl FnOnce(&mut Hardware) -> R) -> R {
        work(&mut self.bus.hardware())
    }

    /// Configures the FPGA from outside, as over JTAG, or takes its power.
    pub fn set_fpga_configured(&mut self, configured: bool) {
        let mut hardware = self.bus.hardware();
        hardware.fpga_manager.set_configured(configured);
        hardware.design_starts(self.now());
    }

    /// Returns bytes of the SDRAM.
    pub fn memory(&self, address: u32, count: usize) -> Vec<u8> {
        self.bus.sdram().bytes(address, count)
    }

    /// Reads memory as a bus master does.
    ///
    /// # Errors
    /// [`Violation`] when the caches may hold something newer.
    pub fn dma_read(&mut self, address: u32, count: usize) -> Result<Vec<u8>, Violation> {
        let mut bytes = vec![0; count];
        // A refusal leaves its reason with the bus.
        let _ = self.bus.dma_read(address, &mut bytes);
        self.bus.take_violation().map_or(Ok(bytes), Err)
    }

    /// Writes memory as a bus master does.
    ///
    /// # Errors
    /// [`Violation`] when the caches may write something back over it.
    pub fn dma_write(&mut self, address: u32, bytes: &[u8]) -> Result<(), Violation> {
        // A refusal leaves its reason with the bus.
        let _ = self.bus.dma_write(address, bytes);
        self.bus.take_violation().map_or(Ok(()), Err)
    }

    /// Ends the processor's wait for an event.
    pub fn wake(&mut self) {
        self.cpu.wake();
    }

    /// Returns how often caches were maintained and bus masters were at work.
    pub fn cache_counts(&self) -> Counts {
        self.bus.caches.counts()
    }

    /// Returns how many instructions the processor has run since it was started last.
    pub fn instructions(&self) -> u64 {
        self.cpu.instructions()
    }

    /// Returns the processor's registers.
    pub fn registers(&self) -> Registers {
        self.cpu.registers()
    }
}
