//! The PC's keys as a USB keyboard's, and as the board's own.

use minifb::Key;

/// Usage of the left control key; seven more modifiers follow.
pub(super) const FIRST_MODIFIER: u8 = 0xE0;

/// What a function key stands for on the board.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum OnBoard {
    /// Push button KEY0 to KEY3, while it is held.
    Key(u32),
    /// The processor's push button, while it is held.
    HpsKey,
    /// Slide switch SW0 to SW6: each press slides it.
    Switch(u32),
}

/// Returns what a key stands for on the board: F1 to F4 are KEY0 to KEY3, F5 is the HPS key, F6 to
/// F12 are SW0 to SW6.
pub(super) fn on_board(key: Key) -> Option<OnBoard> {
    let number = key as u32;
    Some(match key {
        Key::F1 | Key::F2 | Key::F3 | Key::F4 => OnBoard::Key(number - Key::F1 as u32),
        Key::F5 => OnBoard::HpsKey,
        Key::F6 | Key::F7 | Key::F8 | Key::F9 | Key::F10 | Key::F11 | Key::F12 => {
            OnBoard::Switch(number - Key::F6 as u32)
        }
        _ => return None,
    })
}

/// Returns a key's usage (USB HID Usage Tables, keyboard page); `None` for the function keys, which
/// are the board's.
pub(super) fn usage(key: Key) -> Option<u8> {
    let number = key as u8;
    Some(match key {
        Key::Key0 => 0x27,
        _ if (Key::Key1 as u8..=Key::Key9 as u8).contains(&number) => 0x1E + number - Key::Key1 as u8,
        _ if (Key::A as u8..=Key::Z as u8).contains(&number) => 0x04 + number - Key::A as u8,
        _ if (Key::NumPad1 as u8..=Key::NumPad9 as u8).contains(&number) => 0x59 + number - Key::NumPad1 as u8,
        Key::Enter => 0x28,
        Key::Escape => 0x29,
        Key::Backspace => 0x2A,
        Key::Tab => 0x2B,
        Key::Space => 0x2C,
        Key::Minus => 0x2D,
        Key::Equal => 0x2E,
        Key::LeftBracket => 0x2F,
        Key::RightBracket => 0x30,
        Key::Backslash => 0x31,
        Key::Semicolon => 0x33,
        Key::Apostrophe => 0x34,
        Key::Backquote => 0x35,
        Key::Comma => 0x36,
        Key::Period => 0x37,
        Key::Slash => 0x38,
        Key::CapsLock => 0x39,
        Key::ScrollLock => 0x47,
        Key::Pause => 0x48,
        Key::Insert => 0x49,
        Key::Home => 0x4A,
        Key::PageUp => 0x4B,
        Key::Delete => 0x4C,
        Key::End => 0x4D,
        Key::PageDown => 0x4E,
        Key::Right => 0x4F,
        Key::Left => 0x50,
        Key::Down => 0x51,
        Key::Up => 0x52,
        Key::NumLock => 0x53,
        Key::NumPadSlash => 0x54,
        Key::NumPadAsterisk => 0x55,
        Key::NumPadMinus => 0x56,
        Key::NumPadPlus => 0x57,
        Key::NumPadEnter => 0x58,
        Key::NumPad0 => 0x62,
        Key::NumPadDot => 0x63,
        Key::Menu => 0x65,
        Key::LeftCtrl => FIRST_MODIFIER,
        Key::LeftShift => 0xE1,
        Key::LeftAlt => 0xE2,
        Key::LeftSuper => 0xE3,
        Key::RightCtrl => 0xE4,
        Key::RightShift => 0xE5,
        Key::RightAlt => 0xE6,
        Key::RightSuper => 0xE7,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_keys_keep_their_order() {
        assert_eq!(
            [Key::A, Key::Z, Key::Key1, Key::Key9, Key::Key0].map(usage),
            [0x04, 0x1D, 0x1E, 0x26, 0x27].map(Some)
        );
        assert_eq!([Key::NumPad1, Key::NumPad9].map(usage), [0x59, 0x61].map(Some));
        assert_eq!([Key::F4, Key::F5, Key::F12].map(usage), [None; 3]);
        assert_eq!(on_board(Key::F4), Some(OnBoard::Key(3)));
        assert_eq!(on_board(Key::F12), Some(OnBoard::Switch(6)));
        assert_eq!(on_board(Key::A), None);
    }
}
