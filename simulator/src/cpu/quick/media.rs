//! Extensions, bit fields and reversals (ARM DDI 0406C, A5.4).

use super::decode::{PC, What, bit, nibble};
use super::multiply::Multiply;

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
    pub(super) fn count_zeros(raw: u32) -> What {
        if raw & 0x000F_0F00 != 0x000F_0F00 {
            return What::Library;
        }
        Self::CountZeros.of(nibble(raw, 12), PC, nibble(raw, 0))
    }

    pub(super) fn decode(raw: u32) -> What {
        let (rd, rn, rm) = (nibble(raw, 12), nibble(raw, 16), nibble(raw, 0));
        let low = (raw >> 7 & 31) as u8;
        let high = (raw >> 16 & 31) as u8;
        match (raw >> 20 & 31, raw >> 5 & 7) {
            // Extensions: bits 9 and 8 are zero.
            (op @ (0b01010 | 0b01011 | 0b01110 | 0b01111), 0b011) if raw & 0x300 == 0 => {
                let rotate = 8 * (raw >> 10 & 3) as u8;
                Self::Extend { signed: op & 0b100 == 0, half: op & 1 != 0, rotate }.of(rd, rn, rm)
            }
            (0b01011, 0b001) if raw & 0x000F_0F00 == 0x000F_0F00 => Self::ReverseBytes.of(rd, PC, rm),
            (0b01011, 0b101) if raw & 0x000F_0F00 == 0x000F_0F00 => Self::ReverseHalves.of(rd, PC, rm),
            (0b01111, 0b001) if raw & 0x000F_0F00 == 0x000F_0F00 => Self::ReverseBits.of(rd, PC, rm),
            (0b01000, shift) if shift & 1 == 0 && rn != PC => {
                Self::Pack { top: bit(raw, 6), amount: low }.of(rd, rn, rm)
            }
            (0b10101, _) => Multiply::decode_high(raw),
            (op @ (0b11010 | 0b11011 | 0b11110 | 0b11111), 0b010 | 0b110) if low + high < 32 => {
                Self::Field { signed: op & 0b100 == 0, low, width: high + 1 }.of(rd, PC, rm)
            }
            // The register of a field that is inserted is in the lowest bits; what it goes into is in `rd`.
            (0b11100 | 0b11101, 0b000 | 0b100) if high >= low => {
                let what = Self::Insert { low, width: high - low + 1 };
                if rd == PC { What::Library } else { What::Media { media: what, rd, rn: PC, rm } }
            }
            _ => What::Library,
        }
    }

    fn of(self, rd: u8, rn: u8, rm: u8) -> What {
        if rd == PC || rm == PC {
            return What::Library;
        }
        What::Media { media: self, rd, rn, rm }
    }

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
