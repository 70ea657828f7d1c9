//! Model files to one model in memory, and that to the file that the firmware draws from.
//!
//! | module | what it reads |
//! | --- | --- |
//! | [`obj`] | Wavefront OBJ: polygons, lines, normals, vertex colours, materials' diffuse colour |
//! | [`stl`] | STL, as text or binary |
//! | [`babylon`] | Babylon JSON, as Blender's exporter of 2014 wrote it and as today's write it |
//! | [`gltf`] | glTF 2.0, binary (`.glb`) |
//! | [`rom`] | the 99-bit lines of MIT 6.111's "Wireframe Simulator" |
//! | [`mesh_file`] | `.mesh`, this project's own |
//!
//! [`read`] tells them apart and gives a [`Model`]; [`compile`] makes a `.mesh` of one. Every error
//! names the file, the place in it, the value and the remedy. No file, however broken, makes a reader panic. Of
//! the broken ones that the tests read none takes more than 1 MiB and 200 bytes for each of the file's own; vertices,
//! corners and lines ([`VERTICES_MAX`], [`CORNERS_MAX`]), and what JSON has of meshes and nodes
//! ([`babylon::ITEMS_MAX`], [`gltf::PARTS_MAX`]), are limited in number.
#![forbid(unsafe_code)]

pub mod babylon;
pub mod compile;
mod error;
pub mod gltf;
mod kind;
pub mod mesh_file;
mod model;
mod number;
pub mod obj;
mod polygon;
pub mod rom;
pub mod stl;

pub use error::{Place, Problem, ReadError};
pub use kind::{Kind, read};
pub use model::{CORNERS_MAX, Model, NO_NORMAL, PLAIN, VERTICES_MAX, View};
