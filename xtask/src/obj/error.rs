//! What can be wrong with an OBJ file, each with its remedy.

use std::fmt;
use std::io;
use std::path::PathBuf;

use super::{CORNERS_MAX, LINE_BYTES_MAX, VERTICES_MAX};

/// An OBJ file that is no model, and where.
#[derive(Debug)]
pub struct ObjError {
    /// The file as it was named by the caller.
    pub file: PathBuf,
    /// Line from 1 where the statement starts; `None` when the whole file is meant.
    pub line: Option<u64>,
    /// What is wrong.
    pub problem: ObjProblem,
}

/// What is wrong with an OBJ file. Texts from the file are shortened and free of control characters.
#[derive(Debug)]
#[non_exhaustive]
pub enum ObjProblem {
    /// The file cannot be opened or read.
    Unreadable {
        /// The operating system's reason.
        cause: io::Error,
    },
    /// A NUL byte, or a statement that is not UTF-8.
    Binary,
    /// A line longer than [`LINE_BYTES_MAX`].
    LineTooLong,
    /// A vertex with fewer than three numbers.
    MissingCoordinate {
        /// Numbers that are there.
        count: usize,
    },
    /// A vertex with a count of numbers that no form has.
    UnknownVertexForm {
        /// Numbers that are there.
        count: usize,
    },
    /// A coordinate or colour that is no number.
    NotANumber {
        /// The text in its place.
        text: String,
    },
    /// A coordinate or colour that is NaN, infinite, or too large for 64-bit floating point.
    NotFinite {
        /// The text of the number.
        text: String,
    },
    /// A face corner that is no index.
    NotAnIndex {
        /// The text in its place.
        text: String,
    },
    /// A face index of 0.
    IndexZero,
    /// A face index that names no vertex.
    IndexOutOfRange {
        /// The index as written.
        index: i64,
        /// Vertices it could name: all for a positive index, those so far for a negative one.
        vertices: usize,
    },
    /// A face with fewer than three corners.
    TooFewCorners {
        /// Corners that are there.
        count: usize,
    },
    /// More than [`VERTICES_MAX`] vertices.
    TooManyVertices,
    /// More than [`CORNERS_MAX`] face corners.
    TooManyCorners,
    /// No face in the whole file.
    NoFaces {
        /// Vertices that were found.
        vertices: usize,
    },
}

impl fmt::Display for ObjError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}", self.file.display())?;
        if let Some(line) = self.line {
            write!(formatter, ":{line}")?;
        }
        write!(formatter, ": {}", self.problem)
    }
}

impl fmt::Display for ObjProblem {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable { cause } => {
                write!(formatter, "cannot be read ({cause}): check the path and its permissions")
            }
            Self::Binary => formatter
                .write_str("is not text: give a Wavefront OBJ file (a binary format must be exported as OBJ first)"),
            Self::LineTooLong => {
                write!(formatter, "line longer than {LINE_BYTES_MAX} bytes: split the face into smaller ones")
            }
            Self::MissingCoordinate { count } => {
                write!(formatter, "vertex with {count} of 3 coordinates: write `v x y z`")
            }
            Self::UnknownVertexForm { count } => {
                write!(
                    formatter,
                    "vertex with {count} numbers: write `v x y z`, `v x y z w`, `v x y z r g b` or `v x y z w r g b`"
                )
            }
            Self::NotANumber { text } => {
                write!(formatter, "`{text}` is no number: write it like -1.5 or 2e-3, with a point, not a comma")
            }
            Self::NotFinite { text } => {
                write!(formatter, "`{text}` is no finite number: export the model again or delete the vertex")
            }
            Self::NotAnIndex { text } => {
                write!(formatter, "`{text}` is no face corner: write v, v/t, v//n or v/t/n with whole numbers")
            }
            Self::IndexZero => formatter.write_str("face index 0: vertices count from 1, or from -1 backwards"),
            Self::IndexOutOfRange { index, vertices } if *index < 0 => {
                write!(
                    formatter,
                    "face index {index} reaches before the first of the {vertices} vertices so far: use -{vertices} to -1"
                )
            }
            Self::IndexOutOfRange { index, vertices } => {
                write!(
                    formatter,
                    "face index {index} is past the last of {vertices} vertices: add the vertex or correct the index"
                )
            }
            Self::TooFewCorners { count } => {
                write!(formatter, "face with {count} corners: a face needs 3 or more; delete it or use `l` for a line")
            }
            Self::TooManyVertices => write!(formatter, "more than {VERTICES_MAX} vertices: simplify the model first"),
            Self::TooManyCorners => write!(formatter, "more than {CORNERS_MAX} face corners: simplify the model first"),
            Self::NoFaces { vertices } => {
                write!(
                    formatter,
                    "no face (`f` line) among {vertices} vertices: export the model as polygons in Wavefront OBJ form"
                )
            }
        }
    }
}

impl std::error::Error for ObjError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &self.problem {
            ObjProblem::Unreadable { cause } => Some(cause),
            _ => None,
        }
    }
}

/// Returns `text` fit for an error message: at most 40 characters, control characters escaped.
pub(super) fn quoted(text: &str) -> String {
    const CHARACTERS: usize = 40;
    let mut quoted: String = text.chars().take(CHARACTERS).flat_map(char::escape_debug).collect();
    if text.chars().nth(CHARACTERS).is_some() {
        quoted.push('…');
    }
    quoted
}
