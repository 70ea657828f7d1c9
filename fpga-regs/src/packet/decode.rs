//! From words to packets.

use super::{BadPacket, Clear, ClearDepth, EdgeSteps, Fence, FlatTriangle, Header, Kind, Span};
use crate::screen::{HEIGHT, PacketDepth, Rgb332, WIDTH};

/// A packet, decoded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Packet {
    /// Fill the back buffer and the depth buffer.
    Clear(Clear),
    /// Draw a flat triangle.
    FlatTriangle(FlatTriangle),
    /// Show the back buffer.
    Swap,
    /// Pass a tag.
    Fence(Fence),
}

impl Packet {
    /// Words of the longest packet that is not bad.
    pub const MAX_WORDS: usize = FlatTriangle::WORDS;

    /// Returns the packet that a header and the words behind it make.
    ///
    /// # Errors
    /// [`BadPacket`] names the rule that is broken. `payload` shorter than the header's length
    /// is [`BadPacket::Length`].
    pub fn decode(header: Header, payload: &[u32]) -> Result<Self, BadPacket> {
        let kind = header.check()?;
        let colour = Rgb332(header.colour());
        match (kind, payload) {
            (Kind::Clear, &[depth]) => {
                let depth = ClearDepth(depth);
                if depth.reserved() != 0 {
                    return Err(BadPacket::Reserved);
                }
                Ok(Packet::Clear(Clear { colour, depth: depth.depth() }))
            }
            (
                Kind::FlatTriangle,
                &[columns, rows, edge0, edge1, edge2, steps0, steps1, depth, depth_step_x, depth_step_y],
            ) => {
                let (columns, rows) = (Span(columns), Span(rows));
                if !columns.is_within(WIDTH) || !rows.is_within(HEIGHT) {
                    return Err(BadPacket::Box);
                }
                let depth_from = |word: u32| PacketDepth::from_bits(word as i32);
                Ok(Packet::FlatTriangle(FlatTriangle {
                    colour,
                    columns,
                    rows,
                    edges: [edge0 as i32, edge1 as i32, edge2 as i32],
                    steps: [EdgeSteps(steps0), EdgeSteps(steps1)],
                    depth: depth_from(depth),
                    depth_step_x: depth_from(depth_step_x),
                    depth_step_y: depth_from(depth_step_y),
                }))
            }
            (Kind::Swap, &[]) => Ok(Packet::Swap),
            (Kind::Fence, &[tag]) => Ok(Packet::Fence(Fence { tag })),
            _ => Err(BadPacket::Length),
        }
    }
}
