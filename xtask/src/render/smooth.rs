//! Smooth faces, by the file and the blocks that the board draws: vertices' own normals and colours.

use anyhow::Context;
use firmware::scene::found::{BlockMemory, Found};
use fixed::types::I32F32;
use geometry::{DrawStatistics, LitColour, Matrix, ObjectLight, ScreenTransform, ScreenVertex, Sink, Transformed};
use mesh_format::VERTICES_MAX;
use models::compile::{Looks, Options, compile};

use super::View;

/// Draws a model; the view takes positions that were divided by 2 to the `scale_log2`.
///
/// # Errors
/// When the model becomes no file.
pub(super) fn draw(
    source: &models::Model,
    scale_log2: i32,
    view: &View,
    light: &ObjectLight,
    sink: &mut impl Sink,
) -> anyhow::Result<DrawStatistics> {
    let options = Options { looks: Looks::Smooth, ..Options::default() };
    let bytes = compile(source, &options).context("the model cannot be drawn smooth")?.bytes;
    let found = Found::new(&bytes)?;
    // Both scales bring the model close to the positions' range.
    let scale = I32F32::from_num(f64::from(i32::from(found.header().scale_log2) - scale_log2).exp2());
    let model_to_clip = view.model_to_clip.times(&Matrix::scaling([scale; 3]));
    let transform = ScreenTransform::of_extent(&model_to_clip, found.extent());
    let mut memory = Box::new(BlockMemory::new());
    let (mut vertices, mut lit) = ([ScreenVertex::default(); VERTICES_MAX], [LitColour::default(); VERTICES_MAX]);
    let mut sum = DrawStatistics::default();
    for block in found.blocks().filter(|block| !block.corners.is_empty()) {
        let part = memory.decode(found.header(), &block).context("the compiled model is malformed")?;
        let transformed = Transformed::new(&part.mesh, &transform, &mut vertices)?;
        let lit = transformed.light_vertices(part.looks, light, &mut lit)?;
        let DrawStatistics { vertices, submitted, clipped, drawn } = transformed.draw_smooth(&lit, view.culling, sink);
        sum.vertices += vertices;
        sum.submitted += submitted;
        sum.clipped += clipped;
        sum.drawn += drawn;
    }
    Ok(sum)
}
