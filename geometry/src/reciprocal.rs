//! 1/x without a divide instruction, which the Cortex-A9 does not have.

/// Bits of the normalised divisor, below its leading one, that choose the table's entry.
const INDEX_BITS: u32 = 9;
const ENTRIES: usize = 1 << INDEX_BITS;

/// 2⁶² over the middle of each entry's interval, made at compile time.
static SEED: [u32; ENTRIES] = seeds();

/// Returns 2⁶¹/`divisor` for a normalised divisor, 2³¹ ≤ `divisor` < 2³².
///
/// The result is in 2²⁹…2³⁰, within a relative 10⁻⁶ of the exact one: a table of 512 seeds,
/// each within 2⁻¹⁰ (half an interval), and one Newton step, which squares the error. A divisor
/// that is not normalised gives a meaningless result, no panic.
#[inline(always)]
pub fn reciprocal(divisor: u32) -> i32 {
    let seed = SEED[(divisor >> (31 - INDEX_BITS)) as usize & (ENTRIES - 1)];
    // 2³⁰·(1 + e), where e is the seed's relative error.
    let product = high_unsigned(divisor, seed);
    // seed·(1 − e); the second factor is 2³² − 2·product = 2³¹·(1 − e).
    high_unsigned(seed, 0u32.wrapping_sub(product << 1)) as i32
}

/// The upper half of a 64-bit product, unsigned.
#[inline(always)]
fn high_unsigned(a: u32, b: u32) -> u32 {
    ((u64::from(a) * u64::from(b)) >> 32) as u32
}

/// Returns the upper half of a 64-bit product, floored: one instruction on the Cortex-A9.
#[inline(always)]
pub(crate) fn high(a: i32, b: i32) -> i32 {
    ((i64::from(a) * i64::from(b)) >> 32) as i32
}

const fn seeds() -> [u32; ENTRIES] {
    let mut table = [0; ENTRIES];
    let mut index = 0;
    while index < ENTRIES {
        let middle = (1u64 << 31) + ((index as u64) << (31 - INDEX_BITS)) + (1 << (30 - INDEX_BITS));
        table[index] = ((1u64 << 62) / middle) as u32;
        index += 1;
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    fn relative_error(divisor: u32) -> f64 {
        let exact = 2.0f64.powi(61) / f64::from(divisor);
        (f64::from(reciprocal(divisor)) - exact).abs() / exact
    }

    /// Both ends of every seed's interval, where its error is greatest, and a dense sweep.
    #[test]
    fn the_relative_error_stays_below_a_millionth() {
        let interval = 1u32 << (31 - INDEX_BITS);
        let ends = (0..ENTRIES as u32).flat_map(|entry| {
            let first = (1 << 31) + entry * interval;
            [first, first + 1, first + (interval - 1), first + interval / 2]
        });
        let sweep = (0..3_000_000u32).map(|sample| (1 << 31) | sample.wrapping_mul(715_827_883));
        let worst = ends.chain(sweep).map(relative_error).fold(0.0, f64::max);
        assert!(worst < 1e-6, "worst error {worst:e}");
    }

    #[test]
    fn a_divisor_that_is_not_normalised_does_not_panic() {
        for divisor in [0, 1, 255, 1 << 29, 1 << 30, i32::MAX as u32] {
            reciprocal(divisor);
        }
    }
}
