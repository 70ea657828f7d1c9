//! From content to the line.

use super::{CHECK, DELIMITER, PAYLOAD_MAXIMUM};
use core::fmt;

/// How many bytes a frame has on the line beyond its payload: two delimiters, one of COBS, the kind
/// and the check.
pub const FRAME_OVERHEAD: usize = 6;

/// How many bytes the longest frame has on the line.
pub const FRAME_SIZE_MAXIMUM: usize = FRAME_OVERHEAD + PAYLOAD_MAXIMUM;

/// Names why a frame was not written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum EncodeError {
    /// The payload has more than 250 bytes.
    PayloadTooLong {
        /// How many it has.
        found: usize,
    },
    /// The frame does not fit where it is to go.
    BufferTooSmall {
        /// How many bytes it wants.
        needed: usize,
        /// How many there are.
        found: usize,
    },
}

impl fmt::Display for EncodeError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::PayloadTooLong { found } => {
                write!(formatter, "payload has {found} bytes, a frame carries 250: split it")
            }
            Self::BufferTooSmall { needed, found } => {
                write!(formatter, "buffer has {found} bytes, the frame {needed}: make it FRAME_SIZE_MAXIMUM")
            }
        }
    }
}

impl core::error::Error for EncodeError {}

/// Writes a frame, delimiters at both ends, and returns the part of the buffer that it fills:
/// [`FRAME_OVERHEAD`] bytes more than the payload.
///
/// # Errors
///
/// [`EncodeError`] when the payload is too long or the buffer too small.
pub fn encode<'a>(kind: u8, payload: &[u8], buffer: &'a mut [u8]) -> Result<&'a [u8], EncodeError> {
    if payload.len() > PAYLOAD_MAXIMUM {
        return Err(EncodeError::PayloadTooLong { found: payload.len() });
    }
    let needed = payload.len() + FRAME_OVERHEAD;
    let found = buffer.len();
    let frame = buffer.get_mut(..needed).ok_or(EncodeError::BufferTooSmall { needed, found })?;

    let mut check = CHECK.digest();
    check.update(&[kind]);
    check.update(payload);
    let check = check.finalize().to_be_bytes();

    frame.fill(DELIMITER);
    let mut coding = cobs::CobsEncoder::new(&mut frame[1..needed - 1]);
    for part in [&[kind], payload, &check] {
        coding.push(part).map_err(|_| EncodeError::BufferTooSmall { needed, found })?;
    }
    coding.finalize();
    Ok(frame)
}

#[cfg(test)]
mod tests {
    use super::{EncodeError, FRAME_OVERHEAD, FRAME_SIZE_MAXIMUM, encode};

    #[test]
    fn known_frames_byte_by_byte() {
        let mut buffer = [0xAA; FRAME_SIZE_MAXIMUM];
        // The CRC's check value: 0x29B1 for "123456789".
        let frame = encode(b'1', b"23456789", &mut buffer).unwrap();
        assert_eq!(frame, b"\x00\x0C123456789\x29\xB1\x00");
        // A zero in the content is what COBS takes out: its place tells the way to the next.
        let frame = encode(0x03, &[0x00], &mut buffer).unwrap();
        assert_eq!((frame[0], frame[1], frame[2], frame[3], frame[6]), (0, 2, 3, 3, 0));
    }

    #[test]
    fn a_frame_has_no_zero_inside_and_its_length_is_known() {
        let mut buffer = [0; FRAME_SIZE_MAXIMUM];
        for length in 0..=250 {
            for fill in [0x00, 0x01, 0xFF] {
                let frame = encode(0x40, &[fill; 250][..length], &mut buffer).unwrap();
                assert_eq!(frame.len(), length + FRAME_OVERHEAD);
                let [0, inside @ .., 0] = frame else { panic!("no delimiters: {frame:02x?}") };
                assert!(!inside.contains(&0), "{length} of {fill:#04x}");
            }
        }
    }

    #[test]
    fn what_does_not_fit_is_named() {
        let mut buffer = [0; FRAME_SIZE_MAXIMUM + 1];
        assert_eq!(encode(1, &[0; 251], &mut buffer), Err(EncodeError::PayloadTooLong { found: 251 }));
        for size in 0..55 {
            let error = EncodeError::BufferTooSmall { needed: 55, found: size };
            assert_eq!(encode(1, &[0; 49], &mut buffer[..size]), Err(error));
        }
        assert!(encode(1, &[0; 49], &mut buffer[..55]).is_ok());
    }
}
