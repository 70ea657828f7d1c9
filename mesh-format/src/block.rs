//! A part of a mesh that is drawn at one go.

use crate::{Count, EDGES_MAX, FACES_MAX, Flags, FormatError, VERTICES_MAX};

/// Bytes of a block's own header.
pub(crate) const BLOCK_HEADER_BYTES: usize = 8;

/// A block: slices of the file's bytes. What the file's [`Flags`] leave out is empty.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Block<'a> {
    /// Positions as the file has them; [`Block::position`] reads one.
    pub positions: &'a [[u8; 6]],
    /// Normals of the vertices, signed.
    pub normals: &'a [[u8; 3]],
    /// Colours of the vertices.
    pub colours: &'a [[u8; 3]],
    /// Corners of the faces.
    pub corners: &'a [[u8; 3]],
    /// Normals of the faces, signed.
    pub face_normals: &'a [[u8; 3]],
    /// Colours of the faces.
    pub face_colours: &'a [[u8; 3]],
    /// Edges.
    pub edges: &'a [[u8; 2]],
}

impl<'a> Block<'a> {
    /// Returns a position's three numbers.
    #[inline(always)]
    #[must_use]
    pub const fn position([x, x_high, y, y_high, z, z_high]: [u8; 6]) -> [u16; 3] {
        [u16::from_le_bytes([x, x_high]), u16::from_le_bytes([y, y_high]), u16::from_le_bytes([z, z_high])]
    }

    /// Cuts block number `block` off the front of `bytes`, which lie at `offset` in the file; returns it with
    /// its length.
    pub(crate) fn cut(bytes: &'a [u8], flags: Flags, block: u32, offset: usize) -> Result<(Self, usize), FormatError> {
        let too_short = |wanted| FormatError::BlockCut { block, offset, wanted, left: bytes.len() };
        let header: &[u8; BLOCK_HEADER_BYTES] = bytes.first_chunk().ok_or(too_short(BLOCK_HEADER_BYTES))?;
        let [vertices, faces, edges, zero] =
            [0, 2, 4, 6].map(|at: usize| u16::from_le_bytes([header[at], header[at + 1]]));
        let counted = |of, found: u16, range: core::ops::RangeInclusive<usize>| {
            let count = usize::from(found);
            if range.contains(&count) { Ok(count) } else { Err(FormatError::BlockCount { block, of, found }) }
        };
        let vertices = counted(Count::Vertices, vertices, 1..=VERTICES_MAX)?;
        let faces = counted(Count::Faces, faces, 0..=FACES_MAX)?;
        let edges = counted(Count::Edges, edges, 0..=EDGES_MAX)?;
        if zero != 0 {
            let at = if header[6] != 0 { 6 } else { 7 };
            return Err(FormatError::NotZero { offset: offset + at, found: header[at] });
        }
        let given = |flag, count| if flags.contains(flag) { count } else { 0 };
        let triples = [
            given(Flags::VERTEX_NORMALS, vertices),
            given(Flags::VERTEX_COLOURS, vertices),
            faces,
            given(Flags::FACE_NORMALS, faces),
            given(Flags::FACE_COLOURS, faces),
        ];
        let used = BLOCK_HEADER_BYTES + 6 * vertices + 3 * triples.iter().sum::<usize>() + 2 * edges;
        let wanted = used.next_multiple_of(4);
        let whole = bytes.get(..wanted).ok_or(too_short(wanted))?;
        if let Some(at) = (used..wanted).find(|at| whole[*at] != 0) {
            return Err(FormatError::NotZero { offset: offset + at, found: whole[at] });
        }
        let mut rest = &whole[BLOCK_HEADER_BYTES..];
        let mut part = |bytes: usize| {
            let (part, others) = rest.split_at(bytes);
            rest = others;
            part
        };
        let positions = part(6 * vertices).as_chunks().0;
        let [normals, colours, corners, face_normals, face_colours] =
            triples.map(|count| part(3 * count).as_chunks().0);
        let edges = part(2 * edges).as_chunks().0;
        Ok((Self { positions, normals, colours, corners, face_normals, face_colours, edges }, wanted))
    }

    /// Checks that faces and edges name vertices of this block.
    pub(crate) fn check(&self, block: u32) -> Result<(), FormatError> {
        let vertices = self.positions.len();
        let missing = |of, index, vertex| FormatError::NoSuchVertex { block, of, index, vertex, vertices };
        for (index, corners) in self.corners.iter().enumerate() {
            if let Some(vertex) = corners.iter().find(|corner| usize::from(**corner) >= vertices) {
                return Err(missing(Count::Faces, index, *vertex));
            }
        }
        for (index, ends) in self.edges.iter().enumerate() {
            if let Some(vertex) = ends.iter().find(|end| usize::from(**end) >= vertices) {
                return Err(missing(Count::Edges, index, *vertex));
            }
        }
        Ok(())
    }
}
