//! Targets: where they appear, and what they are worth.

use crate::number::{Number, between, length};
use crate::rules;

/// A target.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Target {
    /// Its middle.
    pub place: [Number; 2],
    /// Its radius.
    pub radius: Number,
    /// Steps since it appeared.
    pub age: u32,
}

impl Target {
    /// Returns whether a ball that touches the plate here has reached it.
    #[must_use]
    pub fn is_reached(&self, ball: [Number; 2]) -> bool {
        length(between(ball, self.place)) <= self.radius
    }

    /// Returns what it is worth now: the most when it appears, falling evenly to the least.
    #[must_use]
    pub fn value(&self) -> u32 {
        let lost = (rules::VALUE_MOST - rules::VALUE_LEAST) * self.age.min(rules::VALUE_STEPS) / rules::VALUE_STEPS;
        rules::VALUE_MOST - lost
    }
}

/// Places targets, the same ones for the same seed: xorshift of 32 bits (Marsaglia 2003).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Generator(u32);

/// Tries to find a place far from the ball; so many fail once in millions of targets, and the last is good enough.
const TRIES: u32 = 24;

impl Generator {
    /// Returns the generator of a seed.
    #[must_use]
    pub fn new(seed: u32) -> Self {
        // Marsaglia's state must not be 0; neighbouring seeds should not look alike.
        Self(seed.wrapping_mul(0x9E37_79B9) | 1)
    }

    fn next(&mut self) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0
    }

    /// A number from −`limit` to `limit`.
    fn within(&mut self, limit: Number) -> Number {
        let width = 2 * limit.to_bits() as u64 + 1;
        let part = (u64::from(self.next()) * width) >> 32;
        Number::from_bits(part as i32 - limit.to_bits())
    }

    /// Returns the next target of a level: wholly on its plate, and away from the ball.
    pub fn target(&mut self, level: &rules::Level, ball: [Number; 2]) -> Target {
        let limit = level.half_side - level.target_radius - rules::TARGET_MARGIN;
        let mut place = [Number::ZERO; 2];
        for _ in 0..TRIES {
            place = [self.within(limit), self.within(limit)];
            if length(between(place, ball)) >= rules::TARGET_DISTANCE {
                break;
            }
        }
        Target { place, radius: level.target_radius, age: 0 }
    }
}
