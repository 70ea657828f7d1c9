//! From a mesh and matrices to triangle packets, in integers only.
//!
//! | module | step |
//! | --- | --- |
//! | [`mesh`] | positions, faces, winding, checked once |
//! | [`matrix`] | model, view and projection, composed in 64 bits |
//! | [`transform`] | a vertex to screen space: one dot product a row, one reciprocal |
//! | [`clip`] | homogeneous clipping at the near and far planes and the guard band |
//! | [`light`] | ambient and directional light |
//! | [`look`] | a vertex's normal and colour, and both lit |
//! | [`setup`] | edge functions, box and depth plane of a screen triangle |
//! | [`line`] | lines, as packets of very thin triangles |
//! | [`wire`] | a mesh's edges, each once |
//! | [`pipeline`] | all of it for a mesh: [`draw`] |
//! | [`angle`], [`reciprocal`] | sine and cosine; 1/x without a divide instruction |
//! | [`shapes`] | meshes that the project makes itself |
//!
//! The same input gives the same words on every machine: there is no floating point between a
//! vertex and its packet, so a golden test on a PC is a test of the Cortex-A9.
//!
//! Spaces are OpenGL's: right-handed, column vectors, clip space −w…w with y up. On screen y is
//! down, row 0 on top, pixel centres at .5, coordinates in sixteenths of a pixel; depth is 0 at
//! the near plane and 65,535 at the far one.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod angle;
pub mod clip;
pub mod light;
pub mod line;
pub mod look;
pub mod matrix;
pub mod mesh;
mod pass;
pub mod pipeline;
pub mod reciprocal;
pub mod setup;
mod shade;
pub mod shapes;
pub mod transform;
pub mod wire;

pub use angle::Angle;
pub use light::{DirectionalLight, ObjectLight};
pub use line::LineStyle;
pub use look::{LitColour, VertexLook};
pub use matrix::{Matrix, Vector};
pub use mesh::{Face, Mesh, MeshError, Winding};
pub use pipeline::{CacheTooSmall, Culling, DrawStatistics, Drawn, LitVertices, Sink, Transformed, draw};
pub use setup::ScreenVertex;
pub use shade::Unlit;
pub use transform::ScreenTransform;
