//! The program on the card.

use std::path::Path;
use std::{fs, io};

use object::elf;
use object::read::elf::{FileHeader, ProgramHeader};

/// Where U-Boot's script loads the image, and jumps to.
pub const LOAD_ADDRESS: u32 = 0x0100_0000;

/// Bytes at their addresses.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    pub(crate) parts: Vec<(u32, Vec<u8>)>,
}

/// Why a file is no image.
#[derive(Debug)]
#[non_exhaustive]
pub enum ImageError {
    /// It cannot be read.
    Io(io::Error),
    /// It is no 32-bit ELF file, or a damaged one.
    NoElf(object::read::Error),
    /// Its entry is elsewhere than U-Boot jumps to.
    Entry(u32),
}

impl std::fmt::Display for ImageError {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Io(error) => error.fmt(out),
            Self::NoElf(error) => write!(out, "no 32-bit ELF file: {error}"),
            Self::Entry(entry) => {
                write!(out, "its entry is {entry:#010x}; U-Boot jumps to {LOAD_ADDRESS:#010x}: check memory.x")
            }
        }
    }
}

impl std::error::Error for ImageError {}

impl Image {
    /// Returns a raw binary as an image.
    pub fn from_binary(bytes: Vec<u8>) -> Self {
        Self { parts: vec![(LOAD_ADDRESS, bytes)] }
    }

    /// Reads an ELF file's loadable segments, at their physical addresses: what a raw binary made
    /// of it holds, too.
    ///
    /// # Errors
    /// [`ImageError`].
    pub fn from_elf(bytes: &[u8]) -> Result<Self, ImageError> {
        let header = elf::FileHeader32::<object::LittleEndian>::parse(bytes).map_err(ImageError::NoElf)?;
        let endian = header.endian().map_err(ImageError::NoElf)?;
        let entry = header.e_entry(endian);
        if entry != LOAD_ADDRESS {
            return Err(ImageError::Entry(entry));
        }
        let mut parts = Vec::new();
        for segment in header.program_headers(endian, bytes).map_err(ImageError::NoElf)? {
            if segment.p_type(endian) != elf::PT_LOAD || segment.p_filesz(endian) == 0 {
                continue;
            }
            let data = segment.data(endian, bytes).map_err(|()| {
                // The library says no more; this asks it for the words.
                ImageError::Io(io::Error::new(io::ErrorKind::UnexpectedEof, "a segment ends behind the file"))
            })?;
            parts.push((segment.p_paddr(endian), data.to_vec()));
        }
        Ok(Self { parts })
    }

    /// Reads a file: ELF, or a raw binary.
    ///
    /// # Errors
    /// [`ImageError`].
    pub fn read(path: &Path) -> Result<Self, ImageError> {
        let bytes = fs::read(path).map_err(ImageError::Io)?;
        if bytes.starts_with(&elf::ELFMAG) { Self::from_elf(&bytes) } else { Ok(Self::from_binary(bytes)) }
    }
}
