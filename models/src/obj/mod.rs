//! Reads Wavefront OBJ models.
//!
//! Taken: `v x y z [w] [r g b]`, `vn x y z`, `f` with `v`, `v/t`, `v//n` or `v/t/n` corners and `l`
//! with `v` or `v/t`, counted from 1 or, when negative, back from the newest; `mtllib`, of one name or several,
//! and `usemtl`, of whose materials the diffuse colour `Kd` counts. A backslash at the end of such a line
//! continues it. All other lines (`vt`, `o`, `g`, `s`, `p`, curves, comments) are passed over, and so
//! are `w` and the texture numbers.
//!
//! The parser is our own because an error must name the line and the remedy, and because a file
//! of any size must end in a model or a clear error: it reads line by line and keeps only what
//! a model holds. (The crate `tobj` names neither line nor value.) Format: Wavefront's "Object Files
//! (.obj)", appendix B1; vertex colours are the usual extension of it.

mod error;
mod line;
mod material;
mod reader;

use std::fs::File;
use std::io::{self, BufReader};
use std::path::Path;

pub use error::ObjProblem;
pub use material::{Materials, parse as parse_materials};
pub use reader::parse_obj;

use crate::{Model, Problem, ReadError};

/// Longest line, continuations included, in bytes.
pub const LINE_BYTES_MAX: usize = 1 << 20;

/// Reads the model in the file at `path`, with the materials in the files beside it that it names.
///
/// A file of materials that is not there is noted in the model; the faces are then plain.
///
/// # Errors
///
/// A [`ReadError`] that names the file, the line, the value and the remedy.
pub fn read_obj(path: &Path) -> Result<Model, ReadError> {
    let open = |path: &Path| File::open(path).map(|file| BufReader::with_capacity(1 << 16, file));
    let source = open(path).map_err(|cause| ReadError::file(path, Problem::Unreadable { cause }))?;
    parse_obj(source, path, |name| {
        let library = path.with_file_name(name);
        match open(&library) {
            Ok(source) => material::parse(source, &library).map(Some),
            // Several names may be too long for one.
            Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::InvalidFilename) => Ok(None),
            Err(cause) => Err(ReadError::file(&library, Problem::Unreadable { cause })),
        }
    })
}

#[cfg(test)]
mod tests;
