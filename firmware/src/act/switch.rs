//! A switch between the two modes of a scene.

use controls::{Button, ControllerState};

/// Which of two modes a scene is in: a press of Circle changes it, R1 gives the other one while it is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Switch {
    changed: bool,
    held: bool,
}

impl Switch {
    /// The first mode.
    pub const FIRST: Self = Self { changed: false, held: false };

    /// Takes in a frame's buttons.
    pub fn update(&mut self, state: &ControllerState) {
        self.changed ^= state.pressed.contains(Button::Circle);
        self.held = state.held.contains(Button::R1);
    }

    /// Returns whether the second mode is on.
    pub fn is_on(self) -> bool {
        self.changed ^ self.held
    }
}
