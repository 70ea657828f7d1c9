//! The word that every packet starts with, the kinds, and the table of their words.

use super::{Clear, ClearDepth, Fence, FlatTriangle, GouraudTriangle};
use crate::layout::Field;

/// What a packet asks for; the number that stands in its header.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
#[non_exhaustive]
pub enum Kind {
    /// Fills the back buffer and the depth buffer: [`Clear`].
    Clear = 0x01,
    /// Draws a flat triangle into the back buffer: [`FlatTriangle`].
    FlatTriangle = 0x02,
    /// Draws a triangle whose colour changes from corner to corner: [`GouraudTriangle`].
    GouraudTriangle = 0x03,
    /// Shows the back buffer from the next vertical blank on: [`swap`].
    Swap = 0x10,
    /// Writes a tag to the FENCE register when all before it is done: [`Fence`].
    Fence = 0x11,
}

impl Kind {
    /// All kinds, by rising number.
    pub const ALL: &'static [Kind] = &[Kind::Clear, Kind::FlatTriangle, Kind::GouraudTriangle, Kind::Swap, Kind::Fence];

    /// Returns the kind of a header's number, if there is such a kind.
    pub const fn from_number(number: u8) -> Option<Self> {
        match number {
            0x01 => Some(Kind::Clear),
            0x02 => Some(Kind::FlatTriangle),
            0x03 => Some(Kind::GouraudTriangle),
            0x10 => Some(Kind::Swap),
            0x11 => Some(Kind::Fence),
            _ => None,
        }
    }

    /// Returns how many words follow the header.
    pub const fn length(self) -> usize {
        match self {
            Kind::Clear => Clear::WORDS - 1,
            Kind::FlatTriangle => FlatTriangle::WORDS - 1,
            Kind::GouraudTriangle => GouraudTriangle::WORDS - 1,
            Kind::Swap => 0,
            Kind::Fence => Fence::WORDS - 1,
        }
    }

    /// Returns whether the header's low byte is a colour; otherwise it is reserved.
    pub const fn has_colour(self) -> bool {
        matches!(self, Kind::Clear | Kind::FlatTriangle)
    }

    /// Returns whether the header may hold a [`PixelMode`]; otherwise its bits are reserved.
    pub const fn has_mode(self) -> bool {
        matches!(self, Kind::FlatTriangle | Kind::GouraudTriangle)
    }

    /// Returns the kind's row in the packet table.
    pub const fn info(self) -> PacketInfo {
        match self {
            Kind::Clear => PacketInfo {
                name: "CLEAR",
                doc: "Fills the whole back buffer with the header's colour and the depth buffer with one depth.",
                words: &[WordInfo { name: "depth", fields: ClearDepth::FIELDS, doc: ClearDepth::DOC }],
            },
            Kind::FlatTriangle => PacketInfo {
                name: "FLAT_TRIANGLE",
                doc: "Draws the pixels of a box that lie inside three edges and are nearer than what is there, in the header's colour.",
                words: FlatTriangle::WORD_TABLE,
            },
            Kind::GouraudTriangle => PacketInfo {
                name: "GOURAUD_TRIANGLE",
                doc: "As FLAT_TRIANGLE, but each channel of the colour is a plane over the screen. Each pixel is dithered to RGB332.",
                words: GouraudTriangle::WORD_TABLE,
            },
            Kind::Swap => PacketInfo {
                name: "SWAP",
                doc: "Makes the back buffer the front one at the next vertical blank. What follows waits for it and goes to the other buffer. There is at most one swap in a vertical blank. One with nothing drawn since the last is like any other: it waits, counts, and shows what the back buffer holds, which was in front before.",
                words: &[],
            },
            Kind::Fence => PacketInfo {
                name: "FENCE",
                doc: "When all packets before it are done, puts its tag into FENCE and raises the fence interrupt.",
                words: &[WordInfo { name: "tag", fields: &[], doc: " Any 32-bit number." }],
            },
        }
    }
}

