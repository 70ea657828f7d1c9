//! Angles, their sine and cosine.

use fixed::types::{I2F30, I16F16};

/// Segments of a quarter turn in the sine table.
const SEGMENTS: usize = 256;
/// Bits of an angle below the table's index.
const FRACTION_BITS: u32 = 22;
/// π/2 in Q2.30: what turns a fraction of a quarter into radians.
const HALF_PI: i64 = 1_686_629_713;

/// Sine of `i` segments, Q2.30, made at compile time.
static SINE: [i32; SEGMENTS + 1] = sine_table();

/// An angle in units of 2⁻³² of a turn; addition wraps as turns do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Angle(u32);

impl Angle {
    /// No turn.
    pub const ZERO: Self = Self(0);
    /// A quarter turn, 90°.
    pub const QUARTER: Self = Self(1 << 30);
    /// Half a turn, 180°.
    pub const HALF: Self = Self(1 << 31);

    /// Returns the angle of so many 2⁻³² turns.
    pub const fn from_bits(bits: u32) -> Self {
        Self(bits)
    }

    /// Returns the angle in 2⁻³² turns.
    pub const fn to_bits(self) -> u32 {
        self.0
    }

    /// Returns the angle of `degrees`, rounded to the nearest 2⁻³² turn; any number of turns.
    pub fn from_degrees(degrees: I16F16) -> Self {
        // 2⁻¹⁶ degrees are 2³²/360 · 2⁻¹⁶ units.
        Self(((i64::from(degrees.to_bits()) * 65_536 + 180).div_euclid(360)) as u32)
    }

    /// Returns the sum of two angles, modulo a turn.
    #[must_use]
    pub const fn plus(self, other: Self) -> Self {
        Self(self.0.wrapping_add(other.0))
    }

    /// Returns the opposite angle.
    #[must_use]
    pub const fn negated(self) -> Self {
        Self(self.0.wrapping_neg())
    }

    /// Returns this angle `count` times, modulo a turn.
    #[must_use]
    pub const fn times(self, count: u32) -> Self {
        Self(self.0.wrapping_mul(count))
    }

    /// Returns sine and cosine, each within 2⁻²⁹ of the true value.
    pub fn sin_cos(self) -> (I2F30, I2F30) {
        let (sine, cosine) = quarter_sin_cos(self.0 & ((1 << 30) - 1));
        let (sine, cosine) = match self.0 >> 30 {
            0 => (sine, cosine),
            1 => (cosine, -sine),
            2 => (-sine, -cosine),
            _ => (-cosine, sine),
        };
        (I2F30::from_bits(sine), I2F30::from_bits(cosine))
    }
}

/// Sine and cosine, Q2.30, of an angle below a quarter turn.
///
/// From the table's point below, by the addition theorem with a third-order step:
/// sin(a + d) = sin a · cos d + cos a · sin d. The step is at most π/512, so what is left out
/// (d⁴/24) is below 6·10⁻¹¹.
fn quarter_sin_cos(angle: u32) -> (i32, i32) {
    let index = (angle >> FRACTION_BITS) as usize;
    let fraction = i64::from(angle & ((1 << FRACTION_BITS) - 1));
    let (sine, cosine) = (i64::from(SINE[index]), i64::from(SINE[SEGMENTS - index]));
    // The step and its sine and cosine in Q32: two bits more than the result.
    let step = (fraction * HALF_PI) >> 28;
    let step_squared = (step * step) >> 32;
    let cos_step = (1 << 32) - (step_squared >> 1);
    let sin_step = step - ((step_squared * step / 6) >> 32);
    let round = |product: i64| ((product + (1 << 31)) >> 32) as i32;
    (round(sine * cos_step + cosine * sin_step), round(cosine * cos_step - sine * sin_step))
}

const fn sine_table() -> [i32; SEGMENTS + 1] {
    let mut table = [0; SEGMENTS + 1];
    let mut index = 0;
    while index <= SEGMENTS {
        let x = core::f64::consts::FRAC_PI_2 * index as f64 / SEGMENTS as f64;
        // Taylor's series; at x ≤ π/2 the term after x¹⁹ is below 10⁻¹⁵.
        let (mut sum, mut term, mut order) = (0.0, x, 1.0);
        while order < 21.0 {
            sum += term;
            term = -term * x * x / ((order + 1.0) * (order + 2.0));
            order += 2.0;
        }
        table[index] = (sum * (1u64 << 30) as f64 + 0.5) as i32;
        index += 1;
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sine_and_cosine_are_within_2_to_the_minus_29() {
        let mut worst = 0.0f64;
        for sample in 0..2_000_003u32 {
            let bits = sample.wrapping_mul(2_147_483).wrapping_mul(1009);
            let exact = f64::from(bits) / 4_294_967_296.0 * core::f64::consts::TAU;
            let (sine, cosine) = Angle::from_bits(bits).sin_cos();
            worst = worst.max((sine.to_num::<f64>() - exact.sin()).abs());
            worst = worst.max((cosine.to_num::<f64>() - exact.cos()).abs());
        }
        assert!(worst < 2.0f64.powi(-29), "worst error {worst:e}");
    }

    #[test]
    fn the_quarters_are_exact() {
        let of = |angle: Angle| (angle.sin_cos().0.to_bits(), angle.sin_cos().1.to_bits());
        let one = 1 << 30;
        assert_eq!(of(Angle::ZERO), (0, one));
        assert_eq!(of(Angle::QUARTER), (one, 0));
        assert_eq!(of(Angle::HALF), (0, -one));
        assert_eq!(of(Angle::QUARTER.negated()), (-one, 0));
    }

    #[test]
    fn degrees_turn_into_the_nearest_unit() {
        for degrees in [-32_768.0, -720.5, -90.0, -0.000_02, 0.0, 1.0, 45.0, 359.999_99, 32_767.9] {
            let degrees = I16F16::from_num(degrees);
            let turns = degrees.to_num::<f64>() / 360.0;
            let exact = (turns - turns.floor()) * 4_294_967_296.0;
            let distance = (f64::from(Angle::from_degrees(degrees).to_bits()) - exact).abs();
            assert!(distance.min(4_294_967_296.0 - distance) <= 0.500_001, "{degrees}: off by {distance}");
        }
        assert_eq!(Angle::from_degrees(I16F16::from_num(90)), Angle::QUARTER);
    }
}
