//! The plate: it follows the player's hand, and turns gravity into a pull along itself.

use fixed::types::{I2F14, I16F16};
use geometry::Angle;

use crate::number::Number;

/// Which way the player tilts, as a part of the strongest tilt: −1 to 1; what is beyond counts as that.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Steer {
    /// The right side down.
    pub right: I2F14,
    /// The near edge down.
    pub near: I2F14,
}

/// How the plate lies, in degrees.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Plate {
    /// About the axis to the player: positive with the left side down.
    pub roll: I16F16,
    /// About the axis from left to right: positive with the far edge up.
    pub pitch: I16F16,
}

/// What gravity does on the plate, as parts of its whole strength.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pull {
    /// Along the plate, to x and to z.
    pub along: [Number; 2],
    /// Onto the plate.
    pub onto: Number,
}

/// What the plate turns by in a step, at most: 90° a second.
const RATE: I16F16 = I16F16::lit("0.75");

impl Plate {
    /// Not tilted.
    pub const LEVEL: Self = Self { roll: I16F16::ZERO, pitch: I16F16::ZERO };

    /// Follows the hand for a step; `strongest` is the strongest tilt, in degrees.
    pub fn follow(&mut self, steer: Steer, strongest: I16F16) {
        let wanted = |part: I2F14| I16F16::from(part.clamp(I2F14::NEG_ONE, I2F14::ONE)) * strongest;
        let follow = |now: I16F16, wanted: I16F16| now + (wanted - now).clamp(-RATE, RATE);
        self.roll = follow(self.roll, -wanted(steer.right));
        self.pitch = follow(self.pitch, wanted(steer.near));
    }

    /// Returns what gravity does on the plate.
    ///
    /// The plate is turned by its roll about z and then by its pitch about x: so what points down in space is
    /// (−cos p · sin r, −cos p · cos r, sin p) in the plate's own axes.
    #[must_use]
    pub fn pull(&self) -> Pull {
        let [(roll_sine, roll_cosine), (pitch_sine, pitch_cosine)] =
            [self.roll, self.pitch].map(|degrees| Angle::from_degrees(degrees).sin_cos());
        // Q30 · Q30, rounded half up to Q24.
        let product = |a: i32, b: i32| Number::from_bits(((i64::from(a) * i64::from(b) + (1 << 35)) >> 36) as i32);
        let [rs, rc, ps, pc] = [roll_sine, roll_cosine, pitch_sine, pitch_cosine].map(|part| part.to_bits());
        Pull { along: [-product(pc, rs), product(ps, 1 << 30)], onto: product(pc, rc) }
    }
}
