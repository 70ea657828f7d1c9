//! The command packets that travel in the FIFO.
//!
//! A packet is a [`Header`] and as many more words as its length says. The device takes them in
//! order, one packet after another; nothing else orders commands.
//!
//! **Bad packets.** A header of unknown kind, a length that is not its kind's, a reserved bit
//! that is set, or a box that is empty or leaves the screen makes a *bad packet*: the device
//! skips as many words as the header's length says, sets `ERRORS.bad_packet`, counts it in
//! BAD_PACKETS, draws nothing for it and goes on. So no stream of words can hang it. A header of
//! zero is bad: a FIFO fed with zeros says so. A bad header counts when it is taken, a bad word
//! behind it when the packet's last word is.
//!
//! **Arithmetic.** The device adds edge values and depths modulo 2³², so that words which no setup
//! makes draw the same wrong pixels everywhere.
//!
//! **Formats of a triangle.** With A, B the steps of an edge function and E its value, a pixel is
//! inside where all three E ≥ 0 ([Pineda 1988]); the fill rule is folded into E by software.
//!
//! | quantity | format | range that setup produces |
//! | --- | --- | --- |
//! | edge step (A per pixel in x, B in y) | signed 16-bit integer | ±16,382: a difference of two coordinates in the [guard band](crate::screen::GUARD_BAND) |
//! | edge value at a pixel of the screen | signed integer, in steps of an edge | ±2²⁴: twice the area of a triangle in the guard band's square, ≤ 2²⁸, over [`SUBPIXEL`](crate::screen::SUBPIXEL) |
//! | depth and its steps | signed Q20.12 **modulo 2³²** | any; at every covered pixel the sum lies in −1…65,536 |
//!
//! Depth is modular on purpose. A plane seen nearly edge-on has slopes past any range, but a sum
//! of linear steps taken modulo 2³² is right wherever its true value is in range, and that is
//! so at every covered pixel. The device takes bits 31…12 as a signed integer and saturates it
//! to 0…65,535. The third edge's steps are not sent: the three sum to zero.
//!
//! [Pineda 1988]: https://doi.org/10.1145/54852.378457

use crate::layout::Field;
use crate::screen::{HEIGHT, PacketDepth, Rgb332, WIDTH};

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
    /// Shows the back buffer from the next vertical blank on: [`swap`].
    Swap = 0x10,
    /// Writes a tag to the FENCE register when all before it is done: [`Fence`].
    Fence = 0x11,
}

impl Kind {
    /// All kinds, by rising number.
    pub const ALL: &'static [Kind] = &[Kind::Clear, Kind::FlatTriangle, Kind::Swap, Kind::Fence];

    /// Returns the kind of a header's number, if there is such a kind.
    pub const fn from_number(number: u8) -> Option<Self> {
        match number {
            0x01 => Some(Kind::Clear),
            0x02 => Some(Kind::FlatTriangle),
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
            Kind::Swap => 0,
            Kind::Fence => Fence::WORDS - 1,
        }
    }

