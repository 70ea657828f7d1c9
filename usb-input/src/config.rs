//! What a board may choose.

/// Choices that hold for as long as the bus runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Config {
    /// Which of a DualShock 3's four lamps is lit, 1…4; any other number lights none.
    pub player: u8,
    /// Whether a DualShock 3 gives a short pulse when the pose is frozen
    /// (see [`UsbInput::set_frozen`](crate::UsbInput::set_frozen)).
    pub pulse_on_freeze: bool,
}

impl Default for Config {
    /// Returns lamp 1, and no pulse.
    fn default() -> Self {
        Self { player: 1, pulse_on_freeze: false }
    }
}
