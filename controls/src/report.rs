//! Reports as they come, from whatever bus.

use crate::serial::kind;
use crate::{ReportError, Source};

/// Holds the bytes of a report and what they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Report<'a> {
    /// Input report 0x01 of a DualShock 3, 49 bytes, its id included.
    DualShock3(&'a [u8]),
    /// A boot keyboard's input report, 8 bytes.
    Keyboard(&'a [u8]),
    /// What a board's own keys and switches are, 3 bytes ([`PanelReport`](crate::PanelReport)). No serial
    /// frame carries it.
    Panel(&'a [u8]),
    /// A source has gone.
    Disconnected(Source),
}

impl<'a> Report<'a> {
    /// Reads the kind and the payload of a serial frame.
    ///
    /// # Errors
    ///
    /// [`ReportError::UnknownKind`] for a kind that is the caller's, [`ReportError::UnknownSource`] and
    /// [`ReportError::DisconnectedLength`] for a disconnection that names no source. The length of a
    /// report itself is looked at where it is read.
    pub const fn from_frame(kind: u8, payload: &'a [u8]) -> Result<Self, ReportError> {
        match (kind, payload) {
            (kind::DUALSHOCK3, _) => Ok(Self::DualShock3(payload)),
            (kind::KEYBOARD, _) => Ok(Self::Keyboard(payload)),
            (kind::DISCONNECTED, &[byte]) => match Source::from_byte(byte) {
                Some(source) => Ok(Self::Disconnected(source)),
                None => Err(ReportError::UnknownSource { found: byte }),
            },
            (kind::DISCONNECTED, _) => Err(ReportError::DisconnectedLength { found: payload.len() }),
            _ => Err(ReportError::UnknownKind { found: kind }),
        }
    }
}
