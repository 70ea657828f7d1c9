//! Digits in front of it all: seven bars each, flat, facing the eye from just behind the near plane.

use fixed::types::I32F32;
use geometry::Matrix;

use super::scenery::{half_height, out_of_the_eye, planes};
use crate::scene::meshes::Shape;
use crate::scene::stage::{Object, Stage};
use crate::style::Manner;

/// Where digits are put up.
#[derive(Debug, Clone, Copy)]
pub struct Signs {
    /// From half heights of the picture, about its middle, to world space.
    to_world: Matrix,
}

/// Half the height of a digit in half heights of the picture: 9 of 120 pixels, and a large one's.
const SMALL: I32F32 = I32F32::lit("0.075");
const LARGE: I32F32 = I32F32::lit("0.17");
/// From a digit's middle to the next one's, in half heights of a digit.
const PITCH: I32F32 = I32F32::lit("1.6");
/// The middle of the outermost digits: to the side, and up.
const CORNER: [I32F32; 2] = [I32F32::lit("1.22"), I32F32::lit("0.87")];
/// The middle of what stands in the picture's middle.
const RAISED: I32F32 = I32F32::lit("0.2");
/// Digits of the time: two, with a zero before a lone one.
const TIME_DIGITS: usize = 2;
/// Most digits of a score.
const SCORE_DIGITS: usize = 5;

impl Signs {
    /// Returns the board in front of a picture.
    pub fn new(manner: Manner) -> Self {
        // Behind the near plane by a hundredth, so that rounding cuts nothing off.
        let distance = planes(manner).0 * const { I32F32::lit("1.01") };
        let half = half_height(manner, distance);
        let to_world = out_of_the_eye()
            .times(&Matrix::translation([I32F32::ZERO, I32F32::ZERO, -distance]))
            .times(&Matrix::scaling([half, half, I32F32::ONE]));
        Self { to_world }
    }

    /// Puts up the score, on the left.
    pub fn score(&self, stage: &mut Stage, score: u32) {
        self.number(stage, score, 1, [-CORNER[0], CORNER[1]], SMALL);
    }

    /// Puts up the score of a round that is over, large in the middle.
    pub fn total(&self, stage: &mut Stage, score: u32) {
        let digits = (score.checked_ilog10().unwrap_or(0) as usize + 1).min(SCORE_DIGITS);
        let left = -PITCH * LARGE * (digits as i64 - 1) / 2;
        self.number(stage, score, 1, [left, RAISED], LARGE);
    }

    /// Puts up what is left of a countdown, large in the middle.
    pub fn count(&self, stage: &mut Stage, count: u32) {
        self.number(stage, count, 1, [I32F32::ZERO, RAISED], LARGE);
    }

    /// Puts up the seconds that are left, on the right.
    pub fn time(&self, stage: &mut Stage, seconds: u32) {
        let left = CORNER[0] - PITCH * SMALL * (TIME_DIGITS as i64 - 1);
        self.number(stage, seconds, TIME_DIGITS, [left, CORNER[1]], SMALL);
    }

    /// Puts up a number of at least so many digits; `at` is its first digit's middle.
    fn number(&self, stage: &mut Stage, number: u32, least: usize, at: [I32F32; 2], size: I32F32) {
        let largest = 10u32.pow(SCORE_DIGITS as u32) - 1;
        let mut rest = number.min(largest);
        let count = (rest.checked_ilog10().unwrap_or(0) as usize + 1).max(least);
        for place in (0..count).rev() {
            let x = at[0] + PITCH * size * place as i64;
            let model = self.to_world.times(&Matrix::translation([x, at[1], I32F32::ZERO])).times(&Matrix::scaling([
                size,
                size,
                I32F32::ONE,
            ]));
            // There is room for all of them.
            let _ = stage.objects.push(Object::new(Shape::DIGITS[(rest % 10) as usize], model));
            rest /= 10;
        }
    }
}
