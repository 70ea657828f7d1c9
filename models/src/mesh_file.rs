//! Reads this project's own `.mesh` files.

use std::path::Path;

use mesh_format::{Block, Flags, MeshFile, NORMAL_ONE};

use crate::model::direction;
use crate::number::finite;
use crate::{Model, NO_NORMAL, Problem, ReadError};

/// Reads a model from a file's bytes; `file` is its name in errors.
///
/// A vertex on the border of two blocks comes twice. The file's edges are the model's lines.
///
/// # Errors
///
/// The first thing that is wrong.
pub fn parse(bytes: &[u8], file: &Path) -> Result<Model, ReadError> {
    let mesh = MeshFile::read(bytes).map_err(|problem| ReadError::file(file, problem))?;
    let mut model = Model::empty();
    model.face_colours = Some(Vec::new());
    for block in mesh.blocks() {
        add(&mesh, &block, &mut model).map_err(|problem| ReadError::file(file, problem))?;
    }
    model.finish().map_err(|problem| ReadError::file(file, problem))
}

fn add(mesh: &MeshFile<'_>, block: &Block<'_>, model: &mut Model) -> Result<(), Problem> {
    let header = mesh.header();
    let scale = f64::from(header.scale_log2).exp2() / f64::from(1 << 28);
    let unit = |colour: [u8; 3]| colour.map(|part| f32::from(part) / 255.0);
    let first = model.positions.len() as u32;
    for numbers in block.positions {
        let numbers = Block::position(*numbers);
        let [x, y, z] = [0, 1, 2].map(|axis| finite(f64::from(header.coordinate(axis, numbers[axis])) * scale));
        model.push_vertex([x?, y?, z?])?;
    }
    if header.flags.contains(Flags::VERTEX_COLOURS) {
        model.colours.get_or_insert_default().extend(block.colours.iter().map(|colour| unit(*colour)));
    }
    let part = |part: u8| f64::from(part as i8) / f64::from(NORMAL_ONE);
    model.normals.extend(block.normals.iter().map(|normal| direction(normal.map(part))));
    for (index, corners) in block.corners.iter().enumerate() {
        let corners = corners.map(|corner| first + u32::from(corner));
        if header.flags.contains(Flags::VERTEX_NORMALS) {
            // As many normals as positions, in the same order.
            let of_zero = |corner: u32| model.normals[corner as usize] == [0.0; 3];
            let normals = corners.map(|corner| if of_zero(corner) { NO_NORMAL } else { corner });
            model.corner_normals.extend(normals);
        }
        model.push_triangle(corners)?;
        let colour = block.face_colours.get(index).copied().unwrap_or(header.colour);
        model.face_colours.get_or_insert_default().push(unit(colour));
    }
    block.edges.iter().try_for_each(|ends| model.push_line(ends.map(|end| first + u32::from(end))))
}
