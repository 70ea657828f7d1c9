//! An instruction word taken apart, once for as often as it runs.
//!
//! Section numbers are those of ARM DDI 0406C. What is not here, and all that the architecture calls
//! unpredictable, is [`What::Library`]'s.

use super::alu::{Alu, Shift, Shifted, rotated};
use super::media::Media;
use super::multiply::Multiply;

/// The program counter's number.
pub(super) const PC: u8 = 15;

/// An instruction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Op {
    /// The word it was made of.
    pub(super) raw: u32,
    /// Its condition, of which 14 is always.
    pub(super) condition: u8,
    pub(super) what: What,
}

/// What an instruction does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum What {
    /// Something that the library does.
    Library,
    /// Nothing: hints and preloads.
    Nothing,
    /// A barrier for data (A8.8.43, A8.8.44).
    Barrier,
    /// Data processing with a constant, and the carry that its rotation leaves (A5.2.3, A5.2.4).
    Constant { alu: Alu, flags: bool, rd: u8, rn: u8, value: u32, carry: Option<bool> },
    /// Data processing with a register, shifted by a constant (A5.2.1).
    Register { alu: Alu, flags: bool, rd: u8, rn: u8, shifted: Shifted },
    /// Data processing with a register, shifted by another (A5.2.2).
    ByRegister { alu: Alu, flags: bool, rd: u8, rn: u8, rm: u8, rs: u8, shift: Shift },
    /// MOVW (A8.8.102).
    MoveWide { rd: u8, value: u32 },
    /// MOVT (A8.8.106).
    MoveTop { rd: u8, value: u32 },
    /// Multiplications (A5.2.5, A5.2.7, A5.4.4).
    Multiply { multiply: Multiply, flags: bool, rd: u8, ra: u8, rm: u8, rn: u8 },
    /// Extensions, bit fields, reversals (A5.4).
    Media { media: Media, rd: u8, rn: u8, rm: u8 },
    /// B, BL: bytes from this instruction's address plus 8 (A8.8.18, A8.8.25).
    Branch { link: bool, offset: i32 },
    /// BX, BLX to a register's address (A8.8.26, A8.8.27).
    Exchange { link: bool, rm: u8 },
    /// A load or store of one register or a pair, by a constant (A5.3, A5.2.8).
    Transfer { transfer: Transfer, offset: i32 },
    /// The same by a register.
    TransferByRegister { transfer: Transfer, shifted: Shifted, subtract: bool },
    /// LDM, STM (A5.5).
    Block(Block),
}

/// How much a load or store moves, and how it is extended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Size {
    Word,
    Byte,
    Half,
    SignedByte,
    SignedHalf,
    Pair,
}

/// When the offset counts, and whether the base takes it on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Index {
    Offset,
    Pre,
    Post,
}

/// A load or store.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Transfer {
    pub(super) load: bool,
    pub(super) size: Size,
    pub(super) index: Index,
    pub(super) rd: u8,
    pub(super) rn: u8,
}

/// A load or store of several registers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Block {
    pub(super) load: bool,
    pub(super) before: bool,
    pub(super) up: bool,
    pub(super) writeback: bool,
    pub(super) rn: u8,
    pub(super) list: u16,
}

/// Returns the four bits of a word from bit `at` on: a register's number, mostly.
pub(super) const fn nibble(raw: u32, at: u32) -> u8 {
    (raw >> at & 15) as u8
}

pub(super) const fn bit(raw: u32, at: u32) -> bool {
    raw >> at & 1 != 0
}

impl Op {
    pub(super) fn decode(raw: u32) -> Self {
        let condition = nibble(raw, 28);
        if condition == 15 {
            return Self { raw, condition: 14, what: unconditional(raw) };
        }
        let what = match raw >> 25 & 7 {
            0b000 if bit(raw, 7) && bit(raw, 4) && raw >> 5 & 3 == 0 => Multiply::decode(raw),
            0b000 if bit(raw, 7) && bit(raw, 4) => extra_transfer(raw),
            0b000 if raw >> 23 & 3 == 0b10 && !bit(raw, 20) => miscellaneous(raw),
            0b000 => by_register(raw),
            0b001 => constant(raw),
            0b010 => transfer(raw),
            0b011 if bit(raw, 4) => Media::decode(raw),
            0b011 => transfer(raw),
            0b100 => block(raw),
            0b101 => What::Branch { link: bit(raw, 24), offset: (raw << 8) as i32 >> 6 },
            _ => What::Library,
        };
        Self { raw, condition, what }
    }
}

fn unconditional(raw: u32) -> What {
    // PLD by a constant, by a register; DSB and DMB.
    if raw & 0xFF70_F000 == 0xF550_F000 || raw & 0xFF70_F010 == 0xF750_F000 {
        What::Nothing
    } else if raw & 0xFFFF_FFE0 == 0xF57F_F040 {
        What::Barrier
    } else {
        What::Library
    }
}

/// Whether data processing may do what it asks for here: flags come back with the program counter from an exception.
fn is_plain(alu: Alu, flags: bool, rd: u8) -> bool {
    rd != PC || !flags && !alu.tests()
}

