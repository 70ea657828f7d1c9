//! The kinds of frame.

/// A DualShock 3's input report, 49 bytes.
pub const DUALSHOCK3: u8 = 0x01;
/// A boot keyboard's input report, 8 bytes.
pub const KEYBOARD: u8 = 0x02;
/// A source has gone; the payload is its byte, see [`Source`](crate::Source).
pub const DISCONNECTED: u8 = 0x03;
/// The first of the kinds, up to 0xFF, that this crate leaves to the application.
pub const APPLICATION: u8 = 0x40;
