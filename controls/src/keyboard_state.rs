//! What the keyboard does to the state.

use crate::key_axes::KeyAxes;
use crate::{Buttons, KeyAction, KeyAxis, KeyboardReport, Stick, key_action};

/// Keeps what the keys that are down do, and what those that were tapped in this frame did.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct KeyboardState {
    report: KeyboardReport,
    pub(crate) held: Buttons,
    axes: KeyAxes,
    /// Those that went down in this frame, even if they are up again: a tap is one frame's step,
    /// however short.
    axes_pressed: KeyAxes,
}

impl KeyboardState {
    /// Takes in a report and tells whether it differs from the last one.
    pub(crate) fn update(&mut self, report: KeyboardReport) -> bool {
        if report == self.report {
            return false;
        }
        let mut next = Self { report, axes_pressed: self.axes_pressed, ..Self::default() };
        for action in report.held().filter_map(key_action) {
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

    /// Returns which way the arrows turn roll and pitch: −1, 0 or 1 each.
    pub(crate) fn turning(&self) -> [i32; 2] {
        let pushed = self.pushed();
        [pushed.balance(KeyAxis::RollLeft, KeyAxis::RollRight), pushed.balance(KeyAxis::PitchUp, KeyAxis::PitchDown)]
    }

    /// Forgets the directions that are up again.
    pub(crate) fn end_frame(&mut self) {
        self.axes_pressed = KeyAxes::default();
    }
}
