//! What every reader gives.

use crate::Problem;

/// Most vertices a model may have: 384 MiB of positions.
pub const VERTICES_MAX: usize = 16 << 20;
/// Most face corners, and most line ends, a model may have: 256 MiB of indices.
pub const CORNERS_MAX: usize = 64 << 20;
/// The colour of a face that has none.
pub const PLAIN: [f32; 3] = [200.0 / 255.0; 3];
/// In [`Model::corner_normals`]: this corner has none.
pub const NO_NORMAL: u32 = u32::MAX;

/// A model: positions, and faces and lines that name them by index.
///
/// Every index is below the length of what it names, every face has at least three corners, there is at least one
/// face or line, and every number is finite. Faces of more than three corners are convex and nearly
/// flat. Any face may be degenerate.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// x, y, z of each vertex, in the file's units; right-handed, y up.
    pub positions: Vec<[f64; 3]>,
    /// Red, green, blue of each vertex, 0 to 1, if the file gives any; before a face's.
    pub colours: Option<Vec<[f32; 3]>>,
    /// Normals that corners name; of any length but 0.
    pub normals: Vec<[f32; 3]>,
    /// Corners of all faces, one face after the other: indices into `positions` from 0.
    pub corners: Vec<u32>,
    /// The normal of each corner or [`NO_NORMAL`]; empty where no corner has one.
    pub corner_normals: Vec<u32>,
    /// Where each face starts in `corners`, and after the last face the end: one more than faces.
    pub face_offsets: Vec<u32>,
    /// Red, green, blue of each face, 0 to 1, if the file gives any.
    pub face_colours: Option<Vec<[f32; 3]>>,
    /// What a wire drawing shows; where there is none, the faces' outlines.
    pub lines: Vec<[u32; 2]>,
    /// How a file of lines wants to be seen.
    pub view: Option<View>,
    /// What a person should know that was left out or made up.
    pub notes: Vec<String>,
}

/// Seed C's view: an eye, a plane across z, and a window in that plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Where the eye is.
    pub eye: [f64; 3],
    /// z of the viewing plane; what lies between it and the eye is not seen.
    pub plane: f64,
    /// Lowest x and y, highest x and y of what is seen of the plane.
    pub window: [[f64; 2]; 2],
}

impl Model {
    /// Returns a model without anything, for a reader to fill.
    pub(crate) fn empty() -> Self {
        Self { face_offsets: vec![0], ..Self::default() }
    }

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
        self.face_ranges().map(|range| &self.corners[range])
    }

    /// Returns where in [`corners`](Self::corners) each face is.
    pub fn face_ranges(&self) -> impl Iterator<Item = std::ops::Range<usize>> + use<'_> {
        self.face_offsets.windows(2).map(|ends| ends[0] as usize..ends[1] as usize)
    }

    /// Returns each face as a fan of triangles around its first corner.
    pub fn triangles(&self) -> impl Iterator<Item = [u32; 3]> {
        self.faces().flat_map(|face| face[1..].windows(2).map(move |pair| [face[0], pair[0], pair[1]]))
    }

    /// Returns the outlines of all faces: an edge that two faces share comes twice.
    pub fn outlines(&self) -> impl Iterator<Item = [u32; 2]> {
        self.faces().flat_map(|face| (0..face.len()).map(|at| [face[at], face[(at + 1) % face.len()]]))
    }

    /// Returns a face's colour: its corners' mean, or its own, or [`PLAIN`].
    pub fn face_colour(&self, face: usize, corners: &[u32]) -> [f32; 3] {
        match (&self.colours, &self.face_colours) {
            (Some(colours), _) => [0, 1, 2].map(|channel| {
                let sum: f32 = corners.iter().map(|corner| colours[*corner as usize][channel]).sum();
                sum / corners.len() as f32
            }),
            (None, Some(colours)) => colours[face],
            (None, None) => PLAIN,
        }
    }

    /// Returns the vertices' colours, after giving those before `first` their faces' if they had none.
    pub(crate) fn colours_so_far(&mut self, first: usize) -> &mut Vec<[f32; 3]> {
        if self.colours.is_none() {
            let mut colours = vec![PLAIN; first];
            if let Some(face_colours) = &self.face_colours {
                for (range, colour) in self.face_ranges().zip(face_colours) {
                    self.corners[range].iter().for_each(|corner| colours[*corner as usize] = *colour);
                }
            }
            self.colours = Some(colours);
        }
        self.colours.get_or_insert_default()
    }

    /// Adds a vertex.
    pub(crate) fn push_vertex(&mut self, position: [f64; 3]) -> Result<(), Problem> {
        if self.positions.len() >= VERTICES_MAX {
            return Err(Problem::TooManyVertices);
        }
        self.positions.push(position);
        Ok(())
    }

    /// Adds a triangle.
    pub(crate) fn push_triangle(&mut self, corners: [u32; 3]) -> Result<(), Problem> {
        self.corners.extend(corners);
        self.end_face()
    }

    /// Makes a face of the corners that were added since the last one.
    pub(crate) fn end_face(&mut self) -> Result<(), Problem> {
        if self.corners.len() > CORNERS_MAX {
            return Err(Problem::TooManyCorners);
        }
        self.face_offsets.push(self.corners.len() as u32);
        Ok(())
    }

    /// Adds a line.
    pub(crate) fn push_line(&mut self, ends: [u32; 2]) -> Result<(), Problem> {
        if self.lines.len() >= CORNERS_MAX / 2 {
            return Err(Problem::TooManyCorners);
        }
        self.lines.push(ends);
        Ok(())
    }

    /// Adds the faces' outlines to the lines of a model that has both, so that a wire drawing shows all.
    pub(crate) fn outline_beside_lines(&mut self) {
        if !self.lines.is_empty() && !self.corners.is_empty() {
            let outlines: Vec<[u32; 2]> = self.outlines().collect();
            self.lines.extend(outlines);
        }
    }

    /// Returns the model if it has anything to draw.
    pub(crate) fn finish(self) -> Result<Self, Problem> {
        if self.corners.is_empty() && self.lines.is_empty() {
            return Err(Problem::NothingToDraw { vertices: self.positions.len() });
        }
        Ok(self)
    }
}

/// Returns the unit vector of a direction; zeros for one without length.
pub(crate) fn direction(vector: [f64; 3]) -> [f32; 3] {
    let largest = vector.iter().fold(0.0f64, |largest, part| largest.max(part.abs()));
    // Of a unit, so that squares neither overflow nor vanish.
    let vector = vector.map(|part| if largest > 0.0 { part / largest } else { 0.0 });
    let length = vector.iter().map(|part| part * part).sum::<f64>().sqrt();
    vector.map(|part| if length > 0.0 { (part / length) as f32 } else { 0.0 })
}

/// Returns a colour in 0 to 1; what a file has beyond is as bright, or as dark, as can be.
pub(crate) fn colour(parts: [f64; 3]) -> [f32; 3] {
    parts.map(|part| part.clamp(0.0, 1.0) as f32)
}
