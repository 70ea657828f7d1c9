//! The instructions that programs are mostly made of, executed quickly.
//!
//! The library takes a fifth of a microsecond for an instruction, most of it around the instruction.
//! This runs straight on the registers, with instructions taken apart once and translations kept. It
//! knows what integer code is made of, ARM's and Thumb's, privileged and with the MMU on. All else is the
//! library's: coprocessors, floating point, status registers, exceptions, misaligned accesses,
//! translations that fail. Nothing is half done when it is handed over, so which of the two runs an
//! instruction makes no difference; the tests of [`super::rsemu`] have both run the same ones.

mod alu;
mod decode;
mod execute;
mod media;
mod multiply;
mod op;
mod thumb;
mod transfer;
mod translation;

use std::collections::HashMap;

use rsemu::cpu::arm::aprofile::cp::{AccessKind, Mmu};
use rsemu::cpu::arm::aprofile::{Arm, Mode, Regs, psr};

use self::alu::holds;
use self::decode::key;
use self::op::{ALWAYS, Op};
use self::translation::{PAGE_BYTES, Translations};
use crate::bus::{Bus, Refused};

/// Instructions in a page, at most.
const PAGE_OPS: usize = (PAGE_BYTES / 2) as usize;
/// States of the core that only the library knows: Jazelle, most significant byte first.
const FOREIGN: u32 = psr::J | psr::E;
/// The conditions of a block in Thumb code, in two pieces: bits 7 to 2, and 1 and 0.
const BLOCK: u32 = 0x0600_FC00;

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
        let mut core = Core { registers: &mut registers, bus, mmu, translations: &mut self.translations, link: 0 };
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
/// more within one, or 4 in Thumb code.
struct Core<'a> {
    registers: &'a mut Regs,
    bus: &'a Bus,
    mmu: &'a dyn Mmu,
    translations: &'a mut Translations,
    /// Where a call comes back to, with the instruction set in its lowest bit.
    link: u32,
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
        let mut stop = None;
        while pc & !(PAGE_BYTES - 1) == page {
            let place = pc % PAGE_BYTES;
            let thumb = self.registers.cpsr & psr::T != 0;
            let block = if thumb { self.block_state() } else { 0 };
            let word = if thumb { code.fetch_thumb(place) } else { code.fetch(place) };
            let Some(word) = word else {
                stop = Some(Stop::Library);
                break;
            };
            let key = key(word, thumb, block != 0);
            let op = &mut ops[(place / 2) as usize];
            if op.key != key {
                *op = Op::decode(key);
            }
            let op = &*op;
            let after = pc.wrapping_add(op.bytes.into());
            let condition = if block == 0 { op.condition } else { (block >> 4).min(ALWAYS) };
            let mut next = after;
            if holds(condition, self.registers.cpsr) {
                self.registers.r[15] = pc.wrapping_add(if thumb { 4 } else { 8 });
                self.link = after | u32::from(thumb);
                bus.set_instruction(offset | place);
                match self.execute(&op.what) {
                    Ok(Flow::Next) => {}
                    Ok(Flow::To(address)) => next = address,
                    Err(reason) => {
                        stop = Some(reason);
                        break;
                    }
                }
            }
            if block != 0 {
                self.set_block_state(if block & 7 == 0 { 0 } else { block & 0xE0 | block << 1 & 0x1F });
            }
            pc = next;
            count += 1;
            let now = bus.now() + 1;
            bus.set_now(now);
            if now >= bus.deadline() {
                break;
            }
        }
        self.registers.r[15] = pc;
        (count, stop)
    }

    /// Returns the conditions of a block's instructions to come: the next one's in the upper half; 0 outside of a block.
    #[inline(always)]
    fn block_state(&self) -> u8 {
        let status = self.registers.cpsr & BLOCK;
        (status >> 8 & 0xFC | status >> 25) as u8
    }

    fn set_block_state(&mut self, state: u8) {
        let state = u32::from(state);
        self.registers.cpsr = self.registers.cpsr & !BLOCK | (state & 0xFC) << 8 | (state & 3) << 25;
    }
}
