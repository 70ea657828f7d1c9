//! What pad, sticks and keys say, as the game wants it.
//!
//! A hand holds a pad some way off level and the game wants all of its range: the pad's tilt counts in full at 30°.
//! Sticks, the D-pad and the arrow keys point where the ball is to roll, and let go they level the plate. The pad's
//! tilt counts while the pad is what moved last.

use controls::{Button, ControllerState, Source};
use fixed::types::{I2F14, I16F16};
use game::Steer;

/// The tilt of a pad that counts in full, in degrees.
const FULL: I16F16 = I16F16::lit("30");

/// Returns which way the player tilts the plate.
#[must_use]
pub fn steer(state: &ControllerState) -> Steer {
    let held = |button: Button| I16F16::from_num(u8::from(state.held.contains(button)));
    let stick = |of: I2F14| I16F16::from(of);
    let mut right = stick(state.left_stick.x) + stick(state.arrows.x) + held(Button::Right) - held(Button::Left);
    let mut near = -(stick(state.left_stick.y) + stick(state.arrows.y)) + held(Button::Down) - held(Button::Up);
    if state.last_moved == Some(Source::DualShock3) {
        right -= state.tilt.roll / FULL;
        near += state.tilt.pitch / FULL;
    }
    let [right, near] = [right, near].map(|part| I2F14::from_num(part.clamp(I16F16::NEG_ONE, I16F16::ONE)));
    Steer { right, near }
}
