//! What can be wrong with a model file, each with its remedy.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use mesh_format::FormatError;

use crate::babylon::BabylonProblem;
use crate::gltf::GltfProblem;
use crate::kind::FILE_BYTES_MAX;
use crate::obj::ObjProblem;
use crate::rom::RomProblem;
use crate::stl::StlProblem;
use crate::{CORNERS_MAX, VERTICES_MAX};

/// A file that is no model, and where.
#[derive(Debug)]
pub struct ReadError {
    /// The file as it was named by the caller.
    pub file: PathBuf,
    /// Where in it.
    pub place: Place,
    /// What is wrong.
    pub problem: Problem,
}

/// A place in a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Place {
    /// The whole of it.
    File,
    /// A line from 1, where the statement starts.
    Line(u64),
    /// A byte from 0.
    Byte(u64),
    /// A part that has a name.
    Part(String),
}

/// What is wrong with a file. Texts from it are shortened and free of control characters.
#[derive(Debug)]
#[non_exhaustive]
pub enum Problem {
    /// The file cannot be opened or read.
    Unreadable {
        /// The operating system's reason.
        cause: io::Error,
    },
    /// Larger than any model.
    TooLarge,
    /// The file is of no kind that is read.
    UnknownKind,
    /// A number that is none.
    NotANumber {
        /// The text in its place.
        text: String,
    },
    /// A number that is NaN, infinite, or too large for 64-bit floating point.
    NotFinite {
        /// The text of the number.
        text: String,
    },
    /// More than [`VERTICES_MAX`] vertices.
    TooManyVertices,
    /// More than [`CORNERS_MAX`] face corners or line ends.
    TooManyCorners,
    /// No face and no line in the whole file.
    NothingToDraw {
        /// Vertices that were found.
        vertices: usize,
    },
    /// Wrong in an OBJ file alone.
    Obj(ObjProblem),
    /// Wrong in an STL file alone.
    Stl(StlProblem),
    /// Wrong in a Babylon file alone.
    Babylon(BabylonProblem),
    /// Wrong in a glTF file alone.
    Gltf(GltfProblem),
    /// Wrong in a 99-bit ROM alone.
    Rom(RomProblem),
    /// Wrong in a `.mesh` file alone.
    Mesh(FormatError),
}

impl ReadError {
    /// Returns the error about a file as a whole.
    pub(crate) fn file(file: &Path, problem: impl Into<Problem>) -> Self {
        Self { file: file.to_path_buf(), place: Place::File, problem: problem.into() }
    }

    /// Returns the error at a line.
    pub(crate) fn line(file: &Path, line: u64, problem: impl Into<Problem>) -> Self {
        Self { file: file.to_path_buf(), place: Place::Line(line), problem: problem.into() }
    }

    /// Returns the error at a byte.
    pub(crate) fn byte(file: &Path, byte: u64, problem: impl Into<Problem>) -> Self {
        Self { file: file.to_path_buf(), place: Place::Byte(byte), problem: problem.into() }
    }

    /// Returns the error in a named part.
    pub(crate) fn part(file: &Path, part: String, problem: impl Into<Problem>) -> Self {
        Self { file: file.to_path_buf(), place: Place::Part(part), problem: problem.into() }
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}", self.file.display())?;
        match &self.place {
            Place::File => {}
            Place::Line(line) => write!(out, ":{line}")?,
            Place::Byte(byte) => write!(out, ": byte {byte}")?,
            Place::Part(part) => write!(out, ": {part}")?,
        }
        write!(out, ": {}", self.problem)
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable { cause } => {
                write!(out, "cannot be read ({cause}): check the path and its permissions")
            }
            Self::TooLarge => {
                write!(out, "larger than {} MiB: simplify the model first", FILE_BYTES_MAX >> 20)
            }
            Self::UnknownKind => out.write_str(
                "of no kind that is read: give .obj, .stl, .babylon, .glb, .rom (99-bit lines) or .mesh, or export the model as one of these",
            ),
            Self::NotANumber { text } => {
                write!(out, "`{text}` is no number: write it like -1.5 or 2e-3, with a point, not a comma")
            }
            Self::NotFinite { text } => {
                write!(out, "`{text}` is no finite number: export the model again or delete the vertex")
            }
            Self::TooManyVertices => write!(out, "more than {VERTICES_MAX} vertices: simplify the model first"),
            Self::TooManyCorners => write!(out, "more than {CORNERS_MAX} face corners: simplify the model first"),
            Self::NothingToDraw { vertices } => {
                write!(out, "no face and no line among {vertices} vertices: export the model as polygons")
            }
            Self::Obj(problem) => problem.fmt(out),
            Self::Stl(problem) => problem.fmt(out),
            Self::Babylon(problem) => problem.fmt(out),
            Self::Gltf(problem) => problem.fmt(out),
            Self::Rom(problem) => problem.fmt(out),
            Self::Mesh(problem) => problem.fmt(out),
        }
    }
}

impl std::error::Error for ReadError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &self.problem {
            Problem::Unreadable { cause } => Some(cause),
            _ => None,
        }
    }
}

macro_rules! from {
    ($($problem:ident => $variant:ident),*) => {$(
        impl From<$problem> for Problem {
            fn from(problem: $problem) -> Self {
                Self::$variant(problem)
            }
        }
    )*};
}
from!(ObjProblem => Obj, StlProblem => Stl, BabylonProblem => Babylon, GltfProblem => Gltf, RomProblem => Rom, FormatError => Mesh);

/// Returns `text` fit for an error message: at most 40 characters, control characters escaped.
pub(crate) fn quoted(text: &str) -> String {
    const CHARACTERS: usize = 40;
    let mut quoted: String = text.chars().take(CHARACTERS).flat_map(char::escape_debug).collect();
    if text.chars().nth(CHARACTERS).is_some() {
        quoted.push('…');
    }
    quoted
}
