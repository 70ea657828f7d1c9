//! Thumb's short instructions. Outside of a block with conditions most of them set flags.

use rsemu::cpu::arm::aprofile::isa::ShiftType;
use rsemu::cpu::arm::aprofile::thumb::{self, AluOp, HiOp, ImmOp, MemRegOp, MemSize, SmallOperand, Thumb};

use super::alu::{Alu, Shift, Shifted};
use super::decode::{ARCHITECTURE, what};
use super::multiply::Multiply;
use super::op::{ALWAYS, Block, Index, PC, Size, Transfer, What};

const STACK: u8 = 13;

/// Returns an instruction's own condition, and what it does.
pub(super) fn short(word: u16, in_block: bool) -> (u8, What) {
    let insn = thumb::decode_for(&ARCHITECTURE, word);
    match insn {
        Thumb::BranchCond { cond, offset } if !in_block => (cond.0, What::Branch { link: false, offset }),
        _ => (ALWAYS, unconditional(insn, !in_block)),
    }
}

fn unconditional(insn: Thumb, flags: bool) -> What {
    let by_constant = |alu, flags, rd, rn, value| What::Constant { alu, flags, rd, rn, value, carry: None };
    match insn {
        Thumb::ShiftImm { ty, rd, rm, imm } => {
            What::Register { alu: Alu::Mov, flags, rd, rn: 0, shifted: Shifted::new(rm, ty, imm) }
        }
        Thumb::AddSub { sub, rd, rn, operand } => {
            let alu = if sub { Alu::Sub } else { Alu::Add };
            match operand {
                SmallOperand::Reg(rm) => What::Register { alu, flags, rd, rn, shifted: Shifted::plain(rm) },
                SmallOperand::Imm(value) => by_constant(alu, flags, rd, rn, value.into()),
            }
        }
        Thumb::AluImm { op, rd, imm } => match op {
            ImmOp::Mov => by_constant(Alu::Mov, flags, rd, 0, imm.into()),
            ImmOp::Cmp => by_constant(Alu::Cmp, true, 0, rd, imm.into()),
            ImmOp::Add => by_constant(Alu::Add, flags, rd, rd, imm.into()),
            ImmOp::Sub => by_constant(Alu::Sub, flags, rd, rd, imm.into()),
        },
        Thumb::Alu { op, rd, rm } => two_registers(op, flags, rd, rm),
        Thumb::HiReg { rd: PC, .. } | Thumb::HiReg { rm: PC, .. } => What::Library,
        Thumb::HiReg { op, rd, rm } => {
            let (alu, flags) = match op {
                HiOp::Add => (Alu::Add, false),
                HiOp::Cmp => (Alu::Cmp, true),
                HiOp::Mov => (Alu::Mov, false),
            };
            What::Register { alu, flags, rd, rn: rd, shifted: Shifted::plain(rm) }
        }
        Thumb::BranchExchange { link, rm } if rm != PC => What::Exchange { link, rm },
        Thumb::LoadLiteral { rd, imm } => by_offset(true, Size::Word, rd, PC, 4 * i32::from(imm)),
        Thumb::MemReg { op, rd, rn, rm } => {
            let (load, size) = match op {
                MemRegOp::Str => (false, Size::Word),
                MemRegOp::Strh => (false, Size::Half),
                MemRegOp::Strb => (false, Size::Byte),
                MemRegOp::Ldrsb => (true, Size::SignedByte),
                MemRegOp::Ldr => (true, Size::Word),
                MemRegOp::Ldrh => (true, Size::Half),
                MemRegOp::Ldrb => (true, Size::Byte),
                MemRegOp::Ldrsh => (true, Size::SignedHalf),
            };
            let transfer = Transfer { load, size, index: Index::Offset, rd, rn };
            What::TransferByRegister { transfer, shifted: Shifted::plain(rm), subtract: false }
        }
        Thumb::MemImm { load, size, rd, rn, imm } => {
            let (size, bytes) = match size {
                MemSize::Byte => (Size::Byte, 1),
                MemSize::Half => (Size::Half, 2),
                MemSize::Word => (Size::Word, 4),
            };
            by_offset(load, size, rd, rn, bytes * i32::from(imm))
        }
        Thumb::MemStack { load, rd, imm } => by_offset(load, Size::Word, rd, STACK, 4 * i32::from(imm)),
        Thumb::AddPcSp { sp: true, rd, imm } => by_constant(Alu::Add, false, rd, STACK, 4 * u32::from(imm)),
        Thumb::AddPcSp { sp: false, rd, imm } => What::Address { rd, offset: 4 * i32::from(imm) },
        Thumb::AdjustStack { sub, imm } => {
            by_constant(if sub { Alu::Sub } else { Alu::Add }, false, STACK, STACK, 4 * u32::from(imm))
        }
        Thumb::PushPop { load, extra, list } => {
            let more = if load { 1 << PC } else { 1 << 14 };
            let list = u16::from(list) | if extra { more } else { 0 };
            block(Block { load, before: !load, up: load, writeback: true, rn: STACK, list })
        }
        Thumb::BlockTransfer { load, rn, list } => {
            block(Block { load, before: false, up: true, writeback: true, rn, list: list.into() })
        }
        Thumb::Branch { offset } => What::Branch { link: false, offset },
        Thumb::CompareBranch { nonzero, rn, offset } => What::CompareBranch { nonzero, rn, offset },
        Thumb::It { firstcond, mask } if flags => What::IfThen { state: firstcond << 4 | mask },
        Thumb::Common(insn) => what(insn, true),
        _ => What::Library,
    }
}

fn by_offset(load: bool, size: Size, rd: u8, rn: u8, offset: i32) -> What {
    What::Transfer { transfer: Transfer { load, size, index: Index::Offset, rd, rn }, offset }
}

fn block(block: Block) -> What {
    if block.is_sound() { What::Block(block) } else { What::Library }
}

fn two_registers(op: AluOp, flags: bool, rd: u8, rm: u8) -> What {
    let data = |alu, flags| What::Register { alu, flags, rd, rn: rd, shifted: Shifted::plain(rm) };
    let shift = |ty| What::ByRegister { alu: Alu::Mov, flags, rd, rn: 0, rm: rd, rs: rm, shift: Shift::of(ty) };
    match op {
        AluOp::And => data(Alu::And, flags),
        AluOp::Eor => data(Alu::Eor, flags),
        AluOp::Adc => data(Alu::Adc, flags),
        AluOp::Sbc => data(Alu::Sbc, flags),
        AluOp::Orr => data(Alu::Orr, flags),
        AluOp::Bic => data(Alu::Bic, flags),
        AluOp::Mvn => data(Alu::Mvn, flags),
        AluOp::Tst => data(Alu::Tst, true),
        AluOp::Cmp => data(Alu::Cmp, true),
        AluOp::Cmn => data(Alu::Cmn, true),
        AluOp::Lsl => shift(ShiftType::Lsl),
        AluOp::Lsr => shift(ShiftType::Lsr),
        AluOp::Asr => shift(ShiftType::Asr),
        AluOp::Ror => shift(ShiftType::Ror),
        AluOp::Neg => What::Constant { alu: Alu::Rsb, flags, rd, rn: rm, value: 0, carry: None },
        AluOp::Mul => What::Multiply { multiply: Multiply::Low, flags, rd, ra: 0, rm, rn: rd },
    }
}
