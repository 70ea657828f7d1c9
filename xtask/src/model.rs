//! A model from a file as a mesh that `geometry` draws.

use anyhow::{Context, bail};
use fixed::types::I4F28;
use geometry::mesh::{Face, Mesh, Position, Winding};

use crate::obj::ObjModel;

/// Half the range that a model is scaled into: coordinates of −4…4 of the −8…8 there is.
const LARGEST_LOG2: i32 = 2;
/// The colour of a face whose corners have none.
const PLAIN: [u8; 3] = [200, 200, 200];

/// A mesh on the heap, and how it was scaled.
#[derive(Debug, Clone)]
pub struct Model {
    positions: Vec<Position>,
    faces: Vec<Face>,
    /// What a stored coordinate is multiplied by to give the file's: 2 to this.
    pub scale_log2: i32,
    /// Lowest and highest coordinates in the file.
    pub bounds: [[f64; 3]; 2],
}

impl Model {
    /// Scales a model by a power of two, so that it uses the positions' range, and works out
    /// its faces' normals and colours. Polygons become fans.
    ///
    /// # Errors
    /// When the coordinates are so large or so small that no power of two of `f64` brings them
    /// into range.
    pub fn new(obj: &ObjModel) -> anyhow::Result<Self> {
        let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        let mut largest = 0.0f64;
        for position in &obj.positions {
            for axis in 0..3 {
                bounds[0][axis] = bounds[0][axis].min(position[axis]);
                bounds[1][axis] = bounds[1][axis].max(position[axis]);
                largest = largest.max(position[axis].abs());
            }
        }
        if largest > 1e100 || (largest > 0.0 && largest < 1e-100) {
            bail!("the model's largest coordinate is {largest:e}: scale the model to a size between 1e-100 and 1e100");
        }
        let scale_log2 = if largest > 0.0 { largest.log2().floor() as i32 + 1 - LARGEST_LOG2 } else { 0 };
        let scale = 2.0f64.powi(-scale_log2);
        let scaled = |position: &[f64; 3]| position.map(|part| part * scale);
        let positions =
            obj.positions.iter().map(|position| position_bits(scaled(position)).map(I4F28::from_bits)).collect();
        let faces = obj
            .triangles()
            .map(|corners| Face {
                corners,
                normal: face_normal(corners.map(|corner| obj.positions[corner as usize])),
                colour: face_colour(obj, corners),
            })
            .collect();
        Ok(Self { positions, faces, scale_log2, bounds })
    }

    /// Returns the model as a mesh, counter-clockwise as OBJ has it.
    ///
    /// # Errors
    /// When a face names a missing corner, which the reader of the file has ruled out.
    pub fn mesh(&self) -> anyhow::Result<Mesh<'_>> {
        Mesh::new(&self.positions, &self.faces, Winding::CounterClockwise).context("the model is malformed")
    }
}

fn face_colour(obj: &ObjModel, corners: [u32; 3]) -> [u8; 3] {
    let Some(colours) = &obj.colours else { return PLAIN };
    [0, 1, 2].map(|channel| {
        let sum: f32 = corners.iter().map(|corner| colours[*corner as usize][channel].clamp(0.0, 1.0)).sum();
        (sum / 3.0 * 255.0).round() as u8
    })
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
