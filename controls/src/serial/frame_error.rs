//! Why a frame was dropped.

use core::fmt;

/// Names why the bytes between two delimiters were dropped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum FrameError {
    /// The delimiter came where COBS promised more bytes.
    Truncated,
    /// There are more bytes than any frame has.
    TooLong,
    /// There is no room for a kind and a check.
    TooShort {
        /// How many bytes there are, COBS undone.
        found: usize,
    },
    /// The check does not fit what it checks.
    Check {
        /// What the content has as its check.
        computed: u16,
        /// What the frame says.
        found: u16,
    },
}

impl fmt::Display for FrameError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Truncated => write!(formatter, "serial frame ends early")?,
            Self::TooLong => write!(formatter, "serial frame carries more than 250 bytes")?,
            Self::TooShort { found } => write!(formatter, "serial frame has {found} bytes, not 3 or more")?,
            Self::Check { computed, found } => {
                write!(formatter, "serial frame has check {found:#06x}, its content {computed:#06x}")?;
            }
        }
        formatter.write_str(": send it again; if it is so often, look at baud rate and cable")
    }
}

impl core::error::Error for FrameError {}

#[cfg(test)]
mod tests {
    use super::FrameError;
    use std::string::ToString;

    #[test]
    fn a_text_names_thing_value_and_remedy() {
        let text = FrameError::Check { computed: 0x29B1, found: 0x29B2 }.to_string();
        assert!(text.contains("0x29b1") && text.contains("0x29b2") && text.contains("baud rate"), "{text}");
        assert!(FrameError::TooShort { found: 2 }.to_string().contains("2 bytes"));
    }
}
