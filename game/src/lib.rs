//! The Ultimate Ball Balancer: a ball lies on a plate that the player tilts; it must roll over targets and not off.
//!
//! | module | what it holds |
//! | --- | --- |
//! | [`game`] | a round: its phases, score, combo and clock |
//! | [`rules`] | the numbers that the rules are made of, and how the levels get harder |
//! | [`ball`] | how the ball rolls |
//! | [`plate`] | how the plate follows the player's hand, and what it makes gravity do |
//! | [`target`] | where targets appear, and what they are worth |
//! | [`orientation`] | which way round the ball lies |
//! | [`number`] | the numbers that all this is done in |
//!
//! The game knows no screen and no controller, and nothing but integers: the same steps give the same game on every
//! machine. A step is 1/120 s. Places and speeds are along the plate, in metres and metres a second: x to the
//! right, z to the near edge, the plate's middle at 0.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod ball;
pub mod game;
pub mod number;
pub mod orientation;
pub mod plate;
pub mod rules;
pub mod target;

pub use ball::Ball;
pub use game::{Event, Game, Phase};
pub use number::Number;
pub use orientation::Orientation;
pub use plate::{Plate, Steer};
pub use target::Target;

/// Steps in a second.
pub const STEPS_PER_SECOND: u32 = 120;
