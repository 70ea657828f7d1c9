//! How the model lies.

use crate::Acceleration;
use crate::cordic::polar;
use fixed::types::{I9F23, I16F16, I24F8};

/// Holds how a pad, or the model that follows it, lies, in degrees.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tilt {
    /// About the axis from the player to the screen, −180 to 180: 0 level, +90 on the left side
    /// (anticlockwise as the player sees it).
    pub roll: I16F16,
    /// About the axis from left to right, −90 to 90: positive with the far edge up.
    pub pitch: I16F16,
}

impl Tilt {
    /// Neither roll nor pitch.
    pub const LEVEL: Self = Self { roll: I16F16::ZERO, pitch: I16F16::ZERO };

    /// Converts an acceleration that is gravity alone to the tilt that shows it.
    ///
    /// roll = atan2(x, z), pitch = atan2(y, hypot(x, z)): exact for any strength of gravity, where
    /// reading the counts as degrees, 90 to the g, is off by up to 19°. Both are within
    /// 2⁻¹⁶ degree (one unit in the last place) of the true value for all that a report can hold.
    /// With x = z = 0 the roll is 0.
    #[must_use]
    pub fn from_acceleration(acceleration: Acceleration) -> Self {
        let [x, y, z] = normalise([acceleration.x, acceleration.y, acceleration.z]);
        let sideways = polar(z, x);
        let lengthwise = polar(sideways.length, y);
        Self { roll: rounded(sideways.angle), pitch: rounded(lengthwise.angle) }
    }

    /// Turns by some degrees, no farther than ±90° on either axis.
    ///
    /// An angle that is beyond already stays, or comes back.
    pub(crate) fn turned(self, roll: I16F16, pitch: I16F16) -> Self {
        Self { roll: turn(self.roll, roll), pitch: turn(self.pitch, pitch) }
    }
}

/// Scales three numbers by one power of two so that the largest has 28 bits.
fn normalise(axes: [I24F8; 3]) -> [i32; 3] {
    let bits = axes.map(I24F8::to_bits);
    let widest = bits.iter().fold(0, |widest, axis| widest | axis.unsigned_abs());
    let (left, right) = match widest.leading_zeros() {
        zeros @ 0..4 => (0, 4 - zeros),
        32 => (0, 0),
        zeros => (zeros - 4, 0),
    };
    bits.map(|axis| axis << left >> right)
}

/// Adds a step to an angle, up to ±90°.
fn turn(angle: I16F16, step: I16F16) -> I16F16 {
    const QUARTER: I16F16 = I16F16::const_from_int(90);
    if step > 0 {
        angle.max(angle.saturating_add(step).min(QUARTER))
    } else {
        angle.min(angle.saturating_add(step).max(-QUARTER))
    }
}

/// Rounds an angle half up.
fn rounded(angle: I9F23) -> I16F16 {
    I16F16::from_bits((angle.to_bits() + (1 << 6)) >> 7)
}

#[cfg(feature = "defmt")]
impl defmt::Format for Tilt {
    fn format(&self, formatter: defmt::Formatter<'_>) {
        let [roll, pitch] = [self.roll, self.pitch].map(I16F16::to_bits);
        defmt::write!(formatter, "Tilt {{ roll {}, pitch {} }}/65536 degree", roll, pitch);
    }
}

#[cfg(test)]
mod tests {
    use super::Tilt;
    use crate::Acceleration;
    use fixed::types::{I16F16, I24F8};

    fn counts(x: i32, y: i32, z: i32) -> Acceleration {
        Acceleration { x: I24F8::from_num(x), y: I24F8::from_num(y), z: I24F8::from_num(z) }
    }

    /// How far a tilt is from the one that float64 finds, in degrees.
    fn off(acceleration: Acceleration) -> f64 {
        let found = Tilt::from_acceleration(acceleration);
        let [x, y, z] = [acceleration.x, acceleration.y, acceleration.z].map(|axis| axis.to_num::<f64>());
        let roll = (found.roll.to_num::<f64>() - x.atan2(z).to_degrees()).abs();
        let pitch = (found.pitch.to_num::<f64>() - y.atan2(x.hypot(z)).to_degrees()).abs();
        roll.min(360.0 - roll).max(pitch)
    }

    const UNIT: f64 = 1.0 / 65_536.0;

