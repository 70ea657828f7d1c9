//! One frame of a scene: which objects stand where, who looks at them, what lights them.

use fixed::types::{I2F30, I16F16, I32F32};
use geometry::{Angle, Culling, DirectionalLight, Matrix};
use heapless::Vec;

use super::meshes::Shape;
use crate::style::{Projection, Style};

/// Most objects of a scene.
pub const MAX_OBJECTS: usize = 16;

/// What an object is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Subject {
    /// A mesh that is built in.
    Shape(Shape),
    /// The model of a mesh file, its middle at the origin and no more than 1 away from it.
    Found,
}

impl From<Shape> for Subject {
    fn from(shape: Shape) -> Self {
        Self::Shape(shape)
    }
}

/// A mesh in its place.
#[derive(Debug, Clone, Copy)]
pub struct Object {
    /// Its mesh.
    pub subject: Subject,
    /// Model to world space; it may scale unevenly.
    pub model: Matrix,
    /// Which of its faces are drawn; of a mesh file's, both sides where the file says so.
    pub culling: Culling,
}

impl Object {
    /// Returns a closed mesh in its place, drawn from its front.
    pub fn new(subject: impl Into<Subject>, model: Matrix) -> Self {
        Self { subject: subject.into(), model, culling: Culling::BackFaces }
    }
}

/// Who looks.
#[derive(Debug, Clone, Copy)]
pub struct Camera {
    /// World to eye space.
    pub view: Matrix,
    /// Eye to clip space.
    pub projection: Matrix,
}

/// What a scene shows in one frame.
#[derive(Debug, Clone)]
pub struct Stage {
    /// Who looks.
    pub camera: Camera,
    /// The light, in world space.
    pub light: DirectionalLight,
    /// How the objects are drawn.
    pub style: Style,
    /// The objects, drawn in this order.
    pub objects: Vec<Object, MAX_OBJECTS>,
}

impl Stage {
    /// Returns the stage without objects.
    pub fn new(camera: Camera, light: DirectionalLight, style: Style) -> Self {
        Self { camera, light, style, objects: Vec::new() }
    }

    /// Returns the stage with one more object; one beyond [`MAX_OBJECTS`] is left out.
    #[must_use]
    pub fn with(mut self, object: Object) -> Self {
        let _ = self.objects.push(object);
        self
    }
}

/// White light from above on the left, from the viewer's side.
pub const DAYLIGHT: DirectionalLight = DirectionalLight {
    // A unit vector.
    direction: [I2F30::lit("-0.36"), I2F30::lit("0.8"), I2F30::lit("0.48")],
    colour: [255; 3],
    diffuse: I16F16::lit("0.75"),
    ambient: I16F16::lit("0.25"),
};

/// Everything in its own colour.
pub const FULL_LIGHT: DirectionalLight = DirectionalLight { diffuse: I16F16::ZERO, ambient: I16F16::ONE, ..DAYLIGHT };

/// Returns a projection between near and far planes at these distances; what is `distance` from the eye is
/// as large in one projection as in the other.
pub fn lens(projection: Projection, distance: I32F32, planes: (I32F32, I32F32)) -> Matrix {
    match projection {
        Projection::Perspective => perspective(const { I16F16::lit("45") }, planes.0, planes.1),
        Projection::Orthographic => {
            // tan 22.5° is 0.4142.
            let half = distance * const { I32F32::lit("0.4142") };
            let wide = half * 4 / 3;
            Matrix::orthographic((-wide, wide), (-half, half), planes)
        }
    }
}

/// Returns OpenGL's perspective for the 4:3 screen; the field of view is in degrees, the planes'
/// distances in world units.
pub fn perspective(field_of_view: I16F16, near: I32F32, far: I32F32) -> Matrix {
    let angle = Angle::from_degrees(field_of_view);
    Matrix::perspective(angle, I32F32::from_num(4) / 3, near, far)
}
