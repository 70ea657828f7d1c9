//! How the ball rolls.
//!
//! A solid ball that rolls without slipping down a slope of angle θ gains 5/7 · g · sin θ a second: its moment of
//! inertia, 2/5 · m · r², takes the rest (Halliday, Resnick and Walker, *Fundamentals of Physics*, "Rolling": a =
//! g sin θ / (1 + I/(m r²))). Rolling resistance takes a constant share of what presses it onto the plate, against
//! the way it rolls; a ball at rest stays until the pull is stronger. That the plate itself turns meanwhile is left
//! out.

use crate::number::{Number, length, product, share};
use crate::orientation::Orientation;
use crate::plate::Pull;

/// The ball.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ball {
    /// Where it touches the plate.
    pub place: [Number; 2],
    /// How fast it rolls.
    pub velocity: [Number; 2],
    /// Which way round it lies.
    pub orientation: Orientation,
}

/// The ball's radius.
pub const RADIUS: Number = Number::lit("0.1");
/// 5/7 of standard gravity, 9.80665 m/s², for a step: what the speed gains on an upright plate.
const GAIN: Number = Number::lit("0.0583729");
/// Rolling resistance as a part of what presses the ball on: it holds a ball on a slope of 1°.
const RESISTANCE: Number = Number::lit("0.0175");
/// Speed that is never exceeded, on either axis: beyond what the slopes of the game can give.
pub const SPEED_MAXIMUM: Number = Number::lit("8");

impl Ball {
    /// At rest in the middle.
    pub const START: Self =
        Self { place: [Number::ZERO; 2], velocity: [Number::ZERO; 2], orientation: Orientation::START };

    /// Rolls for a step.
    pub fn roll(&mut self, pull: Pull) {
        let pulled = [0, 1].map(|axis| self.velocity[axis] + product(pull.along[axis], GAIN));
        let speed = length(pulled);
        let lost = product(product(pull.onto, RESISTANCE), GAIN);
        let slower = speed.saturating_sub(lost).max(Number::ZERO);
        let next = pulled.map(|part| share(part, slower, speed).clamp(-SPEED_MAXIMUM, SPEED_MAXIMUM));
        // The way of a body whose speed changes evenly: the mean speed's.
        let way = [0, 1].map(|axis| way_of(self.velocity[axis] + next[axis]));
        self.orientation.roll(way);
        self.advance(way);
        self.velocity = next;
    }

    /// Flies on for a step: nothing holds it up or back.
    pub fn fly(&mut self) {
        self.advance(self.velocity.map(|speed| way_of(speed + speed)));
    }

    fn advance(&mut self, way: [Number; 2]) {
        for (place, way) in self.place.iter_mut().zip(way) {
            *place = place.saturating_add(way);
        }
    }
}

/// The way of a step, from twice its mean speed: 1/240 of that, rounded half up.
fn way_of(doubled_speed: Number) -> Number {
    Number::from_bits((doubled_speed.to_bits() + 120).div_euclid(240))
}
