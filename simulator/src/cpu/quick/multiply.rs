//! Multiplications (ARM DDI 0406C, A5.2.5, A5.2.7, A5.4.4).

use super::alu::{N, Z, with_sign};

/// A multiplication. Of the long ones `ra` is the low word, `rd` the high one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Multiply {
    Low,
    Accumulate,
    Subtract,
    /// With both words as one number added.
    Long {
        signed: bool,
        accumulate: bool,
    },
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
    #[inline]
    pub(super) fn is_long(self) -> bool {
        matches!(self, Self::Long { .. } | Self::LongTwice)
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
            Self::Long { signed: is_signed, accumulate } => {
                let product = if is_signed { signed() } else { unsigned() };
                product.wrapping_add(if accumulate { whole } else { 0 })
            }
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
