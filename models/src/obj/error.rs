//! What only an OBJ file can have wrong.

use std::fmt;

use super::LINE_BYTES_MAX;

/// What is wrong with an OBJ file or its materials.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum ObjProblem {
    /// A NUL byte, or a statement that is not UTF-8.
    Binary,
    /// A line longer than [`LINE_BYTES_MAX`].
    LineTooLong,
    /// A vertex or normal with fewer than three numbers.
    MissingCoordinate {
        /// The statement: `v` or `vn`.
        of: &'static str,
        /// Numbers that are there.
        count: usize,
    },
    /// A vertex with a count of numbers that no form has.
    UnknownVertexForm {
        /// Numbers that are there.
        count: usize,
    },
    /// A corner that is no index.
    NotAnIndex {
        /// The text in its place.
        text: String,
    },
    /// An index of 0.
    IndexZero,
    /// An index that names nothing.
    IndexOutOfRange {
        /// What it should name: `vertices` or `normals`.
        of: &'static str,
        /// The index as written.
        index: i64,
        /// What it could name: all for a positive index, those so far for a negative one.
        count: usize,
    },
    /// A face with fewer than three corners.
    TooFewCorners {
        /// Corners that are there.
        count: usize,
    },
    /// A line with fewer than two ends.
    TooFewEnds {
        /// Ends that are there.
        count: usize,
    },
    /// A face that is no convex polygon.
    NotConvex {
        /// Its corners.
        corners: usize,
        /// The corner from 1 at which it turns back.
        corner: usize,
    },
    /// A face that is folded.
    NotFlat {
        /// Its corners.
        corners: usize,
        /// The corner from 1 that is too far off.
        corner: usize,
    },
    /// `Kd` before any `newmtl`.
    NoMaterial,
    /// `Kd` with another count of numbers.
    NotAColour {
        /// Numbers that are there.
        count: usize,
    },
}

impl fmt::Display for ObjProblem {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Binary => {
                out.write_str("is not text: give a Wavefront OBJ file (a binary format must be exported as OBJ first)")
            }
            Self::LineTooLong => {
                write!(out, "line longer than {LINE_BYTES_MAX} bytes: split the face into smaller ones")
            }
            Self::MissingCoordinate { of: "vn", count } => {
                write!(out, "normal with {count} of 3 parts: write `vn x y z`")
            }
            Self::MissingCoordinate { count, .. } => {
                write!(out, "vertex with {count} of 3 coordinates: write `v x y z`")
            }
            Self::UnknownVertexForm { count } => {
                write!(
                    out,
                    "vertex with {count} numbers: write `v x y z`, `v x y z w`, `v x y z r g b` or `v x y z w r g b`"
                )
            }
            Self::NotAnIndex { text } => {
                write!(out, "`{text}` is no face corner: write v, v/t, v//n or v/t/n with whole numbers")
            }
            Self::IndexZero => out.write_str("face index 0: vertices count from 1, or from -1 backwards"),
            Self::IndexOutOfRange { of, index, count } if *index < 0 => {
                write!(
                    out,
                    "face index {index} reaches before the first of the {count} {of} so far: use -{count} to -1"
                )
            }
            Self::IndexOutOfRange { of, index, count } => {
                write!(
                    out,
                    "face index {index} is past the last of {count} {of}: add what is missing or correct the index"
                )
            }
            Self::TooFewCorners { count } => {
                write!(out, "face with {count} corners: a face needs 3 or more; delete it or use `l` for a line")
            }
            Self::TooFewEnds { count } => write!(out, "line with {count} ends: a line needs 2 or more; delete it"),
            Self::NotConvex { corners, corner } => write!(
                out,
                "face of {corners} corners turns back at corner {corner} and is not convex: export the model as triangles"
            ),
            Self::NotFlat { corners, corner } => write!(
                out,
                "face of {corners} corners is folded, corner {corner} is far off its plane: export the model as triangles"
            ),
            Self::NoMaterial => out.write_str("`Kd` before any material: write `newmtl NAME` first"),
            Self::NotAColour { count } => write!(out, "`Kd` with {count} of 3 numbers: write `Kd r g b`"),
        }
    }
}
