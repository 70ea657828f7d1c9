//! Keys typed at a terminal, on a line that has carried no frame yet.

/// Finds keys in the characters that a terminal sends.
///
/// A terminal says which key was pressed and not when it is let go; while one is held it says so again and again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Typed {
    before: Before,
}

/// What came before: of an arrow key's characters, which are Escape, `[` or `O`, a letter; or the first of two that
/// end a line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Before {
    #[default]
    Nothing,
    Escape,
    Bracket,
    Return,
}

impl Typed {
    /// Starts with nothing typed.
    #[must_use]
    pub const fn new() -> Self {
        Self { before: Before::Nothing }
    }

    /// Takes the next character, and returns the usage of the key on a USB keyboard that this one completes
    /// (HID Usage Tables 1.12, page 0x07), if it is a key.
    pub fn feed(&mut self, character: u8) -> Option<u8> {
        let before = core::mem::take(&mut self.before);
        match (before, character) {
            (_, 0x1B) => {
                self.before = Before::Escape;
                None
            }
            (Before::Escape, b'[' | b'O') => {
                self.before = Before::Bracket;
                None
            }
            (Before::Bracket, b'A') => Some(0x52),
            (Before::Bracket, b'B') => Some(0x51),
            (Before::Bracket, b'C') => Some(0x4F),
            (Before::Bracket, b'D') => Some(0x50),
            (Before::Bracket, _) | (Before::Return, b'\n') => None,
            (_, character) => {
                if character == b'\r' {
                    self.before = Before::Return;
                }
                usage(character)
            }
        }
    }
}

/// Returns the usage of the key that a character stands on.
const fn usage(character: u8) -> Option<u8> {
    Some(match character {
        b'a'..=b'z' => character - b'a' + 0x04,
        b'A'..=b'Z' => character - b'A' + 0x04,
        b'1'..=b'9' => character - b'1' + 0x1E,
        b'\r' | b'\n' => 0x28,
        // Backspace sends either, by the terminal.
        0x08 | 0x7F => 0x2A,
        b'\t' => 0x2B,
        b' ' => 0x2C,
        b'-' => 0x2D,
        b'+' | b'=' => 0x2E,
        b'?' | b'/' => 0x38,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Button, KeyAction, KeyAxis, key_action};
    use std::vec::Vec;

    fn actions(typed: &[u8]) -> Vec<Option<KeyAction>> {
        let mut keys = Typed::new();
        typed.iter().filter_map(|character| keys.feed(*character)).map(key_action).collect()
    }

    #[test]
    fn each_key_of_the_legend_can_be_typed() {
        use KeyAction::{Axis, Button as Press};
        let buttons = [
            (&b"\r"[..], Button::Start),
            (b"\n", Button::Start),
            (b"\r\n", Button::Start),
            (b"\x08", Button::Select),
            (b"\x7f", Button::Select),
            (b"\t", Button::Triangle),
            (b"v", Button::Square),
            (b"C", Button::Circle),
            (b"2", Button::R1),
            (b" ", Button::Cross),
            (b"r", Button::R3),
            (b"f", Button::L3),
            (b"h", Button::Ps),
            (b"?", Button::Ps),
        ];
        for (typed, button) in buttons {
            assert_eq!(actions(typed), [Some(Press(button))], "{typed:?}");
        }
        let axes = [
            (&b"\x1b[A"[..], KeyAxis::PitchUp),
            (b"\x1bOB", KeyAxis::PitchDown),
            (b"\x1b[C", KeyAxis::RollRight),
            (b"\x1b[D", KeyAxis::RollLeft),
            (b"w", KeyAxis::PanUp),
            (b"q", KeyAxis::TurnLeft),
            (b"+", KeyAxis::ZoomIn),
            (b"-", KeyAxis::ZoomOut),
        ];
        for (typed, axis) in axes {
            assert_eq!(actions(typed), [Some(Axis(axis))], "{typed:?}");
        }
    }

    #[test]
    fn what_is_no_key_is_nothing_and_the_next_key_is_heard() {
        for nothing in [&b"\x1b"[..], b"\x1b[", b"\x1b[5", b"\xc3\xa4", b"\x01", b"!"] {
            assert_eq!(actions(nothing), [], "{nothing:?}");
        }
        assert_eq!(actions(b"\x1b\x1b[A\x1b[Zv"), actions(b"\x1b[Av"));
    }
}
