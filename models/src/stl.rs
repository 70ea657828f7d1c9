//! Reads STL models: triangles, as text or binary.
//!
//! A binary file has 80 bytes of anything, a count, and 50 bytes a triangle; it is taken for one when its
//! length says so, since many start with `solid` as texts do. Corners at the same place become one vertex.
//! A facet's stated normal is passed over, for its corners give it, and so are a binary facet's two
//! attribute bytes, which every program uses in another way.
//!
//! The parser is our own for the errors' sake: the crate `stl_io` names neither line nor offset nor value.
//! Format: 3D Systems, "Stereolithography Interface Specification", 1989.

mod ascii;
mod binary;

use std::collections::HashMap;
use std::fmt;
use std::path::Path;

use crate::error::quoted;
use crate::{Model, Problem, ReadError};

/// What only an STL file can have wrong.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum StlProblem {
    /// Neither starts with `solid` nor has the length of a binary file.
    Length {
        /// Triangles that the file states, if it is long enough to state any.
        triangles: Option<u32>,
        /// Its bytes.
        bytes: usize,
    },
    /// A text that is not UTF-8 or holds a NUL byte.
    Binary,
    /// Another word than must follow.
    Unexpected {
        /// The word, or nothing at the end of the file.
        found: Option<String>,
        /// What must follow.
        expected: &'static str,
    },
}

impl fmt::Display for StlProblem {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length { triangles: None, bytes } => {
                write!(out, "{bytes} bytes are no STL file: it starts with `solid` or has 84 bytes or more")
            }
            Self::Length { triangles: Some(triangles), bytes } => write!(
                out,
                "{bytes} bytes where {triangles} triangles want {}: copy or export the file again",
                84 + 50 * u64::from(*triangles)
            ),
            Self::Binary => {
                out.write_str("is not text, and its length is not that of a binary STL file: export it again")
            }
            Self::Unexpected { found: Some(found), expected } => {
                write!(out, "`{found}` where `{expected}` must follow: export the model again")
            }
            Self::Unexpected { found: None, expected } => {
                write!(out, "the file ends where `{expected}` must follow: copy or export it again")
            }
        }
    }
}

/// Reads a model from a file's bytes; `file` is its name in errors.
///
/// # Errors
///
/// The first thing that is wrong, with its line or byte.
pub fn parse(bytes: &[u8], file: &Path) -> Result<Model, ReadError> {
    let stated = bytes.get(80..84).and_then(|count| count.try_into().ok()).map(u32::from_le_bytes);
    let is_binary = stated.is_some_and(|count| bytes.len() as u64 == 84 + 50 * u64::from(count));
    if is_binary {
        binary::parse(&bytes[84..], file)
    } else if bytes.trim_ascii_start().get(..5).is_some_and(|start| start.eq_ignore_ascii_case(b"solid")) {
        ascii::parse(bytes, file)
    } else {
        Err(ReadError::file(file, StlProblem::Length { triangles: stated, bytes: bytes.len() }))
    }
}

/// A model in the making, whose corners at one place are one vertex.
struct Builder {
    model: Model,
    vertices: HashMap<[u64; 3], u32>,
}

impl Builder {
    fn new() -> Self {
        Self { model: Model::empty(), vertices: HashMap::new() }
    }

    fn triangle(&mut self, corners: [[f64; 3]; 3]) -> Result<(), Problem> {
        let mut indices = [0; 3];
        for (index, position) in indices.iter_mut().zip(corners) {
            // Both zeros are one.
            let key = position.map(|part| (part + 0.0).to_bits());
            *index = match self.vertices.get(&key) {
                Some(index) => *index,
                None => {
                    let index = self.model.positions.len() as u32;
                    self.model.push_vertex(position)?;
                    self.vertices.insert(key, index);
                    index
                }
            };
        }
        self.model.push_triangle(indices)
    }

    fn finish(self) -> Result<Model, Problem> {
        self.model.finish()
    }
}

fn unexpected(found: Option<&str>, expected: &'static str) -> Problem {
    StlProblem::Unexpected { found: found.map(quoted), expected }.into()
}
