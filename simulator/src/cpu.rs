//! The processor, and the seam behind which it is emulated.

mod quick;
pub mod rsemu;

use std::fmt;
use std::sync::Arc;

use crate::bus::Bus;

/// Why the processor paused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pause {
    /// The bus' deadline has come.
    Deadline,
    /// It sleeps (WFI, WFE) until an interrupt.
    Asleep,
}

/// Where a program begins, and with what in the processor's registers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Start {
    /// The first instruction's address.
    pub entry: u32,
    /// The stack pointer.
    pub stack: u32,
    /// Base of the translation table that the MMU uses.
    pub translation_table: u32,
    /// Base of the exception vectors.
    pub vectors: u32,
    /// Whether MMU and caches are on.
    pub cached: bool,
    /// R0 and R1: how many words follow U-Boot's `go`, and where the list of their addresses is.
    pub arguments: [u32; 2],
}

/// One Cortex-A9 core on a bus.
///
/// It runs until the bus' deadline, an instruction a clock, and tells the bus the time after each.
/// It takes the bus' interrupt line. Every access, translation and cache operation goes to the bus.
pub trait Cpu {
    /// Returns a core on a bus, not yet started.
    fn new(bus: Arc<Bus>) -> Self
    where
        Self: Sized;

    /// Starts it in secure supervisor mode, interrupts masked, branch prediction on.
    fn start(&mut self, start: &Start);

    /// Runs until the deadline, or until it sleeps.
    fn run(&mut self) -> Pause;

    /// Goes on at another address.
    fn jump(&mut self, address: u32);

    /// Ends its wait for an event (WFE).
    fn wake(&mut self);

    /// Returns how many instructions it has run, exceptions taken among them.
    fn instructions(&self) -> u64;

    /// Returns the registers, for a report.
    fn registers(&self) -> Registers;

    /// Returns the instruction at an address as text; empty where it cannot be read.
    fn disassemble(&self, address: u32) -> String;
}

/// The registers of the current mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Registers {
    /// R0 to R15.
    pub general: [u32; 16],
    /// CPSR.
    pub status: u32,
}

impl fmt::Display for Registers {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, value) in self.general.iter().enumerate() {
            write!(out, "r{index:<2} {value:08x}{}", if index % 4 == 3 { "\n" } else { "  " })?;
        }
        write!(out, "cpsr {:08x}", self.status)
    }
}
