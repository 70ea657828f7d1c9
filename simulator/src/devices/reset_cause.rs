//! What resets the processor.

/// What reset the processor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ResetCause {
    /// Software, cold.
    SoftwareCold,
    /// Software, warm.
    SoftwareWarm,
    /// The core's own watchdog.
    PrivateWatchdog,
    /// A watchdog on the peripherals' bus.
    L4Watchdog(usize),
}

impl ResetCause {
    /// Returns whether memory and the words for software are lost with the reset.
    pub fn is_cold(self) -> bool {
        self == Self::SoftwareCold
    }

    /// Returns the bit of the reset manager's STAT.
    pub fn status_bit(self) -> u32 {
        match self {
            Self::SoftwareCold => 4,
            Self::SoftwareWarm => 10,
            Self::PrivateWatchdog => 12,
            Self::L4Watchdog(index) => 14 + index as u32,
        }
    }
}
