//! What the keyboard does to the state.

use crate::key_axes::KeyAxes;
use crate::request::Requests;
use crate::{Buttons, KeyAction, KeyAxis, KeyboardReport, Request, Stick, key_action};

/// The keys that are down, as usages, 0 for none. Room for the panel's, of which there are more than
/// a keyboard's report has; modifiers do nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Keys(pub(crate) [u8; 8]);

impl From<KeyboardReport> for Keys {
    fn from(report: KeyboardReport) -> Self {
        let mut keys = Self::default();
        for (key, usage) in keys.0.iter_mut().zip(report.usages) {
            *key = usage;
        }
        keys
    }
}

/// Keeps what the keys that are down do, and what those that were tapped in this frame did.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct KeyboardState {
    keys: Keys,
    pub(crate) held: Buttons,
    axes: KeyAxes,
    /// Those that went down in this frame, even if they are up again: a tap is one frame's step,
    /// however short.
    axes_pressed: KeyAxes,
}

impl KeyboardState {
    /// Takes in the keys that are down and tells whether they differ from the last ones.
    pub(crate) fn update(&mut self, keys: Keys) -> bool {
        if keys == self.keys {
            return false;
        }
        let mut next = Self { keys, axes_pressed: self.axes_pressed, ..Self::default() };
        for action in keys.0.into_iter().filter_map(key_action) {
            match action {
                KeyAction::Button(button) => next.held |= button.into(),
                KeyAction::Axis(axis) => next.axes.insert(axis),
            }
        }
        next.axes_pressed = next.axes_pressed.union(next.axes.without(self.axes));
        *self = next;
        true
    }

    /// Returns the directions that count in this frame.
    fn pushed(&self) -> KeyAxes {
        self.axes.union(self.axes_pressed)
    }

    /// Returns where the left stick would be for the pan keys.
    pub(crate) fn left_stick(&self) -> Stick {
        let pushed = self.pushed();
        Stick {
            x: pushed.deflection(KeyAxis::PanRight, KeyAxis::PanLeft),
            y: pushed.deflection(KeyAxis::PanUp, KeyAxis::PanDown),
        }
    }

    /// Returns where the right stick would be for the turn and zoom keys.
    pub(crate) fn right_stick(&self) -> Stick {
        let pushed = self.pushed();
        Stick {
            x: pushed.deflection(KeyAxis::TurnRight, KeyAxis::TurnLeft),
            y: pushed.deflection(KeyAxis::ZoomIn, KeyAxis::ZoomOut),
        }
    }

    /// Returns where the arrow keys point.
    pub(crate) fn arrows(&self) -> Stick {
        let pushed = self.pushed();
        Stick {
            x: pushed.deflection(KeyAxis::RollRight, KeyAxis::RollLeft),
            y: pushed.deflection(KeyAxis::PitchUp, KeyAxis::PitchDown),
        }
    }

    /// Returns which way the arrows turn roll and pitch: −1, 0 or 1 each.
    pub(crate) fn turning(&self) -> [i32; 2] {
        let pushed = self.pushed();
        [pushed.balance(KeyAxis::RollLeft, KeyAxis::RollRight), pushed.balance(KeyAxis::PitchUp, KeyAxis::PitchDown)]
    }

    /// Returns the steps that the keys that are down ask for.
    pub(crate) fn requests(&self) -> Requests {
        let asks = [
            (KeyAxis::RollLeft, Request::Left),
            (KeyAxis::RollRight, Request::Right),
            (KeyAxis::PitchUp, Request::Up),
            (KeyAxis::PitchDown, Request::Down),
            (KeyAxis::ZoomIn, Request::Nearer),
            (KeyAxis::ZoomOut, Request::Farther),
        ];
        asks.into_iter().filter(|(axis, _)| self.axes.contains(*axis)).map(|(_, request)| request).collect()
    }

    /// Forgets the directions that are up again.
    pub(crate) fn end_frame(&mut self) {
        self.axes_pressed = KeyAxes::default();
    }
}
