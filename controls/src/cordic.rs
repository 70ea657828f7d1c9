//! Angle and length of a vector by shifts and additions.
//!
//! CORDIC in vectoring mode (Volder, "The CORDIC Trigonometric Computing Technique", 1959): the
//! vector is turned towards the x axis by arctan 2⁻⁰, 2⁻¹, … and the turns are added up. The
//! Cortex-A9 has no integer divide; this wants none.

use fixed::types::I9F23;

/// Holds a vector as its angle and its length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Polar {
    /// From the x axis towards the y axis, in degrees, −180 < angle ≤ 180 but for rounding; 0 for
    /// a vector of no length. Off by less than 2⁻¹⁷ degree.
    pub(crate) angle: I9F23,
    /// In the unit of x and y, off by no more than half a unit and 2⁻²⁴ of itself.
    pub(crate) length: i32,
}

/// Inputs stay below this, which leaves room for the CORDIC's gain in 32 bits.
const LIMIT_BITS: u32 = 29;

/// arctan 2⁻ⁱ in degrees, as multiples of 2⁻²³ degree.
const ARCTANGENTS: [i32; 28] = [
    377_487_360,
    222_843_801,
    117_744_544,
    59_768_969,
    30_000_467,
    15_014_858,
    7_509_261,
    3_754_860,
    1_877_459,
    938_733,
    469_367,
    234_683,
    117_342,
    58_671,
    29_335,
    14_668,
    7_334,
    3_667,
    1_833,
    917,
    458,
    229,
    115,
    57,
    29,
    14,
    7,
    4,
];

/// What turning makes of lengths, undone: 2³² · ∏ cos arctan 2⁻ⁱ.
const INVERSE_GAIN: i64 = 2_608_131_496;

/// Returns the angle and the length of (x, y), both within ±2²⁹.
pub(crate) fn polar(x: i32, y: i32) -> Polar {
    let widest = x.unsigned_abs() | y.unsigned_abs();
    debug_assert!(widest >> LIMIT_BITS == 0, "({x}, {y}) leaves no room for the gain");
    if widest == 0 {
        return Polar { angle: I9F23::ZERO, length: 0 };
    }
    let shift = widest.leading_zeros().saturating_sub(32 - LIMIT_BITS);
    let (mut x, mut y) = (x << shift, y << shift);
    let mut angle = 0;
    if x < 0 {
        const HALF_TURN: i32 = 180 << 23;
        angle = if y >= 0 { HALF_TURN } else { -HALF_TURN };
        (x, y) = (-x, -y);
    }
    for (power, arctangent) in ARCTANGENTS.into_iter().enumerate() {
        let (across, along) = (x >> power, y >> power);
        if y >= 0 {
            (x, y, angle) = (x + along, y - across, angle + arctangent);
        } else {
            (x, y, angle) = (x - along, y + across, angle - arctangent);
        }
    }
    let shifted = (i64::from(x) * INVERSE_GAIN) >> 32;
    let half = (1 << shift) >> 1;
    Polar { angle: I9F23::from_bits(angle), length: ((shifted + half) >> shift) as i32 }
}

#[cfg(test)]
mod tests {
    use super::{ARCTANGENTS, INVERSE_GAIN, polar};

    #[test]
    fn the_tables_are_what_they_say() {
        let mut gain = 1.0;
        for (power, arctangent) in ARCTANGENTS.into_iter().enumerate() {
            let tangent = 0.5_f64.powi(power as i32);
            let exact = tangent.atan().to_degrees() * f64::from(1 << 23);
            assert!((exact - f64::from(arctangent)).abs() <= 0.5, "{power}");
            gain *= tangent.atan().cos();
        }
        assert!((gain * 2_f64.powi(32) - INVERSE_GAIN as f64).abs() < 1.0);
    }

    #[test]
    fn any_direction_at_any_size() {
        let mut worst = 0.0_f64;
        for bits in 0..=28 {
            for step in 0..7_200 {
                let (sine, cosine) = (f64::from(step) * 0.05).to_radians().sin_cos();
                let size = f64::from((1 << bits) + (1 << bits) / 3);
                let (x, y) = ((size * cosine) as i32, (size * sine) as i32);
                let found = polar(x, y);
                let (x, y) = (f64::from(x), f64::from(y));
                let off = (found.angle.to_num::<f64>() - y.atan2(x).to_degrees()).abs();
                worst = worst.max(off.min(360.0 - off));
                assert!(
                    (f64::from(found.length) - x.hypot(y)).abs() <= 0.5 + x.hypot(y) * 0.5_f64.powi(24),
                    "({x}, {y})"
                );
            }
        }
        assert!(worst < 0.5_f64.powi(17), "{worst} degrees");
    }

    #[test]
    fn the_axes() {
        for (x, y, degrees) in [(1, 0, 0), (0, 1, 90), (-1, 0, 180), (0, -1, -90), (7, 7, 45), (0, 0, 0)] {
            let found = polar(x, y).angle.to_num::<f64>();
            assert!((found - f64::from(degrees)).abs() < 1e-5, "({x}, {y}) at {found}");
        }
    }
}
