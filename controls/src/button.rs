//! The seventeen buttons, and sets of them.

use core::ops::{BitAnd, BitOr, BitOrAssign, Not};

/// Names a button of the DualShock 3.
///
/// Its value is its bit in bytes 2 to 4 of the report, read as one little-endian number
/// (Linux `hid-sony.c`, SDL `SDL_hidapi_ps3.c`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Button {
    /// Select: byte 2, bit 0.
    Select = 0,
    /// The left stick, pushed: byte 2, bit 1.
    L3 = 1,
    /// The right stick, pushed: byte 2, bit 2.
    R3 = 2,
    /// Start: byte 2, bit 3.
    Start = 3,
    /// The D-pad's up: byte 2, bit 4.
    Up = 4,
    /// The D-pad's right: byte 2, bit 5.
    Right = 5,
    /// The D-pad's down: byte 2, bit 6.
    Down = 6,
    /// The D-pad's left: byte 2, bit 7.
    Left = 7,
    /// The left trigger: byte 3, bit 0.
    L2 = 8,
    /// The right trigger: byte 3, bit 1.
    R2 = 9,
    /// The left shoulder: byte 3, bit 2.
    L1 = 10,
    /// The right shoulder: byte 3, bit 3.
    R1 = 11,
    /// Triangle: byte 3, bit 4.
    Triangle = 12,
    /// Circle: byte 3, bit 5.
    Circle = 13,
    /// Cross, which freezes: byte 3, bit 6.
    Cross = 14,
    /// Square: byte 3, bit 7.
    Square = 15,
    /// The button with the PS logo: byte 4, bit 0.
    Ps = 16,
}

impl Button {
    /// Every button, in the order of their bits.
    pub const ALL: [Self; 17] = [
        Self::Select,
        Self::L3,
        Self::R3,
        Self::Start,
        Self::Up,
        Self::Right,
        Self::Down,
        Self::Left,
        Self::L2,
        Self::R2,
        Self::L1,
        Self::R1,
        Self::Triangle,
        Self::Circle,
        Self::Cross,
        Self::Square,
        Self::Ps,
    ];
}

/// Holds a set of [`Button`]s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Buttons(u32);

impl Buttons {
    /// No button.
    pub const NONE: Self = Self(0);
    /// All seventeen buttons.
    pub const ALL: Self = Self((1 << Button::ALL.len()) - 1);

    /// Makes a set from the report's bits, leaving out those that are no button.
    #[must_use]
    pub const fn from_bits(bits: u32) -> Self {
        Self(bits & Self::ALL.0)
    }

    /// Returns the set as the report's bits, 0 to 16.
    #[must_use]
    pub const fn bits(self) -> u32 {
        self.0
    }

    /// Returns the set with one more button.
    #[must_use]
    pub const fn with(self, button: Button) -> Self {
        Self(self.0 | 1 << button as u32)
    }

    /// Tells whether the button is in the set.
    #[must_use]
    pub const fn contains(self, button: Button) -> bool {
        self.0 >> button as u32 & 1 == 1
    }

    /// Tells whether the set has no button.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Goes through the buttons in the set, in the order of their bits.
    pub fn iter(self) -> impl Iterator<Item = Button> {
        Button::ALL.into_iter().filter(move |&button| self.contains(button))
    }
}

impl From<Button> for Buttons {
    fn from(button: Button) -> Self {
        Self::NONE.with(button)
    }
}

impl FromIterator<Button> for Buttons {
    fn from_iter<I: IntoIterator<Item = Button>>(buttons: I) -> Self {
        buttons.into_iter().fold(Self::NONE, Self::with)
    }
}

impl BitOr for Buttons {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl BitOrAssign for Buttons {
    fn bitor_assign(&mut self, other: Self) {
        self.0 |= other.0;
    }
}

impl BitAnd for Buttons {
    type Output = Self;

    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

impl Not for Buttons {
    type Output = Self;

    fn not(self) -> Self {
        Self::from_bits(!self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::{Button, Buttons};

    #[test]
    fn a_set_holds_what_was_put_in_and_nothing_else() {
        for (bit, button) in Button::ALL.into_iter().enumerate() {
            let set = Buttons::from(button);
            assert_eq!(set.bits(), 1 << bit);
            assert!(set.iter().eq([button]));
            assert!(!(!set).contains(button));
            assert_eq!(set | !set, Buttons::ALL);
        }
    }

    #[test]
    fn bits_that_are_no_button_are_left_out() {
        assert_eq!(Buttons::from_bits(u32::MAX), Buttons::ALL);
        assert_eq!(Buttons::ALL.bits(), 0x0001_FFFF);
        assert!((!Buttons::ALL).is_empty());
    }
}