    #[test]
    fn every_reading_is_within_a_unit_in_the_last_place() {
        let mut worst = 0.0_f64;
        let axis = || (-512..=512).step_by(9).chain([-113, -1, 0, 1, 113, 511]);
        for x in axis() {
            for z in axis() {
                for y in axis() {
                    worst = worst.max(off(counts(x, y, z)));
                }
            }
        }
        assert!(worst <= UNIT, "{worst} degrees");
    }

    #[test]
    fn every_pair_of_small_counts_and_every_fraction() {
        let mut worst = 0.0_f64;
        for x in -130..=130 {
            for z in -130..=130 {
                worst = worst.max(off(counts(x, x - z, z)));
                let fine = |bits: i32| I24F8::from_bits(bits);
                worst = worst.max(off(Acceleration { x: fine(x), y: fine(3 * z), z: fine(z) }));
                worst = worst.max(off(Acceleration { x: fine(x), y: fine(113 << 8), z: fine(z) }));
            }
        }
        assert!(worst <= UNIT, "{worst} degrees");
    }

    #[test]
    fn any_number_at_all_is_taken() {
        let extremes = [I24F8::MIN, I24F8::MAX, I24F8::DELTA, -I24F8::DELTA, I24F8::ZERO];
        for x in extremes {
            for y in extremes {
                for z in extremes {
                    let tilt = Tilt::from_acceleration(Acceleration { x, y, z });
                    assert!((-180..=180).contains(&tilt.roll.to_num::<i32>()), "{x} {y} {z}");
                    assert!((-90..=90).contains(&tilt.pitch.to_num::<i32>()), "{x} {y} {z}");
                }
            }
        }
        assert_eq!(Tilt::from_acceleration(counts(0, 0, 0)), Tilt::LEVEL);
    }

    #[test]
    fn the_four_sides_are_exact() {
        let roll = |x, z| Tilt::from_acceleration(counts(x, 0, z)).roll;
        assert_eq!([roll(0, 113), roll(113, 0), roll(0, -113), roll(-113, 0)], [0, 90, 180, -90]);
        assert_eq!(Tilt::from_acceleration(counts(0, 113, 0)).pitch, 90);
        assert_eq!(Tilt::from_acceleration(counts(0, -113, 0)).pitch, -90);
    }

    /// Raw readings of the sideways axis and the roll each stands for, from a 113 count g.
    #[test]
    fn known_angles_have_known_readings() {
        for (degrees, raw) in [(0, 511), (10, 531), (30, 568), (45, 591), (60, 609), (90, 624), (-45, 431), (-90, 398)]
        {
            let radians = f64::from(degrees).to_radians();
            let z = (511.0 - 113.0 * radians.cos()).round() as u16;
            let roll = Tilt::from_acceleration(Acceleration::from_raw([raw, 511, z])).roll.to_num::<f64>();
            assert!((roll - f64::from(degrees)).abs() < 0.5, "{raw}: {roll}, not {degrees}");
        }
    }

    #[test]
    fn a_pad_on_its_triggers_has_its_far_edge_up_by_nine_degrees() {
        for raw in [[503, 492, 400], [514, 493, 401]] {
            let tilt = Tilt::from_acceleration(Acceleration::from_raw(raw));
            assert!((8.5..10.0).contains(&tilt.pitch.to_num::<f64>()), "{tilt:?}");
            assert!(tilt.roll.to_num::<f64>().abs() < 4.5, "{tilt:?}");
        }
    }

    #[test]
    fn keys_stop_at_a_right_angle_and_bring_back_what_is_beyond() {
        let roll = |degrees: i32, step: i32| {
            let tilt = Tilt { roll: I16F16::from_num(degrees), ..Tilt::LEVEL };
            tilt.turned(I16F16::from_num(step), I16F16::ZERO).roll.to_num::<i32>()
        };
        assert_eq!([roll(89, 4), roll(90, 4), roll(150, 4), roll(150, -4)], [90, 90, 150, 146]);
        assert_eq!([roll(-89, -4), roll(-90, -4), roll(-150, -4), roll(-150, 4)], [-90, -90, -150, -146]);
        assert_eq!([roll(0, 32_767), roll(0, -32_768), roll(90, -32_768)], [90, -90, -90]);
    }
}
