//! The triangle of one colour.

use super::{Header, Kind, TriangleShape, WordInfo};
use crate::screen::Rgb332;

/// A triangle of one colour, set up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FlatTriangle {
    /// Colour of every pixel.
    pub colour: Rgb332,
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
        let mut words = [Header::of(Kind::FlatTriangle).0 | u32::from(self.colour.0); Self::WORDS];
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
