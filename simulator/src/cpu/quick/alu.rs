//! Data processing: shifts, sums, logic and flags (ARM DDI 0406C, A8.4, A5.2).

use rsemu::cpu::arm::aprofile::isa::ShiftType;

/// The flags' places in CPSR.
pub(super) const N: u32 = 1 << 31;
pub(super) const Z: u32 = 1 << 30;
pub(super) const C: u32 = 1 << 29;
pub(super) const V: u32 = 1 << 28;

/// Bit `flags` of entry `condition` says whether it holds with these four flags, N on top (A8.3).
const CONDITIONS: [u16; 15] = conditions();

const fn conditions() -> [u16; 15] {
    let mut table = [0; 15];
    let mut flags = 0;
    while flags < 16 {
        let (n, z, c, v) = (flags & 8 != 0, flags & 4 != 0, flags & 2 != 0, flags & 1 != 0);
        let even = [z, c, n, v, c && !z, n == v, n == v && !z];
        let mut pair = 0;
        while pair < even.len() {
            table[2 * pair + !even[pair] as usize] |= 1 << flags;
            pair += 1;
        }
        table[14] |= 1 << flags;
        flags += 1;
    }
    table
}

/// Returns whether a condition holds.
#[inline]
pub(super) fn holds(condition: u8, status: u32) -> bool {
    CONDITIONS[condition as usize] >> (status >> 28) & 1 != 0
}

/// An operation of data processing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Alu {
    And,
    Eor,
    Sub,
    Rsb,
    Add,
    Adc,
    Sbc,
    Rsc,
    Tst,
    Teq,
    Cmp,
    Cmn,
    Orr,
    Mov,
    Bic,
    Mvn,
    Orn,
}

impl Alu {
    /// Returns whether it sets flags and nothing else.
    #[inline]
    pub(super) fn tests(self) -> bool {
        matches!(self, Self::Tst | Self::Teq | Self::Cmp | Self::Cmn)
    }

    /// Returns whether it has two operands.
    pub(super) fn reads_first(self) -> bool {
        !matches!(self, Self::Mov | Self::Mvn)
    }

    /// Returns the result, and CPSR with the flags as they then are; `carry` is the shifter's.
    #[inline(always)]
    pub(super) fn compute(self, a: u32, b: u32, carry: bool, status: u32) -> (u32, u32) {
        let carried = status & C != 0;
        let logic = |result| (result, carry, status & V != 0);
        let (result, carry, overflow) = match self {
            Self::And | Self::Tst => logic(a & b),
            Self::Eor | Self::Teq => logic(a ^ b),
            Self::Orr => logic(a | b),
            Self::Bic => logic(a & !b),
            Self::Orn => logic(a | !b),
            Self::Mov => logic(b),
            Self::Mvn => logic(!b),
            Self::Sub | Self::Cmp => sum(a, !b, true),
            Self::Rsb => sum(b, !a, true),
            Self::Add | Self::Cmn => sum(a, b, false),
            Self::Adc => sum(a, b, carried),
            Self::Sbc => sum(a, !b, carried),
            Self::Rsc => sum(b, !a, carried),
        };
        let carry = u32::from(carry) << 29;
        let overflow = u32::from(overflow) << 28;
        (result, with_sign(status, result) & !(C | V) | carry | overflow)
    }
}

/// Returns CPSR with N and Z as a result says.
#[inline]
pub(super) fn with_sign(status: u32, result: u32) -> u32 {
    status & !(N | Z) | result & N | u32::from(result == 0) << 30
}

/// Returns a sum, its carry and its signed overflow.
#[inline]
fn sum(a: u32, b: u32, carry: bool) -> (u32, bool, bool) {
    let whole = u64::from(a) + u64::from(b) + u64::from(carry);
    let result = whole as u32;
    (result, whole >> 32 != 0, (a ^ result) & (b ^ result) & N != 0)
}

/// A kind of shift.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shift {
    Left,
    Right,
    Arithmetic,
    Rotate,
}

impl Shift {
    pub(super) fn of(shift: ShiftType) -> Self {
        match shift {
            ShiftType::Lsl => Self::Left,
            ShiftType::Lsr => Self::Right,
            ShiftType::Asr => Self::Arithmetic,
            ShiftType::Ror => Self::Rotate,
        }
    }

    /// Shifts by a register's lowest byte; returns the carry, too.
    #[inline]
    pub(super) fn by_register(self, value: u32, amount: u32, carry: bool) -> (u32, bool) {
        let amount = amount & 0xFF;
        if amount == 0 {
            return (value, carry);
        }
        match self {
            Self::Left => {
                let wide = u64::from(value).checked_shl(amount).unwrap_or(0);
                (wide as u32, wide >> 32 & 1 != 0)
            }
            Self::Right => {
                let wide = (u64::from(value) << 1).checked_shr(amount).unwrap_or(0);
                ((wide >> 1) as u32, wide & 1 != 0)
            }
            Self::Arithmetic => {
                let wide = (i64::from(value as i32) << 1) >> amount.min(40);
                ((wide >> 1) as u32, wide & 1 != 0)
            }
            Self::Rotate => {
                let result = value.rotate_right(amount & 31);
                (result, result & N != 0)
            }
        }
    }
}

/// A register shifted by a constant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Shifted {
    rm: u8,
    shift: Shift,
    /// As in the instruction: 0 stands for 32, but for shifts left, and for rotations through the carry.
    amount: u8,
}

impl Shifted {
    pub(super) fn new(rm: u8, shift: ShiftType, amount: u8) -> Self {
        Self { rm, shift: Shift::of(shift), amount }
    }

    /// Returns a register that is not shifted.
    pub(super) fn plain(rm: u8) -> Self {
        Self { rm, shift: Shift::Left, amount: 0 }
    }

    /// Returns the shifted value, and the carry.
    #[inline(always)]
    pub(super) fn value(self, registers: &[u32; 16], carry: bool) -> (u32, bool) {
        let value = registers[self.rm as usize & 15];
        match (self.shift, self.amount) {
            (Shift::Left, 0) => (value, carry),
            (Shift::Rotate, 0) => (value >> 1 | u32::from(carry) << 31, value & 1 != 0),
            (shift, 0) => shift.by_register(value, 32, carry),
            (Shift::Left, amount) => (value << (amount & 31), bit(value, 32 - u32::from(amount))),
            (Shift::Right, amount) => (value >> (amount & 31), bit(value, u32::from(amount) - 1)),
            (Shift::Arithmetic, amount) => ((value as i32 >> (amount & 31)) as u32, bit(value, u32::from(amount) - 1)),
            (Shift::Rotate, amount) => {
                let result = value.rotate_right(amount.into());
                (result, result & N != 0)
            }
        }
    }
}

/// Returns whether a bit is set.
#[inline]
fn bit(value: u32, at: u32) -> bool {
    value >> at & 1 != 0
}
