//! The triangle whose colour changes from corner to corner.

use super::{BadPacket, Header, Kind, PixelMode, TriangleShape, WordInfo};
use crate::screen::COLOUR_FRACTION_BITS;

word! {
    /// Red, and the lower part of green.
    ChannelsLow {
        /// Red, Q9.12 modulo 2^21.
        red / with_red: [20:0] u32,
        /// Bits 10…0 of green, Q9.12 modulo 2^21.
        green_low / with_green_low: [31:21] u32,
    }
}

word! {
    /// The upper part of green, and blue.
    ChannelsHigh {
        /// Bits 20…11 of green.
        green_high / with_green_high: [9:0] u32,
        /// Blue, Q9.12 modulo 2^21.
        blue / with_blue: [30:10] u32,
        /// Zero.
        reserved / with_reserved: [31:31] bool,
    }
}

/// Red, green and blue at a pixel, or their step: 0…255 in Q9.12, modulo 2²¹.
///
/// Only the low 21 bits of each travel in a packet and count.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Channels(pub [i32; 3]);

impl Channels {
    /// Bits of a channel in a packet.
    pub const BITS: u32 = 9 + COLOUR_FRACTION_BITS;
    /// Words of three channels.
    pub const WORDS: usize = 2;

    const MASK: u32 = (1 << Self::BITS) - 1;
    /// Bits of green in the lower word.
    const GREEN_LOW_BITS: u32 = 32 - Self::BITS;

    /// Returns the two words of three channels, each cut to its low 21 bits.
    #[inline(always)]
    pub const fn encode(self) -> [u32; Self::WORDS] {
        let [red, green, blue] = self.0;
        let (red, green, blue) = (red as u32 & Self::MASK, green as u32 & Self::MASK, blue as u32 & Self::MASK);
        [red | green << Self::BITS, green >> Self::GREEN_LOW_BITS | blue << (Self::BITS - Self::GREEN_LOW_BITS)]
    }

    /// Returns the three channels that two words hold, as non-negative numbers below 2²¹.
    ///
    /// # Errors
    /// [`BadPacket::Reserved`] when the spare bit is set.
    pub(super) fn decode([low, high]: [u32; Self::WORDS]) -> Result<Self, BadPacket> {
        let (low, high) = (ChannelsLow(low), ChannelsHigh(high));
        if high.reserved() {
            return Err(BadPacket::Reserved);
        }
        let green = low.green_low() | high.green_high() << Self::GREEN_LOW_BITS;
        Ok(Self([low.red(), green, high.blue()].map(|channel| channel as i32)))
    }
}

/// A triangle whose colour is a plane over the screen in each channel, set up.
///
/// The device rounds each pixel to RGB332 by [`dithered`](crate::screen::dithered).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GouraudTriangle {
    /// Colour at the centre of the box's upper left pixel.
    pub colour: Channels,
    /// Colour step of one pixel to the right.
    pub colour_step_x: Channels,
    /// Colour step of one row down.
    pub colour_step_y: Channels,
    /// What its pixels do.
    pub mode: PixelMode,
    /// Where it lies.
    pub shape: TriangleShape,
}

impl GouraudTriangle {
    /// Words of the colours, which stand between the header and the shape.
    pub const COLOUR_WORDS: usize = 3 * Channels::WORDS;
    /// Words of the packet: a header, the colours and the shape.
    pub const WORDS: usize = 1 + Self::COLOUR_WORDS + TriangleShape::WORDS;

    /// The colours come first, so that the shape stands at every triangle packet's end.
    pub(super) const WORD_TABLE: &'static [WordInfo] = &{
        let mut table = [TriangleShape::WORD_TABLE[0]; Self::WORDS - 1];
        table[0] = low("colour_low", " Colour at the box's upper left pixel centre: red, lower part of green.");
        table[1] = high("colour_high", " Upper part of green, blue.");
        table[2] = low("colour_step_x_low", " Colour step of one pixel to the right.");
        table[3] = high("colour_step_x_high", " Its upper part.");
        table[4] = low("colour_step_y_low", " Colour step of one row down.");
        table[5] = high("colour_step_y_high", " Its upper part.");
        let mut index = 0;
        while index < TriangleShape::WORDS {
            table[Self::COLOUR_WORDS + index] = TriangleShape::WORD_TABLE[index];
            index += 1;
        }
        table
    };

    /// Returns the packet's words.
    pub fn encode(&self) -> [u32; Self::WORDS] {
        let mut words = [Header::of(Kind::GouraudTriangle).with_mode(self.mode).0; Self::WORDS];
        let (colours, shape) = words[1..].split_at_mut(Self::COLOUR_WORDS);
        for (place, channels) in
            colours.chunks_exact_mut(Channels::WORDS).zip([self.colour, self.colour_step_x, self.colour_step_y])
        {
            place.copy_from_slice(&channels.encode());
        }
        shape.copy_from_slice(&self.shape.encode());
        words
    }
}

const fn low(name: &'static str, doc: &'static str) -> WordInfo {
    WordInfo { name, fields: ChannelsLow::FIELDS, doc }
}

const fn high(name: &'static str, doc: &'static str) -> WordInfo {
    WordInfo { name, fields: ChannelsHigh::FIELDS, doc }
}
