//! Turns a model into a `.mesh` file.
//!
//! | step | what it does |
//! | --- | --- |
//! | `space` | scales the model into the positions' range and quantises it |
//! | `surface` | one vertex for all corners with the same position, normal and colour; normals where there are none |
//! | `order` | puts the faces in an order in which neighbours use the same vertices |
//! | `blocks` | cuts them into blocks |

mod blocks;
mod order;
mod space;
mod surface;

use std::fmt;

use mesh_format::{BlockData, Flags, FormatError, Header};

use crate::{Model, PLAIN};

pub use order::CACHE;

/// What of a model's looks a file keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Looks {
    /// What flat and smooth drawing want.
    #[default]
    Both,
    /// Normals and colours of the faces alone.
    Flat,
    /// Normals and colours of the vertices alone.
    Smooth,
}

/// How a model becomes a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Options {
    /// What of its looks the file keeps.
    pub looks: Looks,
    /// Moves the model's middle to the origin and scales it to a radius of 1.
    pub scale_to_fit: bool,
    /// Faces are seen from both sides.
    pub two_sided: bool,
    /// The model's faces go clockwise, seen from outside.
    pub clockwise: bool,
}

/// A file, and what came of the model.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// The `.mesh` file.
    pub bytes: Vec<u8>,
    /// What is in it.
    pub report: Report,
}

/// What came of a model.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Report {
    /// Positions that the model's file gave.
    pub positions: usize,
    /// Vertices that are different in position, normal or colour.
    pub vertices: usize,
    /// Vertices in the blocks, where one on a border counts in each.
    pub stored_vertices: usize,
    /// Triangles.
    pub faces: usize,
    /// Triangles without area, left out.
    pub left_out: usize,
    /// Edges, each once.
    pub edges: usize,
    /// Blocks.
    pub blocks: usize,
    /// Vertices that a cache of [`CACHE`] misses a triangle, in the model's order and in the file's.
    pub cache_misses: [f64; 2],
    /// How far a coordinate may be off, in the model's units.
    pub error_bound: f64,
}

/// Why a model becomes no file.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum CompileError {
    /// The coordinates are too large or too small for a scale to bring them into range.
    Size {
        /// The largest magnitude.
        largest: f64,
    },
    /// All faces and lines are without extent.
    NothingLeft {
        /// Faces that there were.
        faces: usize,
    },
    /// The file would break the format.
    Format(FormatError),
}

impl fmt::Display for CompileError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size { largest } => write!(
                out,
                "the model's largest coordinate is {largest:e}: scale the model to a size between 1e-100 and 1e100"
            ),
            Self::NothingLeft { faces } => {
                write!(out, "none of the {faces} faces has an area, and no line a length: export the model again")
            }
            Self::Format(error) => error.fmt(out),
        }
    }
}

impl std::error::Error for CompileError {}

/// Makes a file of a model.
///
/// # Errors
/// [`CompileError`].
pub fn compile(model: &Model, options: &Options) -> Result<Compiled, CompileError> {
    let space = space::Space::new(&model.positions, options.scale_to_fit)?;
    let surface = surface::Surface::new(model, &space, options);
    let order = order::tipsify(&surface.faces, surface.vertices.len());
    let mut blocks = blocks::of_faces(&surface, &order);
    blocks.extend(blocks::of_lines(&surface));
    if blocks.is_empty() {
        return Err(CompileError::NothingLeft { faces: model.face_count() });
    }
    let header = header(&surface, &space, options);
    let bytes = mesh_format::write(&header, &blocks).map_err(CompileError::Format)?;
    let total = |count: fn(&BlockData) -> usize| blocks.iter().map(count).sum::<usize>();
    let in_order = (0..surface.faces.len() as u32).collect::<Vec<_>>();
    let misses = |order: &[u32]| order::cache_misses(&surface.faces, order, surface.vertices.len());
    let report = Report {
        positions: model.positions.len(),
        vertices: surface.vertices.len(),
        stored_vertices: total(|block| block.positions.len()),
        faces: surface.faces.len(),
        left_out: surface.left_out,
        edges: total(|block| block.edges.len()),
        blocks: blocks.len(),
        cache_misses: [misses(&in_order), misses(&order)],
        error_bound: space.error_bound(),
    };
    Ok(Compiled { bytes, report })
}

fn header(surface: &surface::Surface, space: &space::Space, options: &Options) -> Header {
    let has_faces = !surface.faces.is_empty();
    let (for_flat, for_smooth) =
        (has_faces && options.looks != Looks::Smooth, has_faces && options.looks != Looks::Flat);
    // What all faces share stands in the header.
    let first = surface.looks.first().map(|look| look.colour);
    let one_colour = surface.looks.iter().all(|look| Some(look.colour) == first)
        && surface.vertices.iter().all(|vertex| vertex.colour.is_none() || vertex.colour == first);
    let flags = Flags::default()
        .with(Flags::VERTEX_NORMALS, for_smooth)
        .with(Flags::VERTEX_COLOURS, for_smooth && !one_colour)
        .with(Flags::FACE_NORMALS, for_flat)
        .with(Flags::FACE_COLOURS, for_flat && !one_colour)
        .with(Flags::TWO_SIDED, options.two_sided);
    let colour = first.unwrap_or(surface::bytes(PLAIN));
    Header { flags, colour, offset: space.offset, step: space.step, scale_log2: space.scale_log2, ..Header::default() }
}
