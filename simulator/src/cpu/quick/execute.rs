//! What instructions do to the registers.

use rsemu::cpu::arm::aprofile::psr;

use super::alu::{Alu, C};
use super::op::{PC, What};
use super::{Core, Flow, Stop};

impl Core<'_> {
    #[inline(always)]
    pub(super) fn execute(&mut self, what: &What) -> Result<Flow, Stop> {
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
            What::Address { rd, offset } => self.set(rd, (self.pc() & !3).wrapping_add(offset as u32)),
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
                    self.set(14, self.link);
                }
                return Ok(Flow::To(target));
            }
            What::Exchange { link, rm } => {
                let target = self.register(rm);
                if link {
                    self.set(14, self.link);
                }
                return Ok(self.exchange(target));
            }
            What::CallOther { offset } => {
                let thumb = self.registers.cpsr & psr::T != 0;
                let target = (self.pc() & !3).wrapping_add(offset as u32);
                self.set(14, self.link);
                return Ok(self.exchange(if thumb { target & !3 } else { target | 1 }));
            }
            What::CompareBranch { nonzero, rn, offset } => {
                if (self.register(rn) == 0) != nonzero {
                    return Ok(Flow::To(self.pc().wrapping_add(offset.into())));
                }
            }
            What::TableBranch { half, rn, rm } => return self.table_branch(half, rn, rm),
            What::IfThen { state } => self.set_block_state(state),
            What::Transfer { transfer, offset } => return self.transfer(transfer, offset as u32),
            What::TransferByRegister { transfer, shifted, subtract } => {
                let (offset, _) = shifted.value(&self.registers.r, carried);
                return self.transfer(transfer, if subtract { offset.wrapping_neg() } else { offset });
            }
            What::Pair { transfer, second, offset } => return self.pair(transfer, second, offset as u32),
            What::Block(block) => return self.block(block),
        }
        Ok(Flow::Next)
    }

    #[inline(always)]
    fn data(&mut self, alu: Alu, flags: bool, rd: u8, a: u32, b: u32, carry: bool) -> Result<Flow, Stop> {
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
    pub(super) fn exchange(&mut self, target: u32) -> Flow {
        self.registers.cpsr =
            if target & 1 != 0 { self.registers.cpsr | psr::T } else { self.registers.cpsr & !psr::T };
        Flow::To(target & !1)
    }
}
