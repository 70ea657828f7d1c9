//! A mesh: what is drawn, checked once so that drawing need not.

use core::fmt;

use fixed::types::I4F28;

/// A corner's position in model space, Q4.28: −8 to 8 with 28 bits of fraction.
///
/// A model of another size is brought into this range by whoever reads it, and the factor goes
/// into its model matrix.
pub type Position = [I4F28; 3];

/// A triangle of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Face {
    /// Indices of its corners, in the mesh's [`Winding`].
    pub corners: [u32; 3],
    /// Its unit normal in model space, outwards, Q2.14; zero takes no directional light.
    pub normal: [i16; 3],
    /// Its colour in full light: red, green, blue, 0…255.
    pub colour: [u8; 3],
}

/// The order of a face's corners, seen from its front.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Winding {
    /// Counter-clockwise, as OpenGL and OBJ have it.
    #[default]
    CounterClockwise,
    /// Clockwise.
    Clockwise,
}

/// Why corners and faces make no mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum MeshError {
    /// A face names a corner that does not exist.
    CornerOutOfRange {
        /// Index of the face, from 0.
        face: usize,
        /// The corner it names, from 0.
        corner: u32,
        /// How many corners there are.
        corners: usize,
    },
}

impl fmt::Display for MeshError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self::CornerOutOfRange { face, corner, corners } = self;
        write!(
            out,
            "face {face} names corner {corner}, but the mesh has {corners} (counted from 0): export the model again"
        )
    }
}

impl core::error::Error for MeshError {}

/// A mesh whose faces name existing corners.
#[derive(Debug, Clone, Copy)]
pub struct Mesh<'a> {
    positions: &'a [Position],
    faces: &'a [Face],
    winding: Winding,
    extent: [u32; 3],
}

impl<'a> Mesh<'a> {
    /// Checks corners and faces and returns the mesh; reads all of both once.
    ///
    /// # Errors
    /// [`MeshError::CornerOutOfRange`] for the first face that names a missing corner.
    pub fn new(positions: &'a [Position], faces: &'a [Face], winding: Winding) -> Result<Self, MeshError> {
        for (face, corner) in faces.iter().enumerate().flat_map(|(face, it)| it.corners.map(|corner| (face, corner))) {
            if corner as usize >= positions.len() {
                return Err(MeshError::CornerOutOfRange { face, corner, corners: positions.len() });
            }
        }
        let mut extent = [0; 3];
        for position in positions {
            for (extent, part) in extent.iter_mut().zip(position) {
                *extent = part.to_bits().unsigned_abs().max(*extent);
            }
        }
        Ok(Self { positions, faces, winding, extent })
    }

    /// Returns the corners' positions.
    pub fn positions(&self) -> &'a [Position] {
        self.positions
    }

    /// Returns the faces.
    pub fn faces(&self) -> &'a [Face] {
        self.faces
    }

    /// Returns the order of each face's corners.
    pub fn winding(&self) -> Winding {
        self.winding
    }

    /// Returns the greatest magnitude of each coordinate, in units of 2⁻²⁸.
    pub fn extent(&self) -> [u32; 3] {
        self.extent
    }
}
