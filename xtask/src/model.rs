//! A model from a file as a mesh that `geometry` draws.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow, bail};
use fixed::types::I4F28;
use geometry::mesh::{Face, Mesh, Position, Winding};
use models::Kind;
use models::compile::{Options, compile};

/// Half the range that a model is scaled into: coordinates of −4…4 of the −8…8 there is.
const LARGEST_LOG2: i32 = 2;

/// A mesh on the heap, and how it was scaled.
#[derive(Debug, Clone)]
pub struct Model {
    positions: Vec<Position>,
    faces: Vec<Face>,
    /// The model's own lines or, without any, its polygons' outlines, each once.
    edges: Vec<[u32; 2]>,
    /// What a stored coordinate is multiplied by to give the file's: 2 to this.
    pub scale_log2: i32,
}

/// Reads a model's file.
///
/// # Errors
/// When it cannot be read or is malformed. The text names the cause already, which a chain of errors would say again.
pub fn read(path: &Path) -> anyhow::Result<models::Model> {
    models::read(path).map_err(|error| anyhow!("{error}"))
}

/// Returns a model as a `.mesh` file: itself where it is one, else `model.mesh` in `folder`.
///
/// # Errors
/// When it cannot be read, is malformed or too large, or the file cannot be written.
pub fn mesh_file(path: &Path, folder: &Path) -> anyhow::Result<PathBuf> {
    let model = read(path)?;
    if Kind::of_name(path) == Some(Kind::Mesh) {
        return Ok(path.into());
    }
    model.notes.iter().for_each(|note| println!("note: {note}"));
    let compiled = compile(&model, &Options::default()).with_context(|| format!("cannot use {}", path.display()))?;
    let file = folder.join("model.mesh");
    fs::create_dir_all(folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
    fs::write(&file, compiled.bytes).with_context(|| format!("cannot write {}", file.display()))?;
    Ok(file)
}

impl Model {
    /// Scales a model by a power of two, so that it uses the positions' range, and works out
    /// its faces' normals and colours. Polygons become fans.
    ///
    /// # Errors
    /// When the coordinates are so large or so small that no power of two of `f64` brings them
    /// into range.
    pub fn new(source: &models::Model) -> anyhow::Result<Self> {
        let largest = source.positions.as_flattened().iter().fold(0.0f64, |largest, part| largest.max(part.abs()));
        if largest > 1e100 || (largest > 0.0 && largest < 1e-100) {
            bail!("the model's largest coordinate is {largest:e}: scale the model to a size between 1e-100 and 1e100");
        }
        let scale_log2 = if largest > 0.0 { largest.log2().floor() as i32 + 1 - LARGEST_LOG2 } else { 0 };
        let scale = 2.0f64.powi(-scale_log2);
        let scaled = |position: &[f64; 3]| position.map(|part| part * scale);
        let positions =
            source.positions.iter().map(|position| position_bits(scaled(position)).map(I4F28::from_bits)).collect();
        let mut faces = Vec::with_capacity(source.triangle_count());
        for (index, corners) in source.faces().enumerate() {
            let colour = source.face_colour(index, corners).map(|part| (part * 255.0).round() as u8);
            faces.extend(corners[1..].windows(2).map(|pair| {
                let corners = [corners[0], pair[0], pair[1]];
                let normal = face_normal(corners.map(|corner| source.positions[corner as usize]));
                Face { corners, normal, colour }
            }));
        }
        let in_order = |[from, to]: [u32; 2]| [from.min(to), from.max(to)];
        let mut edges: Vec<[u32; 2]> = source.lines.iter().copied().map(in_order).collect();
        if edges.is_empty() {
            edges = source.outlines().map(in_order).collect();
        }
        edges.sort_unstable();
        edges.dedup();
        Ok(Self { positions, faces, edges, scale_log2 })
    }

    /// Returns the model as a mesh, counter-clockwise as OBJ has it.
    ///
    /// # Errors
    /// When a face names a missing corner, which the reader of the file has ruled out.
    pub fn mesh(&self) -> anyhow::Result<Mesh<'_>> {
        Mesh::new(&self.positions, &self.faces, Winding::CounterClockwise).context("the model is malformed")
    }

    /// Returns the model's lines, or its polygons' edges, each once.
    pub fn edges(&self) -> &[[u32; 2]] {
        &self.edges
    }

    /// Returns whether there is nothing but lines.
    pub fn is_wire(&self) -> bool {
        self.faces.is_empty()
    }
}

/// Returns a position in units of 2⁻²⁸, rounded to the nearest and saturated.
pub fn position_bits(position: [f64; 3]) -> [i32; 3] {
    position.map(|part| (part * f64::from(1 << 28)).round() as i32)
}

/// Returns the unit normal of a counter-clockwise triangle, Q2.14; zero for a degenerate one.
pub fn face_normal([a, b, c]: [[f64; 3]; 3]) -> [i16; 3] {
    // Scaled to around 1 first, so that squares neither overflow nor vanish.
    let side = |to: [f64; 3]| [0, 1, 2].map(|axis| to[axis] - a[axis]);
    let (u, v) = (side(b), side(c));
    let unit = |vector: [f64; 3]| {
        let largest = vector.iter().fold(0.0f64, |largest, part| largest.max(part.abs()));
        vector.map(|part| if largest > 0.0 { part / largest } else { 0.0 })
    };
    let (u, v) = (unit(u), unit(v));
    let normal = [(1, 2), (2, 0), (0, 1)].map(|(i, j)| u[i] * v[j] - u[j] * v[i]);
    let length = normal.iter().map(|part| part * part).sum::<f64>().sqrt();
    normal.map(|part| if length > 0.0 { (part / length * 16_384.0).round() as i16 } else { 0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUBE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
        f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";

    #[test]
    fn every_edge_is_drawn_once_whatever_file_it_comes_from() {
        for (text, edges) in [(CUBE.to_string(), 12), (format!("{CUBE}l 1 7\nl 7 1\n"), 13)] {
            let name = Path::new("cube.obj");
            let source = models::obj::parse_obj(text.as_bytes(), name, |_| Ok(None)).expect("a good model");
            let file = compile(&source, &Options::default()).expect("it compiles").bytes;
            let again = models::mesh_file::parse(&file, Path::new("cube.mesh")).expect("a good file");
            for source in [source, again] {
                assert_eq!(Model::new(&source).expect("of a usual size").edges().len(), edges);
            }
        }
    }
}
