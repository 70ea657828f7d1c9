//! The numbers that the rules are made of.
//!
//! A round takes a minute. A target is worth 100 points when it appears and less by and by, down to 20 after six
//! seconds. Reached within three it raises the combo by one, up to 5, and each target counts that many times; a slower
//! one sets it back to 1. After every third target the plate is smaller, the targets too, and it tilts more
//! strongly. A fall ends the combo and costs a second and two more.

use fixed::types::I16F16;

use crate::STEPS_PER_SECOND;
use crate::number::Number;

/// Steps of a round.
pub const ROUND_STEPS: u32 = 60 * STEPS_PER_SECOND;
/// Steps from the first tilt to the start.
pub const COUNTDOWN_STEPS: u32 = 3 * STEPS_PER_SECOND / 2;
/// Steps that a ball falls.
pub const FALL_STEPS: u32 = STEPS_PER_SECOND;
/// Steps that a fall takes from the clock besides.
pub const FALL_COST_STEPS: u32 = 2 * STEPS_PER_SECOND;

/// What a target is worth when it appears.
pub const VALUE_MOST: u32 = 100;
/// What it is worth after [`VALUE_STEPS`].
pub const VALUE_LEAST: u32 = 20;
/// Steps until it is worth the least.
pub const VALUE_STEPS: u32 = 6 * STEPS_PER_SECOND;
/// Steps within which a target raises the combo.
pub const QUICK_STEPS: u32 = 3 * STEPS_PER_SECOND;
/// Highest combo.
pub const COMBO_MAXIMUM: u32 = 5;

/// From a target's rim to the plate's, at least: a plate that gets smaller leaves a ball on a target where it is.
pub const TARGET_MARGIN: Number = Number::lit("0.12");
/// From the ball to the middle of a new target, at least.
pub const TARGET_DISTANCE: Number = Number::lit("0.7");

/// How hard it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Level {
    /// From the plate's middle to its rim.
    pub half_side: Number,
    /// A target's radius.
    pub target_radius: Number,
    /// The strongest tilt, in degrees.
    pub strongest: I16F16,
}

/// Targets that it takes to the next level.
pub const LEVEL_TARGETS: u32 = 3;
/// The last level; it goes on to the end.
pub const LEVEL_MAXIMUM: u32 = 7;
/// Half the side of the largest plate.
pub const HALF_SIDE_MAXIMUM: Number = Number::lit("1.3");

impl Level {
    /// Returns the level after so many targets.
    #[must_use]
    pub fn after(targets: u32) -> Self {
        let number = (targets / LEVEL_TARGETS).min(LEVEL_MAXIMUM) as i32;
        Self {
            half_side: HALF_SIDE_MAXIMUM - const { Number::lit("0.05") } * number,
            target_radius: const { Number::lit("0.25") } - const { Number::lit("0.015") } * number,
            strongest: const { I16F16::lit("10") } + I16F16::from_num(number),
        }
    }
}
