//! Why a report was dropped.

use core::fmt;

/// Names why a report was dropped. The state is as it was before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ReportError {
    /// A pad's report is not 49 bytes long.
    DualShock3Length {
        /// Its length in bytes.
        found: usize,
    },
    /// A pad's report has an id other than 0x01.
    DualShock3Id {
        /// The id it has.
        found: u8,
    },
    /// A pad's report is marked as empty: byte 1 is 0xFF.
    DualShock3NoData,
    /// A keyboard's boot report is not 8 bytes long.
    KeyboardLength {
        /// Its length in bytes.
        found: usize,
    },
    /// A panel's report is not 3 bytes long.
    PanelLength {
        /// Its length in bytes.
        found: usize,
    },
    /// A "source disconnected" frame does not carry exactly one byte.
    DisconnectedLength {
        /// How many bytes it carries.
        found: usize,
    },
    /// A "source disconnected" frame names a source that does not exist.
    UnknownSource {
        /// The byte it carries.
        found: u8,
    },
    /// A frame's kind is none of this crate's.
    UnknownKind {
        /// The kind it has.
        found: u8,
    },
}

impl fmt::Display for ReportError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::DualShock3Length { found } => write!(
                formatter,
                "DualShock 3 report is {found} bytes long, not 49: \
                 use a Sony DualShock 3 (other pads lay their reports out differently)"
            ),
            Self::DualShock3Id { found } => write!(
                formatter,
                "DualShock 3 report has id {found:#04x}, not 0x01: ask for input report 0x01 (wValue 0x0101)"
            ),
            Self::DualShock3NoData => write!(
                formatter,
                "DualShock 3 report is marked as without data (byte 1 is 0xff): \
                 ignore it; if all are so, press the PS button"
            ),
            Self::KeyboardLength { found } => write!(
                formatter,
                "keyboard report is {found} bytes long, not 8: set the boot protocol (SET_PROTOCOL 0)"
            ),
            Self::PanelLength { found } => {
                write!(formatter, "panel report is {found} bytes long, not 3: send keys, then switches low and high")
            }
            Self::DisconnectedLength { found } => write!(
                formatter,
                "\"source disconnected\" frame carries {found} bytes, not 1: send the source's byte alone"
            ),
            Self::UnknownSource { found } => {
                write!(
                    formatter,
                    "source {found:#04x} does not exist: send 0x01 (DualShock 3), 0x02 (keyboard) or 0x03 (panel)"
                )
            }
            Self::UnknownKind { found } => write!(
                formatter,
                "frame kind {found:#04x} is no report: send 0x01 to 0x03, or handle it before the controls"
            ),
        }
    }
}

impl core::error::Error for ReportError {}

#[cfg(test)]
mod tests {
    use super::ReportError;
    use std::string::ToString;

    #[test]
    fn each_text_has_the_value_and_a_remedy() {
        let errors = [
            (ReportError::DualShock3Length { found: 20 }, "20 bytes"),
            (ReportError::DualShock3Id { found: 0xF2 }, "0xf2"),
            (ReportError::DualShock3NoData, "0xff"),
            (ReportError::KeyboardLength { found: 3 }, "3 bytes"),
            (ReportError::PanelLength { found: 4 }, "4 bytes"),
            (ReportError::DisconnectedLength { found: 0 }, "0 bytes"),
            (ReportError::UnknownSource { found: 9 }, "0x09"),
            (ReportError::UnknownKind { found: 0x40 }, "0x40"),
        ];
        for (error, value) in errors {
            let text = error.to_string();
            let (fault, remedy) = text.split_once(": ").expect("a remedy after the fault");
            assert!(fault.contains(value), "{text}");
            assert!(remedy.len() > 10, "{text}");
        }
    }
}
