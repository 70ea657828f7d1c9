//! A keyboard or a pad, made of what a report descriptor says.

use super::inputs::inputs;
use super::keyboard::KeyboardLayout;
use super::pad::PadLayout;

/// Applications: page and usage of the collection at the top (HID Usage Tables, page 0x01).
const JOYSTICK: u32 = 0x0001_0004;
const GAMEPAD: u32 = 0x0001_0005;
const KEYBOARD: u32 = 0x0001_0006;
const KEYPAD: u32 = 0x0001_0007;

/// Where a device's report has what is of use.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Layout {
    /// The report's id, 0 if reports have none.
    pub(crate) id: u8,
    /// Its length in bytes, its id counted.
    pub(crate) length: usize,
    pub(crate) form: Form,
}

/// What it is that reports.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Form {
    Keyboard(KeyboardLayout),
    Pad(PadLayout),
}

impl Layout {
    /// Finds a keyboard or a pad, the first if there are several; `None` if there is neither.
    pub(crate) fn parse(descriptor: &[u8]) -> Option<Self> {
        let (mut keyboard, mut keyboard_id) = (KeyboardLayout::default(), None);
        let (mut pad, mut pad_id) = (PadLayout::default(), None);
        // What is of use is in one report: the first that has any.
        let lengths = inputs(descriptor, &mut |input| {
            let of_use = |id: Option<u8>| id.is_none_or(|id| id == input.id);
            match input.application {
                KEYBOARD | KEYPAD if of_use(keyboard_id) && keyboard.add(input) => keyboard_id = Some(input.id),
                JOYSTICK | GAMEPAD if of_use(pad_id) && pad.add(input) => pad_id = Some(input.id),
                _ => {}
            }
        });
        let keyboard = keyboard_id.filter(|_| keyboard.is_usable()).map(|id| (id, Form::Keyboard(keyboard)));
        let pad = pad_id.filter(|_| pad.is_usable()).map(|id| (id, Form::Pad(pad)));
        let (id, form) = keyboard.or(pad)?;
        Some(Self { id, length: lengths.bytes(id), form })
    }
}

#[cfg(test)]
#[path = "layout_tests.rs"]
mod tests;
