//! Multiplications (ARM DDI 0406C, A5.2.5, A5.2.7, A5.4.4).

use super::alu::{N, Z, with_sign};
use super::decode::{PC, What, bit, nibble};

/// A multiplication. Of the long ones `ra` is the low word, `rd` the high one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Multiply {
    Low,
    Accumulate,
    Subtract,
    LongUnsigned,
    LongUnsignedAccumulate,
    LongSigned,
    LongSignedAccumulate,
    /// With both words added as they are.
    LongTwice,
    /// SMULxy: halves, the top one of `rn`, of `rm`.
    Halves(bool, bool),
    /// SMMUL, SMMLA and their rounded kin: the high word.
    High {
        round: bool,
        accumulate: bool,
    },
}

impl Multiply {
    pub(super) fn decode(raw: u32) -> What {
        let multiply = match nibble(raw, 20) >> 1 {
            _ if bit(raw, 24) => return What::Library,
            0b000 => Self::Low,
            0b001 => Self::Accumulate,
            0b010 if !bit(raw, 20) => Self::LongTwice,
            0b011 if !bit(raw, 20) => Self::Subtract,
            0b100 => Self::LongUnsigned,
            0b101 => Self::LongUnsignedAccumulate,
            0b110 => Self::LongSigned,
            0b111 => Self::LongSignedAccumulate,
            _ => return What::Library,
        };
        multiply.of(raw, bit(raw, 20))
    }

    pub(super) fn decode_halves(raw: u32) -> What {
        if raw >> 21 & 3 != 0b11 || nibble(raw, 12) != 0 {
            return What::Library;
        }
        Self::Halves(bit(raw, 5), bit(raw, 6)).of(raw, false)
    }

    pub(super) fn decode_high(raw: u32) -> What {
        if raw & 0xD0 != 0x10 {
            return What::Library;
        }
        let accumulate = nibble(raw, 12) != PC;
        let What::Multiply { multiply, flags, rd, ra, rm, rn } =
            (Self::High { round: bit(raw, 5), accumulate }).of(raw & !0xF000, false)
        else {
            return What::Library;
        };
        What::Multiply { multiply, flags, rd, ra: if accumulate { nibble(raw, 12) } else { ra }, rm, rn }
    }

    fn of(self, raw: u32, flags: bool) -> What {
        let (rd, ra, rm, rn) = (nibble(raw, 16), nibble(raw, 12), nibble(raw, 8), nibble(raw, 0));
        if [rd, ra, rm, rn].contains(&PC) || self.is_long() && rd == ra {
            return What::Library;
        }
        What::Multiply { multiply: self, flags, rd, ra, rm, rn }
    }

    #[inline]
    pub(super) fn is_long(self) -> bool {
        use Multiply::*;
        matches!(self, LongUnsigned | LongUnsignedAccumulate | LongSigned | LongSignedAccumulate | LongTwice)
    }

    /// Returns the result, of which short ones are the low word; `high` and `low` are what is added.
    #[inline(always)]
    pub(super) fn compute(self, rn: u32, rm: u32, high: u32, low: u32) -> u64 {
        let unsigned = || u64::from(rn) * u64::from(rm);
        let signed = || i64::from(rn as i32).wrapping_mul(i64::from(rm as i32)) as u64;
        let whole = u64::from(high) << 32 | u64::from(low);
        let half = |value: u32, top: bool| i32::from((if top { value >> 16 } else { value }) as i16);
        match self {
            Self::Low => rn.wrapping_mul(rm).into(),
            Self::Accumulate => low.wrapping_add(rn.wrapping_mul(rm)).into(),
            Self::Subtract => low.wrapping_sub(rn.wrapping_mul(rm)).into(),
            Self::LongUnsigned => unsigned(),
            Self::LongUnsignedAccumulate => whole.wrapping_add(unsigned()),
            Self::LongSigned => signed(),
            Self::LongSignedAccumulate => whole.wrapping_add(signed()),
            Self::LongTwice => unsigned() + u64::from(high) + u64::from(low),
            Self::Halves(of_rn, of_rm) => u64::from(half(rn, of_rn).wrapping_mul(half(rm, of_rm)) as u32),
            Self::High { round, accumulate } => {
                let added = if accumulate { u64::from(low) << 32 } else { 0 };
                let rounding = if round { 1 << 31 } else { 0 };
                added.wrapping_add(signed()).wrapping_add(rounding) >> 32
            }
        }
    }

    /// Returns CPSR with the flags of a result.
    pub(super) fn flags(self, status: u32, result: u64) -> u32 {
        if !self.is_long() {
            return with_sign(status, result as u32);
        }
        status & !(N | Z) | (result >> 32) as u32 & N | u32::from(result == 0) << 30
    }
}