    /// Returns whether the header's low byte is a colour; otherwise it is reserved.
    pub const fn has_colour(self) -> bool {
        matches!(self, Kind::Clear | Kind::FlatTriangle)
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
            Kind::Swap => PacketInfo {
                name: "SWAP",
                doc: "Makes the back buffer the front one at the next vertical blank. What follows waits for it and goes to the other buffer.",
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
        /// Zero; room for later modes.
        reserved / with_reserved: [15:8] u8,
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

    /// Returns the packet's kind, or why the header is bad.
    pub fn check(self) -> Result<Kind, BadPacket> {
        let kind = Kind::from_number(self.kind()).ok_or(BadPacket::Kind)?;
        if usize::from(self.length()) != kind.length() {
            return Err(BadPacket::Length);
        }
        if self.reserved() != 0 || !kind.has_colour() && self.colour() != 0 {
            return Err(BadPacket::Reserved);
        }
        Ok(kind)
    }
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

word! {
    /// The depth that a clear fills with.
    ClearDepth {
        /// Depth, 0 (near) to 65,535 (far).
        depth / with_depth: [15:0] u16,
        /// Zero.
        reserved / with_reserved: [31:16] u16,
    }
}

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

/// A triangle of one colour, set up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FlatTriangle {
    /// Colour of every pixel.
    pub colour: Rgb332,
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

impl FlatTriangle {
    /// Words of the packet.
    pub const WORDS: usize = 11;

    const WORD_TABLE: &'static [WordInfo] = &[
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

    /// Returns the packet's words.
    #[inline(always)]
    pub fn encode(&self) -> [u32; Self::WORDS] {
        [
            Header::of(Kind::FlatTriangle).0 | u32::from(self.colour.0),
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

    /// Returns the triangle in another colour.
    #[must_use]
    #[inline(always)]
    pub const fn with_colour(self, colour: Rgb332) -> Self {
        Self { colour, ..self }
    }

    /// Returns the steps in x and in y of all three edges.
    ///
    /// The third pair needs 17 bits when the words do not come from setup.
    pub fn all_steps(&self) -> [(i32, i32); 3] {
        let [first, second] = self.steps.map(|steps| (i32::from(steps.step_x()), i32::from(steps.step_y())));
        [first, second, (-first.0 - second.0, -first.1 - second.1)]
    }
}

/// A packet, decoded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Packet {
    /// Fill both back buffers.
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

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle() -> FlatTriangle {
        FlatTriangle {
            colour: Rgb332(0xe3),
            columns: Span::new(3, 319),
            rows: Span::new(0, 239),
            edges: [-1, 1 << 26, -(1 << 26)],
            steps: [EdgeSteps::new(-32_766, 32_766), EdgeSteps::new(5, -7)],
            depth: PacketDepth::from_bits(i32::MIN),
            depth_step_x: PacketDepth::from_bits(-1),
            depth_step_y: PacketDepth::from_num(2.5),
        }
    }

    fn round_trip(words: &[u32]) -> Result<Packet, BadPacket> {
        Packet::decode(Header(words[0]), &words[1..])
    }

    #[test]
    fn every_kind_comes_back_as_it_was_encoded() {
        let clear = Clear { colour: Rgb332(0x1c), depth: 0xfffe };
        assert_eq!(round_trip(&clear.encode()), Ok(Packet::Clear(clear)));
        assert_eq!(round_trip(&triangle().encode()), Ok(Packet::FlatTriangle(triangle())));
        assert_eq!(round_trip(&swap()), Ok(Packet::Swap));
        let fence = Fence { tag: 0xdead_beef };
        assert_eq!(round_trip(&fence.encode()), Ok(Packet::Fence(fence)));
    }

    #[test]
    fn the_words_of_a_triangle_stand_where_the_table_says() {
        // Written out by hand from the table in the reference page.
        let words = triangle().encode();
        assert_eq!(words[0], 0x020a_00e3);
        assert_eq!(words[1], 319 << 16 | 3);
        assert_eq!(words[6], 0x7ffe_8002);
        assert_eq!(words[7], 0xfff9_0005);
        assert_eq!(words[10], 0x2800);
        assert_eq!(triangle().all_steps()[2], (32_761, -32_759));
    }

    #[test]
    fn the_table_has_a_word_for_every_word() {
        for kind in Kind::ALL {
            assert_eq!(kind.info().words.len(), kind.length(), "{kind:?}");
            assert_eq!(Kind::from_number(*kind as u8), Some(*kind));
            assert!(kind.length() < Packet::MAX_WORDS);
        }
        assert_eq!((0..=255).filter(|number| Kind::from_number(*number).is_some()).count(), Kind::ALL.len());
    }

    #[test]
    fn each_rule_makes_its_own_bad_packet() {
        let good = triangle().encode();
        let with = |index: usize, word: u32| {
            let mut words = good;
            words[index] = word;
            round_trip(&words)
        };
        assert_eq!(with(0, 0), Err(BadPacket::Kind));
        assert_eq!(with(0, 0x0209_0000), Err(BadPacket::Length));
        assert_eq!(with(0, 0x020a_0100), Err(BadPacket::Reserved));
        assert_eq!(with(1, Span::new(4, 3).0), Err(BadPacket::Box));
        assert_eq!(with(1, Span::new(0, 320).0), Err(BadPacket::Box));
        assert_eq!(with(2, Span::new(0, 240).0), Err(BadPacket::Box));
        assert_eq!(round_trip(&[0x1000_0001]), Err(BadPacket::Reserved));
        assert_eq!(round_trip(&[0x0101_0000, 0x1_0000]), Err(BadPacket::Reserved));
        assert_eq!(Packet::decode(Header::of(Kind::Fence), &[]), Err(BadPacket::Length));
    }
}
