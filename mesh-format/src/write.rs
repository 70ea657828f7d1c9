//! Writes files.

use alloc::vec::Vec;

use crate::read::CHECKED_FROM;
use crate::{CRC, Flags, FormatError, HEADER_BYTES, Header, MAGIC, MeshFile, VERSION};

/// A block to be written. Parts that the flags leave out are not looked at; normals and colours are cut, or
/// filled up with zeros, to as many as there are vertices or faces.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct BlockData {
    /// Numbers of x, y and z.
    pub positions: Vec<[u16; 3]>,
    /// Normals of the vertices, [`NORMAL_ONE`](crate::NORMAL_ONE) is 1.
    pub normals: Vec<[i8; 3]>,
    /// Colours of the vertices.
    pub colours: Vec<[u8; 3]>,
    /// Corners of the faces.
    pub corners: Vec<[u8; 3]>,
    /// Normals of the faces.
    pub face_normals: Vec<[i8; 3]>,
    /// Colours of the faces.
    pub face_colours: Vec<[u8; 3]>,
    /// Edges.
    pub edges: Vec<[u8; 2]>,
}

/// Returns a file of these blocks. Of `header` the counts are not looked at: they are worked out.
///
/// # Errors
/// [`FormatError`] for what would make a file that cannot be read: a block too large, a face that names no
/// vertex, positions out of range, more than 4 GiB.
pub fn write(header: &Header, blocks: &[BlockData]) -> Result<Vec<u8>, FormatError> {
    let mut bytes = Vec::with_capacity(HEADER_BYTES);
    bytes.extend(MAGIC);
    // The checksum and the length follow when there is something to count.
    bytes.extend([0; 8]);
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend(header.flags.0.to_le_bytes());
    let total = |count: fn(&BlockData) -> usize| blocks.iter().map(count).sum::<usize>() as u32;
    let counts = [
        total(|block| block.positions.len()),
        total(|block| block.corners.len()),
        total(|block| block.edges.len()),
        blocks.len() as u32,
    ];
    counts.iter().for_each(|count| bytes.extend(count.to_le_bytes()));
    header.offset.iter().for_each(|offset| bytes.extend(offset.to_le_bytes()));
    header.step.iter().for_each(|step| bytes.extend(step.to_le_bytes()));
    bytes.extend(header.scale_log2.to_le_bytes());
    bytes.extend(header.colour);
    bytes.resize(HEADER_BYTES, 0);
    for block in blocks {
        block.append(header.flags, &mut bytes);
    }
    let length = u32::try_from(bytes.len()).map_err(|_| FormatError::Length { stated: 0, found: bytes.len() })?;
    bytes[8..12].copy_from_slice(&length.to_le_bytes());
    let checksum = CRC.checksum(&bytes[CHECKED_FROM..]);
    bytes[4..8].copy_from_slice(&checksum.to_le_bytes());
    MeshFile::read(&bytes)?;
    Ok(bytes)
}

impl BlockData {
    fn append(&self, flags: Flags, bytes: &mut Vec<u8>) {
        for count in [self.positions.len(), self.corners.len(), self.edges.len(), 0] {
            // One that is too large for 16 bits is too large for a block, and refused as such.
            bytes.extend(u16::try_from(count).unwrap_or(u16::MAX).to_le_bytes());
        }
        self.positions.as_flattened().iter().for_each(|number| bytes.extend(number.to_le_bytes()));
        let (vertices, faces) = (self.positions.len(), self.corners.len());
        let signed = |part: &[[i8; 3]]| part.as_flattened().iter().map(|part| *part as u8).collect::<Vec<u8>>();
        let mut part = |there: bool, mut part: Vec<u8>, count: usize| {
            if there {
                part.resize(count, 0);
                bytes.extend(part);
            }
        };
        part(flags.contains(Flags::VERTEX_NORMALS), signed(&self.normals), 3 * vertices);
        part(flags.contains(Flags::VERTEX_COLOURS), self.colours.as_flattened().to_vec(), 3 * vertices);
        part(true, self.corners.as_flattened().to_vec(), 3 * faces);
        part(flags.contains(Flags::FACE_NORMALS), signed(&self.face_normals), 3 * faces);
        part(flags.contains(Flags::FACE_COLOURS), self.face_colours.as_flattened().to_vec(), 3 * faces);
        part(true, self.edges.as_flattened().to_vec(), 2 * self.edges.len());
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
}
