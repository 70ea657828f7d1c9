//! From the line to content.

use super::{CHECK, CONTENT_MAXIMUM, FrameError};
use cobs::{DecodeResult, DecoderState};

/// Holds a frame that came over the line whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Frame<'a> {
    /// What it is, see [`kind`](super::kind).
    pub kind: u8,
    /// What it carries, up to 250 bytes.
    pub payload: &'a [u8],
}

/// Finds frames in the bytes of a serial line.
///
/// Bytes between two delimiters give one result, when the second of them comes: a frame or why there
/// is none. Delimiters in a row give nothing.
#[derive(Debug)]
pub struct Decoder {
    state: DecoderState,
    content: [u8; CONTENT_MAXIMUM],
    /// May grow beyond the content's size, which is how a frame that is too long is known.
    length: usize,
}

impl Decoder {
    /// Starts before a frame.
    #[must_use]
    pub const fn new() -> Self {
        Self { state: DecoderState::Idle, content: [0; CONTENT_MAXIMUM], length: 0 }
    }

    /// Takes the next byte of the line, and returns a frame if this byte ends one.
    ///
    /// # Errors
    ///
    /// Within the `Some`: [`FrameError`] if this byte ends something that is no frame. The next byte
    /// begins anew.
    pub fn feed(&mut self, byte: u8) -> Option<Result<Frame<'_>, FrameError>> {
        match self.state.feed(byte) {
            Ok(DecodeResult::NoData) => None,
            Ok(DecodeResult::DataStart) => {
                self.length = 0;
                None
            }
            Ok(DecodeResult::DataContinue(content)) => {
                if let Some(place) = self.content.get_mut(self.length) {
                    *place = content;
                }
                self.length = self.length.saturating_add(1);
                None
            }
            Ok(DecodeResult::DataComplete) => Some(self.frame()),
            Err(_) if self.length > CONTENT_MAXIMUM => Some(Err(FrameError::TooLong)),
            Err(_) => Some(Err(FrameError::Truncated)),
        }
    }

    /// Looks at what stands between the last two delimiters.
    fn frame(&self) -> Result<Frame<'_>, FrameError> {
        let content = self.content.get(..self.length).ok_or(FrameError::TooLong)?;
        let [checked @ .., high, low] = content else {
            return Err(FrameError::TooShort { found: content.len() });
        };
        let &[kind, ref payload @ ..] = checked else {
            return Err(FrameError::TooShort { found: content.len() });
        };
        let (computed, found) = (CHECK.checksum(checked), u16::from_be_bytes([*high, *low]));
        if computed == found { Ok(Frame { kind, payload }) } else { Err(FrameError::Check { computed, found }) }
    }
}

impl Default for Decoder {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::{Decoder, FrameError};
    use crate::serial::{FRAME_SIZE_MAXIMUM, encode};
    use std::vec::Vec;

    type Found = Result<(u8, Vec<u8>), FrameError>;

    fn decode(line: &[u8]) -> Vec<Found> {
        let mut decoder = Decoder::new();
        let mut found = Vec::new();
        for &byte in line {
            if let Some(frame) = decoder.feed(byte) {
                found.push(frame.map(|frame| (frame.kind, frame.payload.to_vec())));
            }
        }
        found
    }

    fn line(kind: u8, payload: &[u8]) -> Vec<u8> {
        encode(kind, payload, &mut [0; FRAME_SIZE_MAXIMUM]).unwrap().to_vec()
    }

    #[test]
    fn every_length_comes_back() {
        for length in 0..=250 {
            for fill in [0x00, 0x5A, 0xFF] {
                let payload = [fill; 250][..length].to_vec();
                assert_eq!(decode(&line(0x77, &payload)), [Ok((0x77, payload))]);
            }
        }
    }

    #[test]
    fn two_frames_may_share_a_delimiter_and_delimiters_alone_are_nothing() {
        let mut shared = line(1, b"one");
        shared.extend_from_slice(&line(2, b"two")[1..]);
        shared.extend_from_slice(&[0; 9]);
        assert_eq!(decode(&shared), [Ok((1, b"one".to_vec())), Ok((2, b"two".to_vec()))]);
    }

    #[test]
    fn each_fault_has_its_name_and_the_next_frame_comes_through() {
        let good = line(9, b"good");
        let faults: [(&[u8], FrameError); 5] = [
            (&[0x05, 1, 2, 0], FrameError::Truncated),
            (&[0x01, 0], FrameError::TooShort { found: 0 }),
            (&[0x03, 1, 2, 0], FrameError::TooShort { found: 2 }),
            (&[0x04, 1, 2, 3, 0], FrameError::Check { computed: 0xF1D1, found: 0x0203 }),
            (&[[0x01; 300].as_slice(), &[0]].concat(), FrameError::TooLong),
        ];
        for (bytes, fault) in faults {
            let all = [&[0], bytes, &good].concat();
            assert_eq!(decode(&all), [Err(fault), Ok((9, b"good".to_vec()))]);
        }
    }

    #[test]
    fn one_byte_more_than_fits_is_too_long_however_it_ends() {
        let whole = [&[0xFF][..], &[7; 254], &[0]].concat();
        assert_eq!(decode(&whole), [Err(FrameError::TooLong)]);
        let cut = [&[0xFF][..], &[7; 254], &[5, 1, 0]].concat();
        assert_eq!(decode(&cut), [Err(FrameError::TooLong)]);
    }

    #[test]
    fn every_flipped_bit_is_noticed() {
        let good = line(1, &[0x10, 0x00, 0x20, 0x00, 0x30]);
        for bit in 8..8 * (good.len() - 1) {
            let mut bad = good.clone();
            bad[bit / 8] ^= 1 << (bit % 8);
            assert!(decode(&bad).iter().all(Result::is_err), "bit {bit}");
        }
    }
}
