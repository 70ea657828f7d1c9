//! Checks a file once, so that drawing need not.

use crate::block::Block;
use crate::{CRC, Count, Flags, FormatError, HEADER_BYTES, Header, MAGIC, VERSION};

/// Where the bytes that the checksum covers start.
pub(crate) const CHECKED_FROM: usize = 8;

/// A mesh file that was checked. It borrows the bytes; nothing is copied.
#[derive(Debug, Clone, Copy)]
pub struct MeshFile<'a> {
    header: Header,
    blocks: &'a [u8],
}

impl<'a> MeshFile<'a> {
    /// Checks a file, byte for byte, and returns it. Reads every byte twice: once for the checksum.
    ///
    /// # Errors
    /// [`FormatError`] for the first thing that is not as the [crate] says.
    pub fn read(bytes: &'a [u8]) -> Result<Self, FormatError> {
        let start: &[u8; HEADER_BYTES] = Self::start(bytes)?;
        let word = |at: usize| u32::from_le_bytes([start[at], start[at + 1], start[at + 2], start[at + 3]]);
        let stated = word(8);
        if usize::try_from(stated) != Ok(bytes.len()) {
            return Err(FormatError::Length { stated, found: bytes.len() });
        }
        let (stated, found) = (word(4), CRC.checksum(&bytes[CHECKED_FROM..]));
        if stated != found {
            return Err(FormatError::Checksum { stated, found });
        }
        let header = Header::from_bytes(start);
        if !Flags::KNOWN.contains(header.flags) {
            return Err(FormatError::Flags { found: header.flags });
        }
        if let Some(offset) = (61..HEADER_BYTES).find(|at| start[*at] != 0) {
            return Err(FormatError::NotZero { offset, found: start[offset] });
        }
        if let Some(axis) = (0..3).find(|axis| !header.is_in_range(*axis)) {
            return Err(FormatError::Range { axis, offset: header.offset[axis], step: header.step[axis] });
        }
        if header.blocks == 0 {
            return Err(FormatError::Empty);
        }
        let file = Self { header, blocks: &bytes[HEADER_BYTES..] };
        file.check_blocks()?;
        Ok(file)
    }

    /// As [`read`](Self::read), of a file at the start of `bytes`, however many follow: for memory that a file
    /// was loaded to by something that does not tell its length.
    ///
    /// # Errors
    /// As of [`read`](Self::read); [`FormatError::Length`] when it does not end within `bytes`.
    pub fn read_start(bytes: &'a [u8]) -> Result<Self, FormatError> {
        let start = Self::start(bytes)?;
        let stated = u32::from_le_bytes([start[8], start[9], start[10], start[11]]);
        let file = usize::try_from(stated).ok().and_then(|length| bytes.get(..length));
        Self::read(file.ok_or(FormatError::Length { stated, found: bytes.len() })?)
    }

    /// Checks what must be right before anything else means something.
    fn start(bytes: &[u8]) -> Result<&[u8; HEADER_BYTES], FormatError> {
        match bytes.first_chunk() {
            Some(found) if *found != MAGIC => return Err(FormatError::NotAMesh { found: *found }),
            _ => {}
        }
        let start: &[u8; HEADER_BYTES] = bytes.first_chunk().ok_or(FormatError::TooShort { bytes: bytes.len() })?;
        match u16::from_le_bytes([start[12], start[13]]) {
            VERSION => Ok(start),
            found => Err(FormatError::Version { found }),
        }
    }

    fn check_blocks(&self) -> Result<(), FormatError> {
        let Header { flags, blocks, .. } = self.header;
        let mut rest = self.blocks;
        let mut totals = [0u32; 3];
        for block in 0..blocks {
            let offset = HEADER_BYTES + self.blocks.len() - rest.len();
            let (content, length) = Block::cut(rest, flags, block, offset)?;
            content.check(block)?;
            rest = &rest[length..];
            let counts = [content.positions.len(), content.corners.len(), content.edges.len()];
            // A file of 32 bits' length has fewer of each.
            totals = [0, 1, 2].map(|of| totals[of].wrapping_add(counts[of] as u32));
        }
        if !rest.is_empty() {
            let offset = HEADER_BYTES + self.blocks.len() - rest.len();
            return Err(FormatError::Rest { offset, bytes: rest.len() });
        }
        let stated = [self.header.vertices, self.header.faces, self.header.edges];
        for (index, of) in [Count::Vertices, Count::Faces, Count::Edges].into_iter().enumerate() {
            if stated[index] != totals[index] {
                return Err(FormatError::Total { of, stated: stated[index], found: totals[index] });
            }
        }
        Ok(())
    }

    /// Returns what the header says.
    #[must_use]
    pub const fn header(&self) -> &Header {
        &self.header
    }

    /// Returns the blocks, in the order in which they are to be drawn.
    #[must_use]
    pub const fn blocks(&self) -> Blocks<'a> {
        Blocks { rest: self.blocks, flags: self.header.flags }
    }
}

/// The blocks of a [`MeshFile`].
#[derive(Debug, Clone)]
pub struct Blocks<'a> {
    rest: &'a [u8],
    flags: Flags,
}

impl<'a> Iterator for Blocks<'a> {
    type Item = Block<'a>;

    fn next(&mut self) -> Option<Block<'a>> {
        // Checked already: the only error that can come is that nothing is left.
        let (block, length) = Block::cut(self.rest, self.flags, 0, 0).ok()?;
        self.rest = &self.rest[length..];
        Some(block)
    }
}
