//! The first 64 bytes.

use crate::HEADER_BYTES;

/// Which parts a file's blocks have, and how its faces are seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Flags(pub u16);

impl Flags {
    /// Vertices have normals.
    pub const VERTEX_NORMALS: Self = Self(1 << 0);
    /// Vertices have colours.
    pub const VERTEX_COLOURS: Self = Self(1 << 1);
    /// Faces have normals.
    pub const FACE_NORMALS: Self = Self(1 << 2);
    /// Faces have colours.
    pub const FACE_COLOURS: Self = Self(1 << 3);
    /// Faces are seen from both sides.
    pub const TWO_SIDED: Self = Self(1 << 4);
    /// All that this version knows.
    pub const KNOWN: Self = Self(0b1_1111);

    /// Returns whether all flags of `other` are set.
    #[must_use]
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Returns the flags of both.
    #[must_use]
    pub const fn with(self, other: Self, set: bool) -> Self {
        if set { Self(self.0 | other.0) } else { self }
    }
}

/// What the header says about the whole mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Header {
    /// Which parts the blocks have.
    pub flags: Flags,
    /// Vertices in all blocks; one on a border counts in each.
    pub vertices: u32,
    /// Faces in all blocks.
    pub faces: u32,
    /// Edges in all blocks.
    pub edges: u32,
    /// Number of blocks.
    pub blocks: u32,
    /// What the numbers of x, y and z start from, Q4.28.
    pub offset: [i32; 3],
    /// What a number counts, in units of 2⁻²⁸.
    pub step: [u32; 3],
    /// The model's own coordinate is the stored one times 2 to this.
    pub scale_log2: i16,
    /// Colour of what has none of its own: red, green, blue.
    pub colour: [u8; 3],
}

impl Header {
    /// Returns a coordinate, Q4.28, of its number in a file.
    ///
    /// Of a file that was read it is exact; of a made-up header it wraps.
    #[inline(always)]
    #[must_use]
    pub const fn coordinate(&self, axis: usize, number: u16) -> i32 {
        self.offset[axis].wrapping_add((number as u32).wrapping_mul(self.step[axis]) as i32)
    }

    /// Returns the greatest magnitude that a coordinate of each axis can have, in units of 2⁻²⁸.
    #[must_use]
    pub fn extent(&self) -> [u32; 3] {
        [0, 1, 2].map(|axis| {
            let ends = [self.offset[axis], self.coordinate(axis, u16::MAX)];
            ends[0].unsigned_abs().max(ends[1].unsigned_abs())
        })
    }

    /// Returns whether every number of an axis gives a coordinate of 32 bits.
    pub(crate) fn is_in_range(&self, axis: usize) -> bool {
        let highest = i64::from(self.offset[axis]) + i64::from(self.step[axis]) * i64::from(u16::MAX);
        highest <= i64::from(i32::MAX)
    }

    /// Reads what stands behind magic, checksum, length and version.
    pub(crate) fn from_bytes(bytes: &[u8; HEADER_BYTES]) -> Self {
        let word = |at: usize| u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
        let axes = |at: usize| [word(at), word(at + 4), word(at + 8)];
        Self {
            flags: Flags((word(12) >> 16) as u16),
            vertices: word(16),
            faces: word(20),
            edges: word(24),
            blocks: word(28),
            offset: axes(32).map(|part| part as i32),
            step: axes(44),
            scale_log2: word(56) as i16,
            colour: [bytes[58], bytes[59], bytes[60]],
        }
    }
}
