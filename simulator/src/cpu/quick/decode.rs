//! From the library's decoded instructions to those that are executed here.
//!
//! What is not here, and all that the architecture calls unpredictable, is [`What::Library`]'s.

use rsemu::cpu::arm::aprofile::isa::{self, DpOp, ExtraOp, Half, HalfMulOp, Insn, Offset, Operand};
use rsemu::cpu::arm::aprofile::isa_v6::{BarrierKind, BitfieldOp, HintOp};
use rsemu::cpu::arm::aprofile::media::{ExtendSize, RevOp};
use rsemu::cpu::arm::aprofile::{Arch, Config, thumb2};

use super::alu::{Alu, Shift, Shifted};
use super::media::Media;
use super::multiply::Multiply;
use super::op::{Block, Index, Op, PC, Size, Transfer, What};

pub(super) const ARCHITECTURE: Arch = Config::CORTEX_A9.arch;
/// In a key: Thumb code, inside of a block with conditions.
const THUMB: u64 = 1 << 32;
const IN_BLOCK: u64 = 1 << 33;

/// Returns what tells one instruction from all others.
#[inline(always)]
pub(super) fn key(word: u32, thumb: bool, in_block: bool) -> u64 {
    u64::from(word) | u64::from(thumb) << 32 | u64::from(in_block) << 33
}

impl Op {
    /// Returns the instruction of a key. A word of Thumb code has its first half on top; a short instruction is
    /// its lower half.
    pub(super) fn decode(key: u64) -> Self {
        let word = key as u32;
        if key & THUMB == 0 {
            let decoded = isa::decode_for(&ARCHITECTURE, word);
            return Self { key, condition: decoded.cond.0, bytes: 4, what: what(decoded.insn, false) };
        }
        if word >> 16 != 0 {
            let decoded = thumb2::decode_for(&ARCHITECTURE, (word >> 16) as u16, word as u16);
            return Self { key, condition: decoded.cond.0, bytes: 4, what: what(decoded.insn, true) };
        }
        let (condition, what) = super::thumb::short(word as u16, key & IN_BLOCK != 0);
        Self { key, condition, bytes: 2, what }
    }
}

/// Returns what an instruction does, of ARM or Thumb code.
pub(super) fn what(insn: Insn, thumb: bool) -> What {
    match insn {
        Insn::DataProc { op, s, rd, rn, operand } => data(alu(op), s, rd, rn, operand, thumb),
        Insn::MovWide { rd: PC, .. } => What::Library,
        Insn::MovWide { top: true, rd, imm } => What::MoveTop { rd, value: u32::from(imm) << 16 },
        Insn::MovWide { top: false, rd, imm } => {
            What::Constant { alu: Alu::Mov, flags: false, rd, rn: 0, value: imm.into(), carry: None }
        }
        Insn::Branch { link, offset } => What::Branch { link, offset },
        Insn::BlxImm { offset } => What::CallOther { offset },
        Insn::Bx { rm } if rm != PC => What::Exchange { link: false, rm },
        Insn::BlxReg { rm } if rm != PC => What::Exchange { link: true, rm },
        Insn::TableBranch { half, rn, rm } if rm != PC => What::TableBranch { half, rn, rm },
        Insn::Pld { .. } | Insn::Hint { op: HintOp::Nop | HintOp::Yield } => What::Nothing,
        Insn::Barrier { kind: BarrierKind::Dmb | BarrierKind::Dsb, .. } => What::Barrier,
        Insn::LoadStore { load, byte, up, index, rn, rd, offset } => {
            transfer(load, if byte { Size::Byte } else { Size::Word }, up, index, [rn, rd], offset)
        }
        Insn::LoadStoreExtra { op, up, index, rn, rd, offset } => extra(op, up, index, [rn, rd], offset),
        Insn::LoadStoreDual { load, rt, rt2, rn, up, index, imm } => pair(load, up, index, [rn, rt, rt2], imm),
        Insn::BlockTransfer { load, before, up, user: false, writeback, rn, list } => {
            let block = Block { load, before, up, writeback, rn, list };
            if block.is_sound() { What::Block(block) } else { What::Library }
        }
        _ => multiplication(insn).unwrap_or_else(|| media(insn)),
    }
}

