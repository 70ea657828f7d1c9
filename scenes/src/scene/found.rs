//! The model of a mesh file: drawn from where the file lies, a block at a time, so that only memory limits it.

mod block;

use fixed::types::I32F32;
use geometry::Matrix;
use mesh_format::{Blocks, Flags, FormatError, Header, MeshFile};

pub use block::BlockMemory;

use crate::style::Pass;

/// The file that is built in: a dodecahedron and a prism.
pub const BUILT_IN: &[u8] = include_bytes!("../../../assets/solids.mesh");

/// A mesh file that was checked, and the way to fit its model into the unit sphere.
#[derive(Debug, Clone, Copy)]
pub struct Found<'a> {
    file: MeshFile<'a>,
    fit: Matrix,
}

impl<'a> Found<'a> {
    /// Checks the file at the start of `bytes`, whatever follows it there.
    ///
    /// # Errors
    /// [`FormatError`] for the first thing that is wrong with it.
    pub fn new(bytes: &'a [u8]) -> Result<Self, FormatError> {
        let file = MeshFile::read_start(bytes)?;
        Ok(Self { file, fit: fit(file.header()) })
    }

    /// Returns what the file says about the whole model.
    pub fn header(&self) -> &Header {
        self.file.header()
    }

    /// Returns the file's blocks.
    pub fn blocks(&self) -> Blocks<'a> {
        self.file.blocks()
    }

    /// Returns the matrix that takes the model's middle to the origin, and no corner farther than 1 from there.
    pub fn fit(&self) -> &Matrix {
        &self.fit
    }

    /// Returns the greatest magnitude of each coordinate, in units of 2⁻²⁸.
    pub fn extent(&self) -> [u32; 3] {
        self.header().extent()
    }

    /// Returns whether faces are seen from both sides.
    pub fn is_two_sided(&self) -> bool {
        self.header().flags.contains(Flags::TWO_SIDED)
    }

    /// Returns what is drawn for a pass: without vertices' normals no smooth faces but flat ones, of a model of
    /// lines its lines.
    pub fn pass(&self, pass: Pass) -> Option<Pass> {
        let header = self.header();
        match pass {
            Pass::Hiding if header.faces == 0 => None,
            _ if header.faces == 0 => Some(Pass::Lines),
            Pass::Smooth if !header.flags.contains(Flags::VERTEX_NORMALS) => Some(Pass::Flat),
            pass => Some(pass),
        }
    }
}

/// Returns the way of the box that the header's numbers span into the unit sphere.
fn fit(header: &Header) -> Matrix {
    // Lowest and highest of each axis, in units of 2⁻²⁸.
    let ends = |axis: usize| [0, u16::MAX].map(|number| i64::from(header.coordinate(axis, number)));
    let half = |axis: usize| (ends(axis)[1] - ends(axis)[0]).unsigned_abs() / 2;
    // No half reaches 2³¹, so their squares' sum goes into 64 bits.
    let radius = (0..3).map(|axis| half(axis).pow(2)).sum::<u64>().isqrt().max(1);
    let scale = I32F32::from_bits(((1u64 << 60) / radius) as i64);
    let centre = |axis: usize| I32F32::from_bits(ends(axis).iter().sum::<i64>() << 3);
    Matrix::scaling([scale; 3]).times(&Matrix::translation([0, 1, 2].map(|axis| -centre(axis))))
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;

    #[test]
    fn the_built_in_file_is_a_good_one() {
        let found = Found::new(BUILT_IN).expect("a good file");
        assert!(found.header().faces > 20 && found.header().edges > 0);
        assert_eq!(found.pass(Pass::Smooth), Some(Pass::Smooth));
    }

    #[test]
    fn any_box_fits_into_the_unit_sphere() {
        for (offset, step) in [([-(1 << 28); 3], [8193; 3]), ([1 << 30, 5, -9], [0, 1, 70_000]), ([7; 3], [0; 3])] {
            let header = Header { offset, step, ..Header::default() };
            let fit = fit(&header);
            for corner in 0..8u32 {
                let number = |axis: usize| if corner >> axis & 1 == 1 { u16::MAX } else { 0 };
                let at = [0, 1, 2].map(|axis| f64::from(header.coordinate(axis, number(axis))) / f64::from(1 << 28));
                let fitted: std::vec::Vec<f64> = (0..3)
                    .map(|row| {
                        let row = fit.rows[row].map(|part| part.to_num::<f64>());
                        row[0] * at[0] + row[1] * at[1] + row[2] * at[2] + row[3]
                    })
                    .collect();
                let distance = fitted.iter().map(|part| part * part).sum::<f64>().sqrt();
                let expected = if step == [0; 3] { 0.0 } else { 1.0 };
                assert!((distance - expected).abs() < 0.01, "{offset:?} {step:?}: {fitted:?}");
            }
        }
    }
}
