//! The mesh file (`.mesh`): what `cargo xtask mesh` writes and the firmware draws from as it lies in memory.
//!
//! A file is a header and blocks. A block has at most [`VERTICES_MAX`] vertices and all that its faces and
//! edges need, so whoever draws it wants memory for one block, however large the mesh. A vertex on the border
//! of two blocks is in both, with the same numbers: its pixels are the same, and there is no crack.
//!
//! Numbers are little-endian. Every byte is accounted for: [`MeshFile::read`] refuses a file in which any of
//! them is not what this page says, and names it. Nothing behind it has to check again.
//!
//! # Header, 64 bytes
//!
//! | offset | size | what |
//! | --- | --- | --- |
//! | 0 | 4 | [`MAGIC`]: 0x89, `HSM` |
//! | 4 | 4 | CRC-32 (ISO-HDLC, as in PNG and ZIP) of all that follows, from offset 8 to the end |
//! | 8 | 4 | length of the file in bytes |
//! | 12 | 2 | version: [`VERSION`] |
//! | 14 | 2 | [`Flags`] |
//! | 16 | 4 | vertices in all blocks; one on a border counts in each |
//! | 20 | 4 | faces in all blocks |
//! | 24 | 4 | edges in all blocks |
//! | 28 | 4 | blocks, at least 1 |
//! | 32 | 3 × 4 | offset of x, y, z: signed, Q4.28 |
//! | 44 | 3 × 4 | step of x, y, z: unsigned, in units of 2⁻²⁸ |
//! | 56 | 2 | scale: signed; the model's own coordinate is the stored one · 2^scale |
//! | 58 | 3 | colour of what has none of its own: red, green, blue |
//! | 61 | 3 | 0 |
//!
//! # Block, a multiple of 4 bytes
//!
//! | size | what | there if |
//! | --- | --- | --- |
//! | 2 | number of vertices V, 1…256 | always |
//! | 2 | number of faces F, 0…[`FACES_MAX`] | always |
//! | 2 | number of edges E, 0…[`EDGES_MAX`] | always |
//! | 2 | 0 | always |
//! | V × 6 | positions: x, y, z, 16 bits each; coordinate = offset + number · step, in −8…8 | always |
//! | V × 3 | the vertices' normals: x, y, z, 8 bits each, signed, 127 is 1 | [`Flags::VERTEX_NORMALS`] |
//! | V × 3 | the vertices' colours: red, green, blue, 0…255 | [`Flags::VERTEX_COLOURS`] |
//! | F × 3 | corners: which vertices of this block, from 0, counter-clockwise from outside | always |
//! | F × 3 | the faces' normals, outwards | [`Flags::FACE_NORMALS`] |
//! | F × 3 | the faces' colours | [`Flags::FACE_COLOURS`] |
//! | E × 2 | edges: which vertices of this block; an edge of the mesh is in one block only | always |
//! | 0…3 | 0, up to a multiple of 4 | always |
//!
//! A normal of zeros takes no directional light. Eight bits a part leave a normal's direction within 0.4° and
//! the light on it within 1 %, which is less than a step of the framebuffer's colours; and turning them into
//! numbers costs a shift, where an octahedral normal of two bytes would cost a square root a vertex.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(any(test, feature = "write"))]
extern crate alloc;

mod block;
mod error;
mod header;
mod read;
#[cfg(feature = "write")]
mod write;

pub use block::Block;
pub use error::{Count, FormatError};
pub use header::{Flags, Header};
pub use read::{Blocks, MeshFile};
#[cfg(feature = "write")]
pub use write::{BlockData, write};

/// The first bytes of a file; none of a text, and none that a transfer as text would leave alone.
pub const MAGIC: [u8; 4] = [0x89, b'H', b'S', b'M'];
/// The version that this crate reads and writes.
pub const VERSION: u16 = 1;
/// Length of the header in bytes.
pub const HEADER_BYTES: usize = 64;
/// Most vertices of a block.
pub const VERTICES_MAX: usize = 256;
/// Most faces of a block.
pub const FACES_MAX: usize = 512;
/// Most edges of a block.
pub const EDGES_MAX: usize = 3 * FACES_MAX;
/// What a part of a normal is divided by to give −1…1.
pub const NORMAL_ONE: i8 = 127;

/// The checksum of the header's second word.
const CRC: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);
