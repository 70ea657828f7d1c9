//! What all triangle packets end with: box, edges and depth.

use super::{BadPacket, WordInfo};
use crate::screen::{HEIGHT, PacketDepth, WIDTH};

word! {
    /// One axis of a triangle's box, both ends inclusive, in pixels.
    Span {
        /// First pixel.
        first / with_first: [15:0] u16,
        /// Last pixel.
        last / with_last: [31:16] u16,
    }
}

impl Span {
    /// Returns the span from `first` to `last`.
    #[inline(always)]
    pub const fn new(first: u16, last: u16) -> Self {
        Self(first as u32 | (last as u32) << 16)
    }

    /// Returns whether the span is not empty and ends before `size`.
    pub fn is_within(self, size: u32) -> bool {
        self.first() <= self.last() && u32::from(self.last()) < size
    }
}

word! {
    /// Steps of an edge function from a pixel to its neighbour, in sixteenths of a pixel.
    EdgeSteps {
        /// A: what one pixel to the right adds.
        step_x / with_step_x: [15:0] i16,
        /// B: what one row down adds.
        step_y / with_step_y: [31:16] i16,
    }
}

impl EdgeSteps {
    /// Returns the word of two steps; each is cut to 16 bits.
    #[inline(always)]
    pub const fn new(step_x: i32, step_y: i32) -> Self {
        Self(step_x as u32 & 0xffff | (step_y as u32) << 16)
    }
}

/// Where a triangle lies on the screen and in depth, set up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TriangleShape {
    /// Columns of the box.
    pub columns: Span,
    /// Rows of the box.
    pub rows: Span,
    /// Edge values at the centre of the box's upper left pixel, fill rule folded in.
    pub edges: [i32; 3],
    /// Steps of the first two edges; the third's are minus their sum.
    pub steps: [EdgeSteps; 2],
    /// Depth at the centre of the box's upper left pixel, Q20.12 modulo 2³².
    pub depth: PacketDepth,
    /// Depth step of one pixel to the right.
    pub depth_step_x: PacketDepth,
    /// Depth step of one row down.
    pub depth_step_y: PacketDepth,
}

impl TriangleShape {
    /// Words of a shape, the last ones of its packet.
    pub const WORDS: usize = 10;

    pub(super) const WORD_TABLE: [WordInfo; Self::WORDS] = [
        WordInfo { name: "columns", fields: Span::FIELDS, doc: " Columns of the box." },
        WordInfo { name: "rows", fields: Span::FIELDS, doc: " Rows of the box." },
        WordInfo { name: "edge0", fields: &[], doc: " Edge 0 at the box's upper left pixel centre, signed." },
        WordInfo { name: "edge1", fields: &[], doc: " Edge 1 there." },
        WordInfo { name: "edge2", fields: &[], doc: " Edge 2 there." },
        WordInfo { name: "steps0", fields: EdgeSteps::FIELDS, doc: " Steps of edge 0." },
        WordInfo {
            name: "steps1",
            fields: EdgeSteps::FIELDS,
            doc: " Steps of edge 1; edge 2's are minus the sum of both.",
        },
        WordInfo {
            name: "depth",
            fields: &[],
            doc: " Depth at the box's upper left pixel centre, signed Q20.12 modulo 2^32.",
        },
        WordInfo { name: "depth_step_x", fields: &[], doc: " Depth step of one pixel to the right." },
        WordInfo { name: "depth_step_y", fields: &[], doc: " Depth step of one row down." },
    ];

    /// Returns the shape's words.
    #[inline(always)]
    pub fn encode(&self) -> [u32; Self::WORDS] {
        [
            self.columns.0,
            self.rows.0,
            self.edges[0] as u32,
            self.edges[1] as u32,
            self.edges[2] as u32,
            self.steps[0].0,
            self.steps[1].0,
            self.depth.to_bits() as u32,
            self.depth_step_x.to_bits() as u32,
            self.depth_step_y.to_bits() as u32,
        ]
    }

    /// Returns the shape that words make.
    ///
    /// # Errors
    /// [`BadPacket::Box`] when the box is empty or leaves the screen.
    pub(super) fn decode(words: [u32; Self::WORDS]) -> Result<Self, BadPacket> {
        let [columns, rows, edge0, edge1, edge2, steps0, steps1, depth, depth_step_x, depth_step_y] = words;
        let (columns, rows) = (Span(columns), Span(rows));
        if !columns.is_within(WIDTH) || !rows.is_within(HEIGHT) {
            return Err(BadPacket::Box);
        }
        let depth_from = |word: u32| PacketDepth::from_bits(word as i32);
        Ok(Self {
            columns,
            rows,
            edges: [edge0 as i32, edge1 as i32, edge2 as i32],
            steps: [EdgeSteps(steps0), EdgeSteps(steps1)],
            depth: depth_from(depth),
            depth_step_x: depth_from(depth_step_x),
            depth_step_y: depth_from(depth_step_y),
        })
    }

    /// Returns the steps in x and in y of all three edges.
    ///
    /// The third pair needs 17 bits when the words do not come from setup.
    pub fn all_steps(&self) -> [(i32, i32); 3] {
        let [first, second] = self.steps.map(|steps| (i32::from(steps.step_x()), i32::from(steps.step_y())));
        [first, second, (-first.0 - second.0, -first.1 - second.1)]
    }
}
