//! What a port, or the hub itself, says of itself.

use embassy_usb_driver::Speed;

/// Feature selectors (USB 2.0 table 11-17).
pub(super) mod feature {
    pub(in crate::hub) const ENABLE: u8 = 1;
    pub(in crate::hub) const RESET: u8 = 4;
    pub(in crate::hub) const POWER: u8 = 8;
    /// The first of those that clear a port's changes, in the order of their bits.
    pub(in crate::hub) const CHANGES: u8 = 16;
    pub(in crate::hub) const CHANGE_RESET: u8 = 20;
}

/// Bits of a port's status and of its changes (USB 2.0 §11.24.2.7.1, §11.24.2.7.2).
pub(super) mod bit {
    pub(in crate::hub) const CONNECTION: u16 = 1 << 0;
    pub(in crate::hub) const ENABLE: u16 = 1 << 1;
    pub(in crate::hub) const OVER_CURRENT: u16 = 1 << 3;
    pub(in crate::hub) const RESET: u16 = 1 << 4;
    pub(in crate::hub) const LOW_SPEED: u16 = 1 << 9;
    pub(in crate::hub) const HIGH_SPEED: u16 = 1 << 10;
    /// All changes that are defined.
    pub(in crate::hub) const CHANGES: u16 = 0x1F;
}

/// The answer to GET_STATUS.
#[derive(Debug, Clone, Copy)]
pub(super) struct Status {
    pub(super) status: u16,
    pub(super) changes: u16,
}

impl Status {
    /// Its length in bytes.
    pub(super) const LENGTH: usize = 4;

    pub(super) fn parse(bytes: &[u8]) -> Option<Self> {
        let &[s0, s1, c0, c1] = bytes else { return None };
        Some(Self { status: u16::from_le_bytes([s0, s1]), changes: u16::from_le_bytes([c0, c1]) })
    }

    pub(super) const fn is(self, bit: u16) -> bool {
        self.status & bit != 0
    }

    pub(super) const fn has_changed(self, bit: u16) -> bool {
        self.changes & bit != 0
    }

    pub(super) const fn speed(self) -> Speed {
        match (self.is(bit::LOW_SPEED), self.is(bit::HIGH_SPEED)) {
            (true, _) => Speed::Low,
            (false, true) => Speed::High,
            (false, false) => Speed::Full,
        }
    }
}
