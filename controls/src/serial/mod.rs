//! Reports over a serial line.
//!
//! A frame on the line is `0x00 C 0x00`, where C is the COBS coding (Cheshire and Baker, "Consistent
//! Overhead Byte Stuffing", 1999), free of zeros, of
//!
//! | bytes | meaning |
//! | --- | --- |
//! | 1 | [`kind`] |
//! | 0–250 | payload |
//! | 2 | CRC-16/CCITT-FALSE of kind and payload, big endian |
//!
//! The CRC is polynomial 0x1021, start 0xFFFF, nothing reflected (CRC-16/IBM-3740 in the RevEng
//! catalogue). A zero on the line is always a frame's end and the next one's beginning, so a lost,
//! doubled or flipped byte costs at most the frames that it touches. Two frames may share a zero.
//!
//! A person at a terminal sends no zeros: until the first one, bytes are keys ([`Typed`]).

mod decoder;
mod encoder;
mod frame_error;
pub mod kind;
mod typed;

pub use decoder::{Decoder, Frame};
pub use encoder::{EncodeError, FRAME_OVERHEAD, FRAME_SIZE_MAXIMUM, encode};
pub use frame_error::FrameError;
pub use typed::Typed;

/// How many bytes a payload may have.
pub const PAYLOAD_MAXIMUM: usize = 250;

/// What separates frames.
const DELIMITER: u8 = 0x00;

/// Kind, payload and check, before COBS: short enough that COBS adds exactly one byte.
const CONTENT_MAXIMUM: usize = 1 + PAYLOAD_MAXIMUM + 2;

const CHECK: crc::Crc<u16> = crc::Crc::<u16>::new(&crc::CRC_16_IBM_3740);