fn alu(op: DpOp) -> Alu {
    match op {
        DpOp::And => Alu::And,
        DpOp::Eor => Alu::Eor,
        DpOp::Sub => Alu::Sub,
        DpOp::Rsb => Alu::Rsb,
        DpOp::Add => Alu::Add,
        DpOp::Adc => Alu::Adc,
        DpOp::Sbc => Alu::Sbc,
        DpOp::Rsc => Alu::Rsc,
        DpOp::Tst => Alu::Tst,
        DpOp::Teq => Alu::Teq,
        DpOp::Cmp => Alu::Cmp,
        DpOp::Cmn => Alu::Cmn,
        DpOp::Orr => Alu::Orr,
        DpOp::Mov => Alu::Mov,
        DpOp::Bic => Alu::Bic,
        DpOp::Mvn => Alu::Mvn,
        DpOp::Orn => Alu::Orn,
    }
}

fn data(alu: Alu, flags: bool, rd: u8, rn: u8, operand: Operand, thumb: bool) -> What {
    let rd = if alu.tests() { 0 } else { rd };
    let rn = if alu.reads_first() { rn } else { 0 };
    // A return from an exception, and in Thumb code what is unpredictable.
    if rd == PC && (flags || thumb) {
        return What::Library;
    }
    let what = match operand {
        Operand::Imm { imm8, rotate } => {
            let value = u32::from(imm8).rotate_right(2 * u32::from(rotate));
            What::Constant { alu, flags, rd, rn, value, carry: (rotate != 0).then_some(value >> 31 != 0) }
        }
        Operand::Const { value, carry } => What::Constant { alu, flags, rd, rn, value, carry },
        Operand::Reg { rm: PC, .. } if thumb => return What::Library,
        Operand::Reg { rm, shift: isa::Shift::Imm { ty, amount } } => {
            What::Register { alu, flags, rd, rn, shifted: Shifted::new(rm, ty, amount) }
        }
        Operand::Reg { rm, shift: isa::Shift::Reg { ty, rs } } => {
            if [rd, rn, rm, rs].contains(&PC) {
                return What::Library;
            }
            What::ByRegister { alu, flags, rd, rn, rm, rs, shift: Shift::of(ty) }
        }
    };
    match what {
        _ if rn != PC || !thumb => what,
        What::Constant { alu: Alu::Add, value, .. } if !flags => What::Address { rd, offset: value as i32 },
        What::Constant { alu: Alu::Sub, value, .. } if !flags => {
            What::Address { rd, offset: (value as i32).wrapping_neg() }
        }
        _ => What::Library,
    }
}

fn multiplication(insn: Insn) -> Option<What> {
    let (multiply, flags, [rd, ra, rm, rn]) = match insn {
        Insn::Mul { accumulate: true, s, rd, rn, rm, rs } => (Multiply::Accumulate, s, [rd, rn, rs, rm]),
        Insn::Mul { accumulate: false, s, rd, rm, rs, .. } => (Multiply::Low, s, [rd, 0, rs, rm]),
        Insn::MulLong { signed, accumulate, s, rdhi, rdlo, rm, rs } => {
            (Multiply::Long { signed, accumulate }, s, [rdhi, rdlo, rs, rm])
        }
        Insn::Umaal { rdhi, rdlo, rn, rm } => (Multiply::LongTwice, false, [rdhi, rdlo, rm, rn]),
        Insn::Mls { rd, rn, rm, ra } => (Multiply::Subtract, false, [rd, ra, rm, rn]),
        Insn::HalfMul { op: HalfMulOp::Smul, rd, rm, rs, x, y, .. } => {
            (Multiply::Halves(x == Half::Top, y == Half::Top), false, [rd, 0, rs, rm])
        }
        Insn::MulHigh { sub: false, round, rd, rn, rm, ra } => {
            (Multiply::High { round, accumulate: ra.is_some() }, false, [rd, ra.unwrap_or(0), rm, rn])
        }
        _ => return None,
    };
    let unsound = [rd, ra, rm, rn].contains(&PC) || multiply.is_long() && rd == ra;
    Some(if unsound { What::Library } else { What::Multiply { multiply, flags, rd, ra, rm, rn } })
}

