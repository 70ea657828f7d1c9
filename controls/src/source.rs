//! Where a report comes from.

/// Names a source of reports. Its value is its byte in a serial frame of kind 0x03.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
#[repr(u8)]
pub enum Source {
    /// A Sony DualShock 3 pad (USB 054C:0268).
    DualShock3 = 0x01,
    /// A USB keyboard in its boot protocol.
    Keyboard = 0x02,
    /// A board's own keys and switches.
    Panel = 0x03,
}

impl Source {
    /// Returns the source whose byte this is, or `None`.
    #[must_use]
    pub const fn from_byte(byte: u8) -> Option<Self> {
        match byte {
            0x01 => Some(Self::DualShock3),
            0x02 => Some(Self::Keyboard),
            0x03 => Some(Self::Panel),
            _ => None,
        }
    }
}
