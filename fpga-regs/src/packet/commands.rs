//! Packets that command the device: clear, swap, fence.

use super::{Header, Kind};
use crate::screen::Rgb332;

word! {
    /// The depth that a clear fills with.
    ClearDepth {
        /// Depth, 0 (near) to 65,535 (far).
        depth / with_depth: [15:0] u16,
        /// Zero.
        reserved / with_reserved: [31:16] u16,
    }
}

/// Fill the back buffer and the depth buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Clear {
    /// Colour of every pixel.
    pub colour: Rgb332,
    /// Depth of every pixel.
    pub depth: u16,
}

impl Clear {
    /// Words of the packet.
    pub const WORDS: usize = 2;

    /// Returns the packet's words.
    pub fn encode(self) -> [u32; Self::WORDS] {
        [Header::of(Kind::Clear).0 | u32::from(self.colour.0), u32::from(self.depth)]
    }
}

/// Put a tag into FENCE when all before it is done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fence {
    /// The tag.
    pub tag: u32,
}

impl Fence {
    /// Words of the packet.
    pub const WORDS: usize = 2;

    /// Returns the packet's words.
    pub fn encode(self) -> [u32; Self::WORDS] {
        [Header::of(Kind::Fence).0, self.tag]
    }
}

/// Returns the one word of a swap packet.
pub const fn swap() -> [u32; 1] {
    [Header::of(Kind::Swap).0]
}