fn media(insn: Insn) -> What {
    let (media, rd, rn, rm) = match insn {
        Insn::Clz { rd, rm } => (Media::CountZeros, rd, None, rm),
        Insn::Reverse { op: RevOp::Rev, rd, rm } => (Media::ReverseBytes, rd, None, rm),
        Insn::Reverse { op: RevOp::Rev16, rd, rm } => (Media::ReverseHalves, rd, None, rm),
        Insn::Reverse { op: RevOp::Rbit, rd, rm } => (Media::ReverseBits, rd, None, rm),
        Insn::Extend { signed, size: size @ (ExtendSize::Byte | ExtendSize::Half), rd, rn, rm, rotate } => {
            (Media::Extend { signed, half: size == ExtendSize::Half, rotate: 8 * rotate }, rd, rn, rm)
        }
        Insn::Pack { tb, rd, rn, rm, amount } if rn != PC => (Media::Pack { top: tb, amount }, rd, Some(rn), rm),
        Insn::Bitfield { op: BitfieldOp::Bfc, rd, lsb, width, .. } if rd != PC => {
            return What::Media { media: Media::Insert { low: lsb, width }, rd, rn: PC, rm: PC };
        }
        Insn::Bitfield { op: BitfieldOp::Bfi, rd, rn, lsb, width } => (Media::Insert { low: lsb, width }, rd, None, rn),
        Insn::Bitfield { op: op @ (BitfieldOp::Ubfx | BitfieldOp::Sbfx), rd, rn, lsb, width } => {
            (Media::Field { signed: op == BitfieldOp::Sbfx, low: lsb, width }, rd, None, rn)
        }
        _ => return What::Library,
    };
    if rd == PC || rm == PC {
        return What::Library;
    }
    What::Media { media, rd, rn: rn.unwrap_or(PC), rm }
}

fn index(index: isa::Index) -> Option<Index> {
    match index {
        isa::Index::Pre { writeback: false } => Some(Index::Offset),
        isa::Index::Pre { writeback: true } => Some(Index::Pre),
        isa::Index::Post { unprivileged: false } => Some(Index::Post),
        _ => None,
    }
}

fn signed(offset: u16, up: bool) -> i32 {
    if up { offset.into() } else { -i32::from(offset) }
}

fn transfer(load: bool, size: Size, up: bool, when: isa::Index, [rn, rd]: [u8; 2], offset: Offset) -> What {
    let Some(index) = index(when) else { return What::Library };
    let transfer = Transfer { load, size, index, rd, rn };
    if !transfer.is_sound() {
        return What::Library;
    }
    match offset {
        Offset::Imm(offset) => What::Transfer { transfer, offset: signed(offset, up) },
        Offset::Reg { rm, shift: isa::Shift::Imm { ty, amount } }
            if rm != PC && (index == Index::Offset || rm != rn) =>
        {
            What::TransferByRegister { transfer, shifted: Shifted::new(rm, ty, amount), subtract: !up }
        }
        Offset::Reg { .. } => What::Library,
    }
}

fn extra(op: ExtraOp, up: bool, when: isa::Index, [rn, rd]: [u8; 2], offset: Offset) -> What {
    let (load, size) = match (op, offset) {
        (ExtraOp::Strh, _) => (false, Size::Half),
        (ExtraOp::Ldrh, _) => (true, Size::Half),
        (ExtraOp::Ldrsb, _) => (true, Size::SignedByte),
        (ExtraOp::Ldrsh, _) => (true, Size::SignedHalf),
        (ExtraOp::Ldrd | ExtraOp::Strd, Offset::Imm(offset)) if rd & 1 == 0 => {
            return pair(op == ExtraOp::Ldrd, up, when, [rn, rd, rd + 1], offset);
        }
        _ => return What::Library,
    };
    transfer(load, size, up, when, [rn, rd], offset)
}

fn pair(load: bool, up: bool, when: isa::Index, [rn, first, second]: [u8; 3], offset: u16) -> What {
    let Some(index) = index(when) else { return What::Library };
    let of = |rd| Transfer { load, size: Size::Word, index, rd, rn };
    let sound =
        of(first).is_sound() && of(second).is_sound() && first != PC && second != PC && !(load && first == second);
    if sound { What::Pair { transfer: of(first), second, offset: signed(offset, up) } } else { What::Library }
}
