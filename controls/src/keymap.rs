//! What each key does.

use crate::{Button, KeyAxis};

/// Tells what a key stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum KeyAction {
    /// It holds a button.
    Button(Button),
    /// It pushes the tilt or a stick.
    Axis(KeyAxis),
}

/// Returns what a key does, or `None` for one that does nothing.
///
/// A key is named by its usage on page 0x07 of the HID Usage Tables, which tells its place on the
/// keyboard, with the letters of an American one.
#[must_use]
pub const fn key_action(usage: u8) -> Option<KeyAction> {
    use KeyAction::{Axis, Button as Press};
    Some(match usage {
        0x50 => Axis(KeyAxis::RollLeft),         // Left Arrow
        0x4F => Axis(KeyAxis::RollRight),        // Right Arrow
        0x52 => Axis(KeyAxis::PitchUp),          // Up Arrow
        0x51 => Axis(KeyAxis::PitchDown),        // Down Arrow
        0x04 => Axis(KeyAxis::PanLeft),          // A
        0x07 => Axis(KeyAxis::PanRight),         // D
        0x1A => Axis(KeyAxis::PanUp),            // W
        0x16 => Axis(KeyAxis::PanDown),          // S
        0x14 => Axis(KeyAxis::TurnLeft),         // Q
        0x08 => Axis(KeyAxis::TurnRight),        // E
        0x2E | 0x57 => Axis(KeyAxis::ZoomIn),    // = and +, keypad +
        0x4B | 0x1D => Axis(KeyAxis::ZoomIn),    // Page Up, Z
        0x2D | 0x56 => Axis(KeyAxis::ZoomOut),   // -, keypad -
        0x4E | 0x1B => Axis(KeyAxis::ZoomOut),   // Page Down, X
        0x2C => Press(Button::Cross),            // Space
        0x28 | 0x58 => Press(Button::Start),     // Enter, keypad Enter
        0x2A => Press(Button::Select),           // Backspace
        0x2B => Press(Button::Triangle),         // Tab
        0x06 => Press(Button::Circle),           // C
        0x19 => Press(Button::Square),           // V
        0x15 => Press(Button::R3),               // R
        0x09 => Press(Button::L3),               // F
        0x0C => Press(Button::Up),               // I
        0x0E => Press(Button::Down),             // K
        0x0D => Press(Button::Left),             // J
        0x0F => Press(Button::Right),            // L
        0x1E => Press(Button::L1),               // 1
        0x1F => Press(Button::R1),               // 2
        0x20 => Press(Button::L2),               // 3
        0x21 => Press(Button::R2),               // 4
        0x29 | 0x0B | 0x38 => Press(Button::Ps), // Escape, H, / and ?
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::{KeyAction, key_action};
    use crate::{Button, Buttons};

    #[test]
    fn every_button_has_a_key() {
        let reached: Buttons = (0..=255)
            .filter_map(|usage| match key_action(usage) {
                Some(KeyAction::Button(button)) => Some(button),
                _ => None,
            })
            .collect();
        assert_eq!(reached, Buttons::ALL);
    }

    #[test]
    fn letters_are_at_their_usages() {
        let letter = |letter: u8| key_action(letter - b'A' + 0x04);
        assert_eq!(letter(b'R'), Some(KeyAction::Button(Button::R3)));
        assert_eq!(letter(b'C'), Some(KeyAction::Button(Button::Circle)));
        assert_eq!(letter(b'V'), Some(KeyAction::Button(Button::Square)));
        assert_eq!(letter(b'F'), Some(KeyAction::Button(Button::L3)));
        for used in b"ACDEFHIJKLQRSVWXZ" {
            assert!(letter(*used).is_some(), "{}", char::from(*used));
        }
        for free in b"BGMNOPTUY" {
            assert!(letter(*free).is_none(), "{}", char::from(*free));
        }
    }

    #[test]
    fn no_error_code_and_no_modifier_does_anything() {
        assert!((0..=3).chain(0xE0..=0xFF).all(|usage| key_action(usage).is_none()));
    }
}
