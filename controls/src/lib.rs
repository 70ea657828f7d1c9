//! Turns reports of a DualShock 3, a USB keyboard, a board's own buttons or a serial line into one
//! [`ControllerState`].
//!
//! The crate reads bytes that somebody else fetched and stands on no bus, clock or board. Integers
//! throughout, but for the stick's response curve.
//!
//! ```
//! use controls::{Button, Config, Controls, KeyboardReport};
//!
//! let mut controls = Controls::new(Config::default());
//! let space = KeyboardReport { modifiers: 0, usages: [0x2C, 0, 0, 0, 0, 0] };
//! controls.accept_keyboard(&space.to_bytes())?;     // whenever a report comes in
//! let state = controls.state();                     // once a frame: draw from this,
//! assert!(state.frozen && state.pressed.contains(Button::Cross));
//! controls.end_frame();                             // then forget the edges
//! # Ok::<(), controls::ReportError>(())
//! ```
//!
//! # What each control does
//!
//! | control | DualShock 3 | keyboard | effect |
//! | --- | --- | --- | --- |
//! | roll | lean it left, right | Left, Right arrow | [`tilt.roll`](Tilt::roll): the model leans; keys up to ±90°, kept on release |
//! | pitch | raise, lower its far edge | Up, Down arrow | [`tilt.pitch`](Tilt::pitch): the model nods; keys up to ±90°, kept on release |
//! | pan | left stick | A, D; W, S | [`pan()`](ControllerState::pan): the model moves across the screen |
//! | turn | right stick, left–right | Q, E | [`turn()`](ControllerState::turn): the model spins about its upright axis |
//! | zoom | right stick, up–down | `+` `-`, Page Up/Down, Z X | [`zoom()`](ControllerState::zoom): nearer, farther |
//! | freeze | Cross | Space | [`frozen`](ControllerState::frozen): the pose stays while it is held |
//! | next scene | Start | Enter, keypad Enter | a press |
//! | previous scene | Select | Backspace | a press |
//! | reset pose | R3 (push the right stick) | R | the tilt is level again, at once; pan, turn and zoom as at the start |
//! | centre | L3 (push the left stick) | F | pan, turn and zoom are as at the start; nothing in the game, which the stick steers |
//! | next style | Triangle | Tab | flat, smooth, wireframe, hidden lines, depth as grey |
//! | projection | Square | V | perspective or orthographic |
//! | other mode | Circle; R1 while held | C; 2 while held | what the scene has two of: orbit and flight, turning and moving |
//! | steps | D-pad; R2, L2 | arrows or I J K L; zoom keys or 4, 3 | [`asked`](ControllerState::asked): one step a frame, the first asked for first |
//! | legend | PS | H, ?, Escape | the console tells what each key does |
//! | no effect yet | L1 | 1 | read and reported; the viewer has no use for it yet |
//!
//! Freezing, levelling and the turning of the tilt by arrow keys happen in this crate; the effect of
//! every other control is the viewer's, in `scenes`. The DE1-SoC's own keys and switches do what the
//! keyboard's do; [`PanelReport`] has the table. Keys typed at a terminal on the serial line are the keyboard's, too
//! ([`serial::Typed`]).
//!
//! # How several sources make one state
//!
//! Pad, keyboard and panel are kept apart and merged: buttons are held if any holds them, sticks add up
//! to at most ±1, and the **tilt belongs to the source that moved last**. A pad moves by more than
//! the dead zone in any axis of its accelerometer; a keyboard or the panel moves by an arrow or R. Arrow keys
//! turn on from the tilt that is shown. [`Controls::disconnect`] lets go of one source's buttons and
//! sticks, and leaves the tilt where it is.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod acceleration;
mod battery;
mod button;
mod config;
mod controls;
mod cordic;
mod dualshock3;
mod edges;
mod key_axes;
mod keyboard;
mod keyboard_state;
mod keymap;
mod low_pass;
mod pad_state;
mod panel;
mod report;
mod report_error;
mod request;
pub mod serial;
mod source;
mod state;
mod stick;
mod tilt;

pub use acceleration::Acceleration;
pub use battery::Battery;
pub use button::{Button, Buttons};
pub use config::Config;
pub use controls::Controls;
pub use dualshock3::DualShock3Report;
pub use key_axes::KeyAxis;
pub use keyboard::KeyboardReport;
pub use keymap::{KeyAction, key_action};
pub use low_pass::LowPass;
pub use panel::PanelReport;
pub use report::Report;
pub use report_error::ReportError;
pub use request::Request;
pub use source::Source;
pub use state::ControllerState;
pub use stick::{Stick, StickResponse};
pub use tilt::Tilt;
