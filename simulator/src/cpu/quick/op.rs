//! Instructions, as they are executed.

use super::alu::{Alu, Shift, Shifted};
use super::media::Media;
use super::multiply::Multiply;

/// The program counter's number.
pub(super) const PC: u8 = 15;
/// The condition that always holds.
pub(super) const ALWAYS: u8 = 14;

/// An instruction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Op {
    /// The word that it was made of, and of which instruction set it is: [`key`](super::decode::key).
    pub(super) key: u64,
    /// Its condition.
    pub(super) condition: u8,
    /// Its length.
    pub(super) bytes: u8,
    pub(super) what: What,
}

/// What an instruction does. Numbers are registers', offsets are in bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum What {
    /// Something that the library does.
    Library,
    /// Nothing: hints and preloads.
    Nothing,
    /// A barrier for data.
    Barrier,
    /// Data processing with a constant, and the carry that comes with it.
    Constant {
        alu: Alu,
        flags: bool,
        rd: u8,
        rn: u8,
        value: u32,
        carry: Option<bool>,
    },
    /// Data processing with a register, shifted by a constant.
    Register {
        alu: Alu,
        flags: bool,
        rd: u8,
        rn: u8,
        shifted: Shifted,
    },
    /// Data processing with a register, shifted by another.
    ByRegister {
        alu: Alu,
        flags: bool,
        rd: u8,
        rn: u8,
        rm: u8,
        rs: u8,
        shift: Shift,
    },
    /// An address from the program counter's, aligned to a word.
    Address {
        rd: u8,
        offset: i32,
    },
    /// Replaces the upper half.
    MoveTop {
        rd: u8,
        value: u32,
    },
    Multiply {
        multiply: Multiply,
        flags: bool,
        rd: u8,
        ra: u8,
        rm: u8,
        rn: u8,
    },
    Media {
        media: Media,
        rd: u8,
        rn: u8,
        rm: u8,
    },
    /// A branch from the program counter.
    Branch {
        link: bool,
        offset: i32,
    },
    /// A branch if a register is zero, or is not.
    CompareBranch {
        nonzero: bool,
        rn: u8,
        offset: u8,
    },
    /// A branch by a table of bytes or halves.
    TableBranch {
        half: bool,
        rn: u8,
        rm: u8,
    },
    /// A branch to where a register says, in which instruction set its lowest bit says.
    Exchange {
        link: bool,
        rm: u8,
    },
    /// A call of the other instruction set's code.
    CallOther {
        offset: i32,
    },
    /// The next instructions' conditions.
    IfThen {
        state: u8,
    },
    /// A load or store, by a constant.
    Transfer {
        transfer: Transfer,
        offset: i32,
    },
    /// The same by a register.
    TransferByRegister {
        transfer: Transfer,
        shifted: Shifted,
        subtract: bool,
    },
    /// Of two registers.
    Pair {
        transfer: Transfer,
        second: u8,
        offset: i32,
    },
    /// Of several.
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

impl Transfer {
    /// Returns whether it is predictable, and fit for here: no store of the program counter.
    pub(super) fn is_sound(self) -> bool {
        let Self { load, size, index, rd, rn } = self;
        (rd != PC || load && size == Size::Word) && (index == Index::Offset || rn != PC && rn != rd)
    }
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

impl Block {
    /// As [`Transfer::is_sound`].
    pub(super) fn is_sound(self) -> bool {
        let Self { load, writeback, rn, list, .. } = self;
        list != 0 && rn != PC && !(writeback && list >> rn & 1 != 0) && (load || list >> PC & 1 == 0)
    }
}
