//! The instructions that programs are mostly made of, executed quickly.
//!
//! The library takes a fifth of a microsecond for an instruction, most of it around the instruction.
//! This runs straight on the registers, with instructions taken apart once and translations kept. It
//! knows what integer code is made of, in ARM state, privileged and with the MMU on. All else is the
//! library's: coprocessors, floating point, status registers, exceptions, misaligned accesses,
//! translations that fail. Nothing is half done when it is handed over, so which of the two runs an
//! instruction makes no difference; the tests of [`super::rsemu`] have both run the same ones.

mod alu;
mod decode;
mod media;
mod multiply;
mod transfer;
mod translation;

use std::collections::HashMap;

use rsemu::cpu::arm::aprofile::cp::{AccessKind, Mmu};
use rsemu::cpu::arm::aprofile::{Arm, Mode, Regs, psr};

use self::alu::{C, holds};
use self::decode::{Op, PC, What};
use self::translation::{PAGE_BYTES, Translations};
use crate::bus::{Bus, Refused};

/// Instructions in a page.
const PAGE_OPS: usize = (PAGE_BYTES / 4) as usize;
/// Interrupts come in ARM state, from a privileged mode, least byte first.
const FOREIGN: u32 = psr::T | psr::J | psr::E;

/// Why it did not go on to the next instruction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stop {
    /// The library's turn.
    Library,
    /// The bus refused an access: the run ends.
    Refused,
}

impl From<Refused> for Stop {
    fn from(_: Refused) -> Self {
        Self::Refused
    }
}

/// Where an instruction leads to.
enum Flow {
    Next,
    To(u32),
}

/// Instructions and translations that are known.
pub(super) struct Quick {
    /// Which of `pages` has a physical page's instructions.
    known: HashMap<u32, usize>,
    pages: Vec<Box<[Op; PAGE_OPS]>>,
    translations: Translations,
    /// The MMU's state that the translations are of.
    generation: Option<u32>,
}

impl Quick {
    pub(super) fn new() -> Self {
        Self { known: HashMap::new(), pages: Vec::new(), translations: Translations::default(), generation: None }
    }

    /// Runs instructions, a clock each, until the bus' deadline or one that is the library's; returns how
    /// many, and whether the deadline has come. An interrupt that stands at the core is given in `interrupt`.
    pub(super) fn run(&mut self, arm: &Arm, bus: &Bus, mmu: &dyn Mmu, interrupt: bool) -> (u64, bool) {
        let regime = mmu.regime();
        if !regime.translating || arm.state_flat_fetch() {
            return (0, false);
        }
        let mut registers = arm.regs();
        let taken = interrupt && registers.cpsr & psr::I == 0;
        if taken || registers.cpsr & FOREIGN != 0 || registers.mode() == Mode::USER {
            return (0, false);
        }
        if self.generation != Some(regime.generation) {
            self.translations = Translations::default();
            self.generation = Some(regime.generation);
        }
        let mut core = Core { registers: &mut registers, bus, mmu, translations: &mut self.translations };
        let mut count = 0;
        let mut ended = false;
        while !ended {
            let Some(page) = Self::page(&mut self.known, &mut self.pages, &mut core) else { break };
            let (done, stop) = core.run_page(&mut self.pages[page]);
            count += done;
            ended = match stop {
                None => bus.now() >= bus.deadline(),
                Some(Stop::Refused) => true,
                Some(Stop::Library) => break,
            };
        }
        if count > 0 {
            arm.set_regs(registers);
        }
        (count, ended)
    }

    /// Returns the page that the next instruction lies in.
    fn page(
        known: &mut HashMap<u32, usize>,
        pages: &mut Vec<Box<[Op; PAGE_OPS]>>,
        core: &mut Core<'_>,
    ) -> Option<usize> {
        let physical = core.physical(core.pc(), AccessKind::Fetch).ok()?;
        if !core.bus.is_code(physical) {
            return None;
        }
        Some(*known.entry(physical / PAGE_BYTES).or_insert_with(|| {
            pages.push(Box::new([Op::decode(0); PAGE_OPS]));
            pages.len() - 1
        }))
    }
}

/// The core while it runs quickly. R15 is the next instruction's address between instructions, and 8
/// more within one.
struct Core<'a> {
    registers: &'a mut Regs,
    bus: &'a Bus,
    mmu: &'a dyn Mmu,
    translations: &'a mut Translations,
}

