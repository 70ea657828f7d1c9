//! Tells model files apart.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use crate::{Model, Problem, ReadError, babylon, gltf, mesh_file, obj, rom, stl};

/// Largest file that is read whole. OBJ files, which are read line by line, may be larger.
pub(crate) const FILE_BYTES_MAX: u64 = 2 << 30;

/// A kind of model file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Wavefront OBJ.
    Obj,
    /// STL, text or binary.
    Stl,
    /// Babylon JSON.
    Babylon,
    /// glTF 2.0, binary.
    Gltf,
    /// 99-bit lines.
    Rom,
    /// This project's own.
    Mesh,
}

impl Kind {
    /// Returns the kind that a file's name tells.
    pub fn of_name(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "obj" => Some(Self::Obj),
            "stl" => Some(Self::Stl),
            "babylon" | "json" => Some(Self::Babylon),
            "glb" | "gltf" => Some(Self::Gltf),
            "rom" | "mem" | "coe" => Some(Self::Rom),
            "mesh" => Some(Self::Mesh),
            _ => None,
        }
    }
}

/// Reads the model in the file at `path`, of the kind that its name tells.
///
/// # Errors
///
/// A [`ReadError`] that names the file, the place, the value and the remedy.
pub fn read(path: &Path) -> Result<Model, ReadError> {
    let kind = Kind::of_name(path).ok_or_else(|| ReadError::file(path, Problem::UnknownKind))?;
    if kind == Kind::Obj {
        return obj::read_obj(path);
    }
    let bytes = read_whole(path)?;
    match kind {
        Kind::Obj | Kind::Stl => stl::parse(&bytes, path),
        Kind::Babylon => babylon::parse(&bytes, path),
        Kind::Gltf => gltf::parse(&bytes, path),
        Kind::Rom => rom::parse(&bytes, path),
        Kind::Mesh => mesh_file::parse(&bytes, path),
    }
}

/// Reads a file of bounded size.
fn read_whole(path: &Path) -> Result<Vec<u8>, ReadError> {
    let read = || -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        File::open(path)?.take(FILE_BYTES_MAX + 1).read_to_end(&mut bytes)?;
        Ok(bytes)
    };
    let bytes = read().map_err(|cause| ReadError::file(path, Problem::Unreadable { cause }))?;
    if bytes.len() as u64 > FILE_BYTES_MAX {
        return Err(ReadError::file(path, Problem::TooLarge));
    }
    Ok(bytes)
}
