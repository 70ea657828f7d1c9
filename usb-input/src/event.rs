//! What the bus tells.

use controls::{Battery, Report, Source};

use crate::{Fault, Identity, Kind, Place};

/// Something that happened on the bus. Nothing is lost between two [`poll`](crate::UsbInput::poll)s:
/// while the queue is full the devices wait.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Event {
    /// A keyboard's state, as a boot keyboard reports it.
    KeyboardReport {
        /// The keyboard.
        device: Place,
        /// The report.
        report: [u8; 8],
    },
    /// A pad's state, as a DualShock 3 reports it; other pads' reports are translated.
    PadReport {
        /// The pad.
        device: Place,
        /// The report.
        report: [u8; 49],
    },
    /// A device that this crate serves is ready.
    Attached {
        /// Where.
        device: Place,
        /// What it is served as.
        kind: Kind,
        /// What it says of itself.
        identity: Identity,
    },
    /// A device that this crate does not serve is there; it is left alone.
    Unsupported {
        /// Where.
        device: Place,
        /// What it says of itself.
        identity: Identity,
    },
    /// A device that was [`Attached`](Self::Attached) or [`Unsupported`](Self::Unsupported) has gone.
    Detached {
        /// Where it was.
        device: Place,
        /// What it was served as, if it was.
        kind: Option<Kind>,
    },
    /// Something went wrong. The others go on.
    Fault {
        /// With whom.
        device: Place,
        /// What.
        fault: Fault,
    },
    /// A pad's battery has become low. Comes once until it is charged.
    BatteryLow {
        /// The pad.
        device: Place,
        /// How low: [`Battery::Dying`] or [`Battery::Empty`].
        battery: Battery,
    },
}

impl Event {
    /// Returns what `controls` is to be told, if this is for it: a report, or that a source has gone.
    #[must_use]
    pub fn report(&self) -> Option<Report<'_>> {
        match self {
            Self::KeyboardReport { report, .. } => Some(Report::Keyboard(report)),
            Self::PadReport { report, .. } => Some(Report::DualShock3(report)),
            Self::Detached { kind: Some(kind), .. } => Some(Report::Disconnected(kind.source()?)),
            _ => None,
        }
    }
}

impl Kind {
    /// Returns which of `controls`' sources it is; `None` for a hub.
    #[must_use]
    pub const fn source(self) -> Option<Source> {
        match self {
            Self::Hub { .. } => None,
            Self::BootKeyboard | Self::ReportKeyboard => Some(Source::Keyboard),
            Self::DualShock3 | Self::DualShock4 | Self::Gamepad => Some(Source::DualShock3),
        }
    }
}
