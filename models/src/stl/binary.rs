//! Triangles of 50 bytes.

use std::path::Path;

use super::Builder;
use crate::number::finite;
use crate::{Model, ReadError};

/// Where the first triangle starts in the file.
const START: u64 = 84;
/// Bytes of a triangle: a normal and three corners of three 32-bit numbers, two bytes more.
const TRIANGLE: usize = 50;

/// Reads whole triangles, which follow the file's header.
pub(super) fn parse(triangles: &[u8], file: &Path) -> Result<Model, ReadError> {
    let mut builder = Builder::new();
    for (index, bytes) in triangles.chunks_exact(TRIANGLE).enumerate() {
        let offset = START + (index * TRIANGLE) as u64;
        let mut corners = [[0.0; 3]; 3];
        for (part, number) in corners.as_flattened_mut().iter_mut().enumerate() {
            let at = 12 + 4 * part;
            let value = f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
            *number = finite(value.into()).map_err(|problem| ReadError::byte(file, offset + at as u64, problem))?;
        }
        builder.triangle(corners).map_err(|problem| ReadError::byte(file, offset, problem))?;
    }
    builder.finish().map_err(|problem| ReadError::file(file, problem))
}
