//! From words to packets.

use super::{
    BadPacket, Channels, Clear, ClearDepth, Fence, FlatTriangle, GouraudTriangle, Header, Kind, TriangleShape,
};
use crate::screen::Rgb332;

/// A packet, decoded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Packet {
    /// Fill the back buffer and the depth buffer.
    Clear(Clear),
    /// Draw a flat triangle.
    FlatTriangle(FlatTriangle),
    /// Draw a triangle whose colour changes from corner to corner.
    GouraudTriangle(GouraudTriangle),
    /// Show the back buffer.
    Swap,
    /// Pass a tag.
    Fence(Fence),
}

impl Packet {
    /// Words of the longest packet that is not bad.
    pub const MAX_WORDS: usize = GouraudTriangle::WORDS;

    /// Returns the packet that a header and the words behind it make.
    ///
    /// # Errors
    /// [`BadPacket`] names the rule that is broken. `payload` shorter than the header's length
    /// is [`BadPacket::Length`].
    pub fn decode(header: Header, payload: &[u32]) -> Result<Self, BadPacket> {
        let kind = header.check()?;
        let (colour, mode) = (Rgb332(header.colour()), header.mode());
        match (kind, payload) {
            (Kind::Clear, &[depth]) => {
                let depth = ClearDepth(depth);
                if depth.reserved() != 0 {
                    return Err(BadPacket::Reserved);
                }
                Ok(Packet::Clear(Clear { colour, depth: depth.depth() }))
            }
            (Kind::FlatTriangle, words) => {
                let shape = words.try_into().map_err(|_| BadPacket::Length)?;
                Ok(Packet::FlatTriangle(FlatTriangle { colour, mode, shape: TriangleShape::decode(shape)? }))
            }
            (Kind::GouraudTriangle, &[low, high, x_low, x_high, y_low, y_high, ref shape @ ..]) => {
                let shape = shape.try_into().map_err(|_| BadPacket::Length)?;
                Ok(Packet::GouraudTriangle(GouraudTriangle {
                    colour: Channels::decode([low, high])?,
                    colour_step_x: Channels::decode([x_low, x_high])?,
                    colour_step_y: Channels::decode([y_low, y_high])?,
                    mode,
                    shape: TriangleShape::decode(shape)?,
                }))
            }
            (Kind::Swap, &[]) => Ok(Packet::Swap),
            (Kind::Fence, &[tag]) => Ok(Packet::Fence(Fence { tag })),
            _ => Err(BadPacket::Length),
        }
    }
}
