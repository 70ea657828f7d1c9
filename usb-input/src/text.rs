//! A short text that any console can show.

use core::fmt::{self, Write};

/// A short text of printable ASCII; what a device says in other characters shows as `?`.
#[derive(Clone, Copy, PartialEq, Eq, Default)]
pub struct Text {
    bytes: [u8; Self::LENGTH_MAXIMUM],
    length: u8,
}

impl Text {
    /// Characters that are kept.
    pub const LENGTH_MAXIMUM: usize = 32;

    /// Whether there is none.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.length == 0
    }

    /// Returns its characters, a byte each.
    #[must_use]
    pub fn as_bytes(&self) -> &[u8] {
        &self.bytes[..usize::from(self.length)]
    }

    /// Puts a UTF-16 unit at its end, if there is room.
    pub(crate) fn push(&mut self, unit: u16) {
        if let Some(place) = self.bytes.get_mut(usize::from(self.length)) {
            *place = if let 0x20..=0x7E = unit { unit as u8 } else { b'?' };
            self.length += 1;
        }
    }
}

impl fmt::Display for Text {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.as_bytes().iter().try_for_each(|&byte| formatter.write_char(byte.into()))
    }
}

impl fmt::Debug for Text {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "\"{self}\"")
    }
}