/// A packet kind's row in the table that the page and the package are generated from.
#[derive(Debug, Clone, Copy)]
pub struct PacketInfo {
    /// Name in upper case, as in the SystemVerilog package.
    pub name: &'static str,
    /// What it does.
    pub doc: &'static str,
    /// The words after the header.
    pub words: &'static [WordInfo],
}

/// A word of a packet.
#[derive(Debug, Clone, Copy)]
pub struct WordInfo {
    /// Name in lower case with underscores.
    pub name: &'static str,
    /// Its fields; empty when it is one 32-bit number.
    pub fields: &'static [Field],
    /// What it holds.
    pub doc: &'static str,
}

word! {
    /// The word that every packet starts with.
    Header {
        /// RGB332 colour of a clear or a flat triangle; zero in other kinds.
        colour / with_colour: [7:0] u8,
        /// Triangles only: tests no depth and leaves depth as it is.
        keep_depth / with_keep_depth: [8:8] bool,
        /// Triangles only: leaves colour as it is.
        keep_colour / with_keep_colour: [9:9] bool,
        /// Triangles only: the colour is the depth as grey, the farther the darker.
        depth_grey / with_depth_grey: [10:10] bool,
        /// Zero; room for later modes.
        reserved / with_reserved: [15:11] u8,
        /// How many words follow.
        length / with_length: [23:16] u8,
        /// What the packet asks for.
        kind / with_kind: [31:24] u8,
    }
}

impl Header {
    /// Returns the header of a packet of `kind`, with colour 0.
    #[inline(always)]
    pub const fn of(kind: Kind) -> Self {
        Self((kind as u32) << 24 | (kind.length() as u32) << 16)
    }

    /// Returns this header with a mode.
    #[must_use]
    pub fn with_mode(self, mode: PixelMode) -> Self {
        self.with_keep_depth(mode.keep_depth).with_keep_colour(mode.keep_colour).with_depth_grey(mode.depth_grey)
    }

    /// Returns the mode.
    pub fn mode(self) -> PixelMode {
        PixelMode { keep_depth: self.keep_depth(), keep_colour: self.keep_colour(), depth_grey: self.depth_grey() }
    }

    /// Returns the packet's kind, or why the header is bad.
    pub fn check(self) -> Result<Kind, BadPacket> {
        let kind = Kind::from_number(self.kind()).ok_or(BadPacket::Kind)?;
        if usize::from(self.length()) != kind.length() {
            return Err(BadPacket::Length);
        }
        let colour = !kind.has_colour() && self.colour() != 0;
        let mode = !kind.has_mode() && self.mode() != PixelMode::USUAL;
        if self.reserved() != 0 || colour || mode {
            return Err(BadPacket::Reserved);
        }
        Ok(kind)
    }
}

/// What a triangle's covered pixels do.
///
/// Usual is: a pixel that is nearer than what is there replaces its depth and its colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PixelMode {
    /// Tests no depth and leaves depth as it is: for what lies on top, like an overlay.
    pub keep_depth: bool,
    /// Leaves colour as it is: for what only hides, like the faces behind visible lines.
    pub keep_colour: bool,
    /// The colour is grey: 255 minus the upper 8 bits of the depth, dithered as a Gouraud triangle is.
    pub depth_grey: bool,
}

impl PixelMode {
    /// The usual mode.
    pub const USUAL: Self = Self { keep_depth: false, keep_colour: false, depth_grey: false };
}

/// Why a packet is bad.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum BadPacket {
    /// No packet has this kind.
    Kind,
    /// The length is not the one that this kind has.
    Length,
    /// A reserved bit is set.
    Reserved,
    /// The box is empty or leaves the screen.
    Box,
}

impl core::fmt::Display for BadPacket {
    fn fmt(&self, out: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        out.write_str(match self {
            BadPacket::Kind => "unknown packet kind",
            BadPacket::Length => "length is not the one of its kind",
            BadPacket::Reserved => "a reserved bit is set",
            BadPacket::Box => "box is empty or leaves the screen",
        })
    }
}
