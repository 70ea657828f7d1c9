//! What can be wrong with a file, each with its remedy.

use core::fmt;

use crate::{EDGES_MAX, FACES_MAX, Flags, HEADER_BYTES, VERSION, VERTICES_MAX};

/// What is counted in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Count {
    /// Vertices.
    Vertices,
    /// Faces.
    Faces,
    /// Edges.
    Edges,
}

impl Count {
    const fn name(self) -> &'static str {
        match self {
            Self::Vertices => "vertices",
            Self::Faces => "faces",
            Self::Edges => "edges",
        }
    }

    const fn singular(self) -> &'static str {
        match self {
            Self::Vertices => "vertex",
            Self::Faces => "face",
            Self::Edges => "edge",
        }
    }

    const fn most(self) -> usize {
        match self {
            Self::Vertices => VERTICES_MAX,
            Self::Faces => FACES_MAX,
            Self::Edges => EDGES_MAX,
        }
    }
}

/// Why bytes are no mesh file. Blocks, faces, edges and vertices count from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum FormatError {
    /// Fewer bytes than a header.
    TooShort {
        /// Bytes that are there.
        bytes: usize,
    },
    /// The first bytes are another file's.
    NotAMesh {
        /// The first bytes.
        found: [u8; 4],
    },
    /// A version that this program does not read.
    Version {
        /// The file's.
        found: u16,
    },
    /// The header states another length than the file has.
    Length {
        /// In the header.
        stated: u32,
        /// The file's.
        found: usize,
    },
    /// The checksum is another than the bytes give.
    Checksum {
        /// In the header.
        stated: u32,
        /// Of the bytes.
        found: u32,
    },
    /// Flags that this version does not know.
    Flags {
        /// The header's.
        found: Flags,
    },
    /// A byte that must be 0 is not.
    NotZero {
        /// Where it is in the file.
        offset: usize,
        /// What it is.
        found: u8,
    },
    /// Some number of an axis would give a coordinate of more than 32 bits.
    Range {
        /// The axis: 0, 1, 2 for x, y, z.
        axis: usize,
        /// Its offset.
        offset: i32,
        /// Its step.
        step: u32,
    },
    /// A block has more than a block may, or no vertex.
    BlockCount {
        /// The block.
        block: u32,
        /// Of what.
        of: Count,
        /// How many.
        found: u16,
    },
    /// A block does not end before the file does.
    BlockCut {
        /// The block.
        block: u32,
        /// Where it starts in the file.
        offset: usize,
        /// Bytes that it wants.
        wanted: usize,
        /// Bytes that are left.
        left: usize,
    },
    /// A face or an edge names a vertex that its block does not have.
    NoSuchVertex {
        /// The block.
        block: u32,
        /// [`Count::Faces`] or [`Count::Edges`].
        of: Count,
        /// Which face or edge of the block.
        index: usize,
        /// The vertex it names.
        vertex: u8,
        /// How many the block has.
        vertices: usize,
    },
    /// The blocks together have another number of something than the header states.
    Total {
        /// Of what.
        of: Count,
        /// In the header.
        stated: u32,
        /// In the blocks.
        found: u32,
    },
    /// The header states no block.
    Empty,
    /// Bytes are left behind the last block.
    Rest {
        /// Where they start in the file.
        offset: usize,
        /// How many.
        bytes: usize,
    },
}

impl fmt::Display for FormatError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::TooShort { bytes } => write!(
                out,
                "{bytes} bytes are no mesh file, whose header alone has {HEADER_BYTES}: load the whole file"
            ),
            Self::NotAMesh { found } => {
                write!(out, "starts with {found:02x?}, no mesh file: make one with `cargo xtask mesh`")
            }
            Self::Version { found } => write!(
                out,
                "mesh file of version {found}, this program reads version {VERSION}: make it again with `cargo xtask mesh`"
            ),
            Self::Length { stated, found } => {
                write!(out, "{found} bytes of a mesh file of {stated}: load the whole file, and no more than that")
            }
            Self::Checksum { stated, found } => {
                write!(out, "checksum {found:#010x} where the file states {stated:#010x}: copy the file again")
            }
            Self::Flags { found: Flags(flags) } => write!(
                out,
                "flags {flags:#06x}, of which {:#06x} mean nothing in version {VERSION}: make the file again with `cargo xtask mesh`",
                flags & !Flags::KNOWN.0
            ),
            Self::NotZero { offset, found } => {
                write!(out, "byte {offset} is {found:#04x} and must be 0: {REMAKE}")
            }
            Self::Range { axis, offset, step } => write!(
                out,
                "offset {offset} and step {step} of {} lead out of -8...8: {REMAKE}",
                ["x", "y", "z"].get(axis).unwrap_or(&"an axis")
            ),
            Self::BlockCount { block, of: Count::Vertices, found: 0 } => {
                write!(out, "block {block} has no vertex: {REMAKE}")
            }
            Self::BlockCount { block, of, found } => {
                write!(out, "block {block} has {found} {}, at most {} are allowed: {REMAKE}", of.name(), of.most())
            }
            Self::BlockCut { block, offset, wanted, left } => {
                write!(out, "block {block} at byte {offset} wants {wanted} bytes where {left} are left: {REMAKE}")
            }
            Self::NoSuchVertex { block, of, index, vertex, vertices } => {
                write!(out, "{} {index} of block {block} names vertex {vertex} of {vertices}: {REMAKE}", of.singular())
            }
            Self::Total { of, stated, found } => {
                write!(out, "the header states {stated} {}, the blocks have {found}: {REMAKE}", of.name())
            }
            Self::Empty => write!(out, "the file has no block: {REMAKE}"),
            Self::Rest { offset, bytes } => {
                write!(out, "{bytes} bytes behind the last block, from byte {offset} on: {REMAKE}")
            }
        }
    }
}

/// For what a right checksum over wrong bytes means: the program that wrote them is at fault.
const REMAKE: &str = "make the file with `cargo xtask mesh`";

impl core::error::Error for FormatError {}
