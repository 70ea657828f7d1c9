//! Extensions, bit fields and reversals (ARM DDI 0406C, A5.4).

use super::op::PC;

/// An operation on one register's bits, most of them with another's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Media {
    CountZeros,
    ReverseBytes,
    ReverseHalves,
    ReverseBits,
    /// UXTB and so on, after a rotation by so many bits; added to `rn` unless that is the program counter's number.
    Extend {
        signed: bool,
        half: bool,
        rotate: u8,
    },
    /// UBFX, SBFX: the lowest bit, and how many.
    Field {
        signed: bool,
        low: u8,
        width: u8,
    },
    /// BFI, and with the program counter's number BFC.
    Insert {
        low: u8,
        width: u8,
    },
    /// PKHBT with a shift left, PKHTB with one to the right.
    Pack {
        top: bool,
        amount: u8,
    },
}

impl Media {
    /// Returns the result; `rd` is what stands in the register that takes it, `rn` and `rm` are registers' numbers.
    #[inline(always)]
    pub(super) fn compute(self, registers: &[u32; 16], rd: u32, rn: u8, rm: u8) -> u32 {
        let value = registers[rm as usize & 15];
        let first = registers[rn as usize & 15];
        match self {
            Self::CountZeros => value.leading_zeros(),
            Self::ReverseBytes => value.swap_bytes(),
            Self::ReverseHalves => value.swap_bytes().rotate_left(16),
            Self::ReverseBits => value.reverse_bits(),
            Self::Extend { signed, half, rotate } => {
                let value = value.rotate_right(rotate.into());
                let extended = match (signed, half) {
                    (false, false) => value & 0xFF,
                    (false, true) => value & 0xFFFF,
                    (true, false) => value as i8 as u32,
                    (true, true) => value as i16 as u32,
                };
                if rn == PC { extended } else { first.wrapping_add(extended) }
            }
            Self::Field { signed, low, width } => {
                let up = value << (32 - low - width);
                if signed { (up as i32 >> (32 - width)) as u32 } else { up >> (32 - width) }
            }
            Self::Insert { low, width } => {
                let mask = u32::MAX >> (32 - width) << low;
                let inserted = if rm == PC { 0 } else { value << low };
                rd & !mask | inserted & mask
            }
            Self::Pack { top: false, amount } => first & 0xFFFF | value << amount & 0xFFFF_0000,
            Self::Pack { top: true, amount } => {
                let amount = if amount == 0 { 31 } else { amount };
                first & 0xFFFF_0000 | (value as i32 >> amount) as u32 & 0xFFFF
            }
        }
    }
}