fn by_register(raw: u32) -> What {
    let (alu, flags) = (Alu::of(raw), bit(raw, 20));
    let (rn, rd, rm) = (nibble(raw, 16), nibble(raw, 12), nibble(raw, 0));
    if !is_plain(alu, flags, rd) {
        return What::Library;
    }
    if !bit(raw, 4) {
        return What::Register { alu, flags, rd, rn, shifted: Shifted::of(raw) };
    }
    let rs = nibble(raw, 8);
    if [rd, rn, rm, rs].contains(&PC) {
        return What::Library;
    }
    What::ByRegister { alu, flags, rd, rn, rm, rs, shift: Shift::of(raw) }
}

fn constant(raw: u32) -> What {
    let (rn, rd) = (nibble(raw, 16), nibble(raw, 12));
    if raw >> 23 & 3 == 0b10 && !bit(raw, 20) {
        let value = u32::from(rn) << 12 | raw & 0xFFF;
        return match raw >> 20 & 0x1F {
            _ if raw & 0x0FFF_FFFE == 0x0320_F000 => What::Nothing,
            0b10000 if rd != PC => What::MoveWide { rd, value },
            0b10100 if rd != PC => What::MoveTop { rd, value: value << 16 },
            _ => What::Library,
        };
    }
    let (alu, flags) = (Alu::of(raw), bit(raw, 20));
    if !is_plain(alu, flags, rd) {
        return What::Library;
    }
    let (value, carry) = rotated(raw);
    What::Constant { alu, flags, rd, rn, value, carry }
}

fn miscellaneous(raw: u32) -> What {
    let rm = nibble(raw, 0);
    match (raw >> 4 & 15, raw >> 21 & 3) {
        (0b0001, 0b01) if raw & 0x000F_FF00 == 0x000F_FF00 && rm != PC => What::Exchange { link: false, rm },
        (0b0011, 0b01) if raw & 0x000F_FF00 == 0x000F_FF00 && rm != PC => What::Exchange { link: true, rm },
        (0b0001, 0b11) => Media::count_zeros(raw),
        (8 | 10 | 12 | 14, _) => Multiply::decode_halves(raw),
        _ => What::Library,
    }
}

/// Returns when the offset counts; `None` for accesses without privilege.
fn index(raw: u32) -> Option<Index> {
    match (bit(raw, 24), bit(raw, 21)) {
        (true, false) => Some(Index::Offset),
        (true, true) => Some(Index::Pre),
        (false, false) => Some(Index::Post),
        (false, true) => None,
    }
}

/// Returns whether a transfer is predictable.
fn is_sound(transfer: Transfer) -> bool {
    let Transfer { load, size, index, rd, rn } = transfer;
    let writeback = index != Index::Offset;
    let second = if size == Size::Pair { rd + 1 } else { rd };
    let pc_is_loaded = load && size == Size::Word;
    (size != Size::Pair || rd & 1 == 0)
        && (rd != PC && second != PC || pc_is_loaded)
        && !(writeback && (rn == PC || rn == rd || rn == second))
}

fn transfer(raw: u32) -> What {
    let Some(index) = index(raw) else { return What::Library };
    let size = if bit(raw, 22) { Size::Byte } else { Size::Word };
    let transfer = Transfer { load: bit(raw, 20), size, index, rd: nibble(raw, 12), rn: nibble(raw, 16) };
    if !is_sound(transfer) {
        return What::Library;
    }
    if !bit(raw, 25) {
        let offset = (raw & 0xFFF) as i32;
        return What::Transfer { transfer, offset: if bit(raw, 23) { offset } else { -offset } };
    }
    let shifted = Shifted::of(raw);
    if shifted.rm == PC || index != Index::Offset && shifted.rm == transfer.rn {
        return What::Library;
    }
    What::TransferByRegister { transfer, shifted, subtract: !bit(raw, 23) }
}

fn extra_transfer(raw: u32) -> What {
    let Some(index) = index(raw) else { return What::Library };
    let (load, size) = match (raw >> 5 & 3, bit(raw, 20)) {
        (0b01, load) => (load, Size::Half),
        (0b10, true) => (true, Size::SignedByte),
        (0b11, true) => (true, Size::SignedHalf),
        (0b10, false) => (true, Size::Pair),
        _ => (false, Size::Pair),
    };
    let transfer = Transfer { load, size, index, rd: nibble(raw, 12), rn: nibble(raw, 16) };
    if !is_sound(transfer) {
        return What::Library;
    }
    if bit(raw, 22) {
        let offset = (raw >> 4 & 0xF0 | raw & 15) as i32;
        return What::Transfer { transfer, offset: if bit(raw, 23) { offset } else { -offset } };
    }
    let rm = nibble(raw, 0);
    // A pair's second load must not change what the first took its address from.
    let clash = rm == PC || index != Index::Offset && rm == transfer.rn || size == Size::Pair && rm & !1 == transfer.rd;
    if clash || raw & 0xF00 != 0 {
        return What::Library;
    }
    What::TransferByRegister { transfer, shifted: Shifted::plain(rm), subtract: !bit(raw, 23) }
}

fn block(raw: u32) -> What {
    let block = Block {
        load: bit(raw, 20),
        before: bit(raw, 24),
        up: bit(raw, 23),
        writeback: bit(raw, 21),
        rn: nibble(raw, 16),
        list: raw as u16,
    };
    let writes_listed = block.writeback && block.list >> block.rn & 1 != 0;
    let stores_pc = !block.load && block.list >> PC & 1 != 0;
    if bit(raw, 22) || block.list == 0 || block.rn == PC || writes_listed || stores_pc {
        return What::Library;
    }
    What::Block(block)
}
