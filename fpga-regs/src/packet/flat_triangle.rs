//! The triangle of one colour.

use super::{Header, Kind, PixelMode, TriangleShape, WordInfo};
use crate::screen::Rgb332;

/// A triangle of one colour, set up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FlatTriangle {
    /// Colour of every pixel.
    pub colour: Rgb332,
    /// What its pixels do.
    pub mode: PixelMode,
    /// Where it lies.
    pub shape: TriangleShape,
}

impl FlatTriangle {
    /// Words of the packet: a header and the shape.
    pub const WORDS: usize = 1 + TriangleShape::WORDS;

    pub(super) const WORD_TABLE: &'static [WordInfo] = &TriangleShape::WORD_TABLE;

    /// Returns the packet's words.
    #[inline(always)]
    pub fn encode(&self) -> [u32; Self::WORDS] {
        let header = Header::of(Kind::FlatTriangle).with_colour(self.colour.0).with_mode(self.mode);
        let mut words = [header.0; Self::WORDS];
        words[1..].copy_from_slice(&self.shape.encode());
        words
    }

    /// Returns the triangle in another colour.
    #[must_use]
    #[inline(always)]
    pub const fn with_colour(self, colour: Rgb332) -> Self {
        Self { colour, ..self }
    }
}
