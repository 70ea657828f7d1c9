//! What the pad's accelerometer says.

use fixed::types::I24F8;

/// Holds an acceleration in the pad's axes, in counts: 113 counts are 1 g, ±512 the range.
///
/// Source: Linux `hid-sony.c` (113 counts per g) and SDL `SDL_hidapi_ps3.c` (zero at 511). Samples of
/// a pad at rest have a length of 0.99 g on that scale.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Acceleration {
    /// Sideways: positive with the right side up.
    pub x: I24F8,
    /// Lengthwise: positive with the far edge up, as of a pad that lies on its triggers.
    pub y: I24F8,
    /// Through the face: +113 with the face up, −113 with the face down.
    pub z: I24F8,
}

impl Acceleration {
    /// Counts that gravity alone gives.
    pub const COUNTS_PER_G: i32 = 113;
    /// A pad that lies level with its face up.
    pub const LEVEL: Self = Self { x: I24F8::ZERO, y: I24F8::ZERO, z: I24F8::const_from_int(Self::COUNTS_PER_G) };
    const ZERO_G: i32 = 511;
    const RAW_MAXIMUM: i32 = 1023;

    /// Reads the report's three words (bytes 41 to 46, big endian), of ten bits each. A word beyond
    /// ten bits counts as 1023.
    #[must_use]
    pub fn from_raw([x, y, z]: [u16; 3]) -> Self {
        let raw = |word: u16| i32::from(word).min(Self::RAW_MAXIMUM);
        let counts = |value: i32| I24F8::from_bits(value << I24F8::FRAC_NBITS);
        Self { x: counts(raw(x) - Self::ZERO_G), y: counts(Self::ZERO_G - raw(y)), z: counts(Self::ZERO_G - raw(z)) }
    }

    /// Returns the three words of the report, the counts rounded and kept within ten bits.
    #[must_use]
    pub fn to_raw(self) -> [u16; 3] {
        let counts = |value: I24F8| value.saturating_round().to_num::<i32>();
        let raw = |value: i32| value.clamp(0, Self::RAW_MAXIMUM) as u16;
        [raw(Self::ZERO_G + counts(self.x)), raw(Self::ZERO_G - counts(self.y)), raw(Self::ZERO_G - counts(self.z))]
    }

    /// Applies a function to each axis of two.
    pub(crate) fn zip(self, other: Self, function: impl Fn(I24F8, I24F8) -> I24F8) -> Self {
        Self { x: function(self.x, other.x), y: function(self.y, other.y), z: function(self.z, other.z) }
    }

    /// Tells whether any axis differs from another's by more than this.
    pub(crate) fn differs_by_more_than(self, other: Self, counts: I24F8) -> bool {
        let apart = self.zip(other, |one, two| one.saturating_sub(two).saturating_abs());
        apart.x > counts || apart.y > counts || apart.z > counts
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for Acceleration {
    fn format(&self, formatter: defmt::Formatter<'_>) {
        let [x, y, z] = [self.x, self.y, self.z].map(I24F8::to_bits);
        defmt::write!(formatter, "Acceleration {{ {}, {}, {} }}/256 counts", x, y, z);
    }
}

#[cfg(test)]
mod tests {
    use super::Acceleration;

    #[test]
    fn pads_at_rest_feel_one_g() {
        for raw in [[503, 492, 400], [514, 493, 401]] {
            let at_rest = Acceleration::from_raw(raw);
            let [x, y, z] = [at_rest.x, at_rest.y, at_rest.z].map(|axis| axis.to_num::<f64>() / 113.0);
            let length = (x * x + y * y + z * z).sqrt();
            assert!((0.98..1.01).contains(&length), "{raw:?} is {length} g");
            assert!(y > 0.0 && z > 0.9);
        }
    }

    #[test]
    fn words_survive_both_ways_and_stay_within_ten_bits() {
        for word in 0..=1023 {
            assert_eq!(Acceleration::from_raw([word, 1023 - word, word]).to_raw(), [word, 1023 - word, word]);
        }
        let beyond = Acceleration::from_raw([0xFFFF, 1024, 0]);
        assert_eq!([beyond.x, beyond.y, beyond.z], [512, -512, 511]);
    }
}
