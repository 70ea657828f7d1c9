//! The whole board.

mod uboot;

use std::sync::Arc;

use crate::bus::Bus;
use crate::cpu::rsemu::Interpreter;
use crate::cpu::{Cpu, Pause, Registers};
use crate::devices::fpga_manager::FpgaManager;
use crate::devices::{Hardware, ResetCause};
use crate::image::{Image, LOAD_ADDRESS};
use crate::time::Clocks;
use crate::violation::Violation;

/// What a machine is made with.
#[derive(Debug, Clone, Copy)]
pub struct Config {
    /// Whether the FPGA is configured when the program starts.
    pub fpga_configured: bool,
    /// How the MSEL switch stands: 0b01010 lets the processor configure the FPGA.
    pub msel: u32,
}

impl Default for Config {
    fn default() -> Self {
        Self { fpga_configured: true, msel: 0b01010 }
    }
}

/// Why a run paused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Event {
    /// The time is over.
    Limit,
    /// The condition holds.
    Met,
    /// The processor was reset; the next run starts the program again.
    Reset(ResetCause),
}

/// The DE1-SoC, with a program on its card.
pub struct Machine {
    bus: Arc<Bus>,
    cpu: Interpreter,
    console: Vec<u8>,
}

impl Machine {
    /// Returns the board after power-on, about to start the program.
    pub fn new(image: Image, config: &Config) -> Self {
        let fpga_manager = FpgaManager::new(config.fpga_configured, config.msel);
        let bus = Arc::new(Bus::new(Hardware::as_uboot_leaves_it(None, fpga_manager)));
        let mut cpu = Interpreter::new(Arc::clone(&bus));
        for (address, bytes) in &image.parts {
            bus.sdram().load(*address, bytes);
        }
        uboot::write_translation_table(bus.sdram());
        cpu.start(&uboot::start(LOAD_ADDRESS));
        Self { bus, cpu, console: Vec::new() }
    }

    /// Runs until a condition holds, for at most `limit` of virtual time. The condition is asked
    /// after whatever happens outside of the processor.
    ///
    /// # Errors
    /// [`Violation`] when the program did what would not work on the board.
    pub fn run_until(&mut self, limit: Clocks, mut met: impl FnMut(&Self) -> bool) -> Result<Event, Violation> {
        let end = self.bus.now().saturating_add(limit);
        loop {
            let now = self.bus.now();
            let reset = {
                let mut hardware = self.bus.hardware();
                hardware.advance(now);
                self.bus.set_interrupt(hardware.interrupt());
                self.bus.set_deadline(hardware.next_event(now).min(end));
                self.console.extend(hardware.uart0.take_sent());
                hardware.take_reset()
            };
            if let Some(violation) = self.bus.take_violation() {
                return Err(Violation { disassembly: self.cpu.disassemble(violation.instruction), ..violation });
            }
            if let Some(cause) = reset {
                return Ok(Event::Reset(cause));
            }
            if met(self) {
                return Ok(Event::Met);
            }
            if now >= end {
                return Ok(Event::Limit);
            }
            if self.cpu.run() == Pause::Asleep {
                let until = self.bus.hardware().next_event(self.bus.now()).min(end);
                self.bus.set_now(until.max(self.bus.now()));
            }
        }
    }

    /// Returns what the console's line has carried so far.
    pub fn console(&self) -> &[u8] {
        &self.console
    }

    /// Returns the time since power-on.
    pub fn now(&self) -> Clocks {
        self.bus.now()
    }

    /// Returns the processor's registers.
    pub fn registers(&self) -> Registers {
        self.cpu.registers()
    }
}
