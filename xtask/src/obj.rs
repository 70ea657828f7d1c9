//! Reads Wavefront OBJ models: vertices and faces, nothing else.
//!
//! Taken: `v x y z [w] [r g b]` and `f` with `v`, `v/t`, `v//n` or `v/t/n` corners, counted from
//! 1 or, when negative, back from the newest vertex. A backslash at the end of such a line
//! continues it. All other lines (`vt`, `vn`, `o`, `g`, `s`, `usemtl`, `mtllib`, `l`, `p`, curves,
//! comments) are passed over, and so are `w` and the texture and normal numbers.
//!
//! The parser is our own because an error must name the line and the remedy, and because a file
//! of any size must end in a model or a clear error: it reads line by line and keeps only what
//! a model holds. Format: Wavefront's "Object Files (.obj)", appendix B1; vertex colours are the
//! usual extension of it.

mod error;
mod line;
mod reader;

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

pub use error::{ObjError, ObjProblem};
pub use reader::parse_obj;

/// Most vertices a model may have: 384 MiB of positions.
pub const VERTICES_MAX: usize = 16 << 20;
/// Most face corners a model may have: 256 MiB of indices.
pub const CORNERS_MAX: usize = 64 << 20;
/// Longest line, continuations included, in bytes.
pub const LINE_BYTES_MAX: usize = 1 << 20;

/// A model: positions, and faces that name them by index.
///
/// Every index is below `positions.len()`, every face has at least three corners, there is at
/// least one face, and every number is finite. Faces may still be degenerate or not planar.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ObjModel {
    /// x, y, z of each vertex, in the file's units.
    pub positions: Vec<[f64; 3]>,
    /// Red, green, blue of each vertex as the file gives them (0 to 1 by convention), if any
    /// vertex has a colour; a vertex without is white.
    pub colours: Option<Vec<[f32; 3]>>,
    /// Corners of all faces, one face after the other: indices into `positions` from 0.
    pub corners: Vec<u32>,
    /// Where each face starts in `corners`, and after the last face the end: one more than faces.
    pub face_offsets: Vec<u32>,
}

impl ObjModel {
    /// Returns the number of faces.
    pub fn face_count(&self) -> usize {
        self.face_offsets.len().saturating_sub(1)
    }

    /// Returns the number of triangles that [`triangles`](Self::triangles) gives.
    pub fn triangle_count(&self) -> usize {
        self.corners.len() - 2 * self.face_count()
    }

    /// Returns each face as the indices of its corners, in the file's order.
    pub fn faces(&self) -> impl Iterator<Item = &[u32]> {
        self.face_offsets.windows(2).map(|ends| &self.corners[ends[0] as usize..ends[1] as usize])
    }

    /// Returns each face as a fan of triangles around its first corner.
    ///
    /// Right for convex faces; a concave one overlaps itself.
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> {
        self.faces().flat_map(|face| face[1..].windows(2).map(move |pair| [face[0], pair[0], pair[1]]))
    }
}

/// Reads the model in the file at `path`.
///
/// # Errors
///
/// An [`ObjError`] that names the file, the line, the value and the remedy.
pub fn read_obj(path: &Path) -> Result<ObjModel, ObjError> {
    let unreadable =
        |cause| ObjError { file: path.to_path_buf(), line: None, problem: ObjProblem::Unreadable { cause } };
    let file = File::open(path).map_err(unreadable)?;
    parse_obj(BufReader::with_capacity(1 << 16, file), path)
}

#[cfg(test)]
mod tests;
