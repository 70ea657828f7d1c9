//! A Cortex-A9 by the crate `rsemu`: an interpreter in Rust.
//!
//! It does what the architecture asks and Unicorn leaves out: alignment faults, aborts and
//! interrupts taken by the core itself. Not modelled: caches ([`crate::cache`] stands in), NEON (the
//! target builds without), cycle counters.

mod system_control;
#[cfg(test)]
mod tests;

use std::fmt;
use std::sync::Arc;

use rsemu::core::error::BusError;
use rsemu::core::space::{AccessConstraints, AddressSpace, MemAttrs, MemOps, MemResult, Region};
use rsemu::cpu::arm::aprofile::{Arm, Config, psr};

use super::quick::Quick;
use super::{Cpu, Pause, Registers, Start};
use crate::bus::{Bus, Refused};
use system_control::SystemControl;

/// The whole address space as one region of the library's.
struct Window(Arc<Bus>);

impl fmt::Debug for Window {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str("Window")
    }
}

impl MemOps for Window {
    fn read(&self, offset: u64, bytes: &mut [u8], attributes: MemAttrs) -> MemResult {
        let (address, count) = (offset as u32, bytes.len() as u32);
        let value = if attributes.debug {
            self.0.sdram().contains(address).then(|| self.0.sdram().read(address, count)).ok_or(Refused)
        } else if attributes.is_fetch() {
            self.0.fetch(address, count)
        } else {
            self.0.read(address, count)
        };
        let value = value.map_err(|Refused| BusError::BadAccess)?.to_le_bytes();
        bytes.copy_from_slice(&value[..bytes.len()]);
        Ok(())
    }

    fn write(&self, offset: u64, bytes: &[u8], _: MemAttrs) -> MemResult {
        let mut value = [0; 4];
        value[..bytes.len()].copy_from_slice(bytes);
        let value = u32::from_le_bytes(value);
        self.0.write(offset as u32, bytes.len() as u32, value).map_err(|Refused| BusError::BadAccess)
    }

    fn constraints(&self) -> AccessConstraints {
        AccessConstraints::IO
    }
}

/// The core.
pub struct Interpreter {
    arm: Arm,
    bus: Arc<Bus>,
    system: Arc<SystemControl>,
    quick: Quick,
    instructions: u64,
}

impl Cpu for Interpreter {
    fn new(bus: Arc<Bus>) -> Self {
        let config = Config { periphbase: 0xFFFE_C000, ..Config::CORTEX_A9 };
        let arm = Arm::new(config);
        let space = AddressSpace::new("cpu", 32);
        space
            .topology()
            .map(Region::io("board", 1 << 32, Arc::new(Window(Arc::clone(&bus)))), 0)
            .expect("one region fits an empty address space");
        arm.attach_space(Arc::new(space));
        let inner = Arc::clone(arm.cp15v7().expect("the configuration is a Cortex-A9's"));
        let system = Arc::new(SystemControl::new(inner, Arc::clone(&bus)));
        arm.attach_mmu(system.clone());
        arm.attach_coprocessor(15, system.clone());
        // The reset sequence.
        arm.step();
        Self { arm, bus, system, quick: Quick::new(), instructions: 0 }
    }

    fn start(&mut self, start: &Start) {
        self.system.as_uboot_leaves_it(start);
        self.arm.set_cpsr(0x13 | psr::I | psr::F | psr::A);
        self.arm.set_reg(13, start.stack);
        // U-Boot's `go` calls entry(argc, argv); it would come back to here.
        for (register, value) in (0..).zip(start.arguments) {
            self.arm.set_reg(register, value);
        }
        self.arm.set_reg(14, start.vectors);
        self.arm.set_pc(start.entry);
    }

    fn run(&mut self) -> Pause {
        let Self { arm, bus, system, quick, instructions } = self;
        let interrupt = bus.interrupt();
        arm.set_irq(interrupt);
        let asleep = || arm.is_halted() && !bus.interrupt();
        if asleep() {
            return Pause::Asleep;
        }
        // An instruction that sleeps, and the interrupt that ends it, are the library's.
        let mut wakes = arm.is_halted();
        loop {
            if !std::mem::take(&mut wakes) {
                let (count, ended) = quick.run(arm, bus, system.as_ref(), interrupt);
                *instructions += count;
                if ended {
                    return Pause::Deadline;
                }
            }
            arm.step();
            *instructions += 1;
            let now = bus.now() + 1;
            bus.set_now(now);
            if now < bus.deadline() {
                continue;
            }
            return if asleep() { Pause::Asleep } else { Pause::Deadline };
        }
    }

    fn jump(&mut self, address: u32) {
        self.arm.set_pc(address);
    }

    fn wake(&mut self) {
        self.arm.send_event();
        self.arm.step();
    }

    fn instructions(&self) -> u64 {
        self.instructions
    }

    fn registers(&self) -> Registers {
        let registers = self.arm.regs();
        Registers { general: registers.r, status: registers.cpsr }
    }

    fn disassemble(&self, address: u32) -> String {
        let listed = self.arm.disassemble_virtual(address, 1, false).first().map(|line| line.to_string());
        // The library puts address and code before the instruction.
        listed.and_then(|line| Some(line.split_once("  ")?.1.to_string())).unwrap_or_default()
    }
}