impl Core<'_> {
    fn pc(&self) -> u32 {
        self.registers.r[15]
    }

    #[inline(always)]
    fn register(&self, number: u8) -> u32 {
        self.registers.r[number as usize & 15]
    }

    #[inline(always)]
    fn set(&mut self, number: u8, value: u32) {
        self.registers.r[number as usize & 15] = value;
    }

    /// Runs instructions of the page in which R15 is, until another page, the deadline or a stop;
    /// returns how many.
    fn run_page(&mut self, ops: &mut [Op; PAGE_OPS]) -> (u64, Option<Stop>) {
        let bus = self.bus;
        let Ok(physical) = self.physical(self.pc(), AccessKind::Fetch) else { return (0, Some(Stop::Library)) };
        let code = bus.sdram().page(physical);
        let (page, offset) = (self.pc() & !(PAGE_BYTES - 1), physical & !(PAGE_BYTES - 1));
        let mut pc = self.pc();
        let mut count = 0;
        while pc & !(PAGE_BYTES - 1) == page && pc & 3 == 0 {
            let index = (pc % PAGE_BYTES / 4) as usize;
            let Some(raw) = code.fetch(index) else { return (count, Some(Stop::Library)) };
            if ops[index].raw != raw {
                ops[index] = Op::decode(raw);
            }
            let op = &ops[index];
            let mut next = pc.wrapping_add(4);
            if holds(op.condition, self.registers.cpsr) {
                self.registers.r[15] = pc.wrapping_add(8);
                bus.set_instruction(offset | (pc % PAGE_BYTES));
                match self.execute(&op.what) {
                    Ok(Flow::Next) => {}
                    Ok(Flow::To(address)) => next = address,
                    Err(stop) => {
                        self.registers.r[15] = pc;
                        return (count, Some(stop));
                    }
                }
            }
            pc = next;
            count += 1;
            let now = bus.now() + 1;
            bus.set_now(now);
            if now >= bus.deadline() || self.registers.cpsr & FOREIGN != 0 {
                break;
            }
        }
        self.registers.r[15] = pc;
        // Where it goes on is misaligned or not in ARM state.
        let foreign = pc & 3 != 0 || self.registers.cpsr & FOREIGN != 0;
        let stop = (foreign && bus.now() < bus.deadline()).then_some(Stop::Library);
        (count, stop)
    }

    #[inline(always)]
    fn execute(&mut self, what: &What) -> Result<Flow, Stop> {
        let status = self.registers.cpsr;
        let carried = status & C != 0;
        match *what {
            What::Library => return Err(Stop::Library),
            What::Nothing => {}
            What::Barrier => self.bus.barrier(),
            What::Constant { alu, flags, rd, rn, value, carry } => {
                let a = self.register(rn);
                return self.data(alu, flags, rd, a, value, carry.unwrap_or(carried));
            }
            What::Register { alu, flags, rd, rn, shifted } => {
                let (b, carry) = shifted.value(&self.registers.r, carried);
                let a = self.register(rn);
                return self.data(alu, flags, rd, a, b, carry);
            }
            What::ByRegister { alu, flags, rd, rn, rm, rs, shift } => {
                let (b, carry) = shift.by_register(self.register(rm), self.register(rs), carried);
                let a = self.register(rn);
                return self.data(alu, flags, rd, a, b, carry);
            }
            What::MoveWide { rd, value } => self.set(rd, value),
            What::MoveTop { rd, value } => self.set(rd, self.register(rd) & 0xFFFF | value),
            What::Multiply { multiply, flags, rd, ra, rm, rn } => {
                let result =
                    multiply.compute(self.register(rn), self.register(rm), self.register(rd), self.register(ra));
                if multiply.is_long() {
                    self.set(ra, result as u32);
                    self.set(rd, (result >> 32) as u32);
                } else {
                    self.set(rd, result as u32);
                }
                if flags {
                    self.registers.cpsr = multiply.flags(status, result);
                }
            }
            What::Media { media, rd, rn, rm } => {
                let result = media.compute(&self.registers.r, self.register(rd), rn, rm);
                self.set(rd, result);
            }
            What::Branch { link, offset } => {
                let target = self.pc().wrapping_add(offset as u32);
                if link {
                    self.set(14, self.pc().wrapping_sub(4));
                }
                return Ok(Flow::To(target));
            }
            What::Exchange { link, rm } => {
                let target = self.register(rm);
                if link {
                    self.set(14, self.pc().wrapping_sub(4));
                }
                return Ok(self.exchange(target));
            }
            What::Transfer { transfer, offset } => return self.transfer(transfer, offset as u32),
            What::TransferByRegister { transfer, shifted, subtract } => {
                let (offset, _) = shifted.value(&self.registers.r, carried);
                return self.transfer(transfer, if subtract { offset.wrapping_neg() } else { offset });
            }
            What::Block(block) => return self.block(block),
        }
        Ok(Flow::Next)
    }

    #[inline(always)]
    fn data(&mut self, alu: alu::Alu, flags: bool, rd: u8, a: u32, b: u32, carry: bool) -> Result<Flow, Stop> {
        let (result, status) = alu.compute(a, b, carry, self.registers.cpsr);
        if rd == PC && !alu.tests() {
            // Interworking, and misaligned targets, are the library's.
            return if result & 3 == 0 { Ok(Flow::To(result)) } else { Err(Stop::Library) };
        }
        if flags {
            self.registers.cpsr = status;
        }
        if !alu.tests() {
            self.set(rd, result);
        }
        Ok(Flow::Next)
    }

    /// Goes on at an address whose lowest bit says whether there is Thumb code (A2.3.1).
    #[inline(always)]
    fn exchange(&mut self, target: u32) -> Flow {
        if target & 1 != 0 {
            self.registers.cpsr |= psr::T;
        }
        Flow::To(target & !1)
    }
}
