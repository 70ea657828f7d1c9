//! What a scene of the demonstration took and made.

use std::path::Path;

use anyhow::Context;
use serde::Serialize;

use crate::machine::Identity;
use crate::session::{PlayedFrame, instructions};
use crate::table::{Column, Table, thousands};

/// Most instructions that a triangle of the torus may cost, its share of the vertices included.
pub const INSTRUCTIONS_PER_TRIANGLE_MAX: f64 = 165.0;

/// The report file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// In the order in which they were played.
    pub scenes: Vec<SceneReport>,
}

/// Sums over a scene's frames.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SceneReport {
    /// The scene.
    pub name: String,
    /// Frames drawn.
    pub frames: u32,
    /// Vertices transformed.
    pub vertices: u64,
    /// Triangles that the meshes have.
    pub triangles_submitted: u64,
    /// Triangles that went to the FPGA; a clipped one may make several.
    pub triangles_drawn: u64,
    /// Triangles that had to be clipped.
    pub triangles_clipped: u64,
    /// Packets of every kind.
    pub packets: u64,
    /// Their words.
    pub words: u64,
    /// Cortex-A9 instructions for a vertex.
    pub instructions_per_vertex: f64,
    /// Cortex-A9 instructions for a submitted triangle, from vertices to packet words.
    pub instructions_per_triangle: f64,
    /// The screen's checksum after every frame.
    pub frame_checksums: Vec<String>,
}

impl SceneReport {
    /// Sums up a scene's frames.
    pub fn new(name: &str, identity: &Identity, frames: &[PlayedFrame]) -> Self {
        let sum = |of: fn(&PlayedFrame) -> u32| frames.iter().map(|frame| u64::from(of(frame))).sum::<u64>();
        let vertices = sum(|frame| frame.report.vertices);
        let triangles_submitted = sum(|frame| frame.report.triangles_submitted);
        let vertex_ticks = sum(|frame| frame.report.vertex_ticks);
        let face_ticks = sum(|frame| frame.report.face_ticks);
        let each = |ticks: u64, count: u64| round_to_tenths(instructions(ticks, identity) / count.max(1) as f64);
        Self {
            name: name.to_string(),
            frames: frames.len() as u32,
            vertices,
            triangles_submitted,
            triangles_drawn: sum(|frame| frame.report.triangles_drawn),
            triangles_clipped: sum(|frame| frame.report.triangles_clipped),
            packets: sum(|frame| frame.report.packets),
            words: sum(|frame| frame.report.words),
            instructions_per_vertex: each(vertex_ticks, vertices),
            instructions_per_triangle: each(vertex_ticks + face_ticks, triangles_submitted),
            frame_checksums: frames.iter().map(|frame| checksum_text(frame.screen_checksum)).collect(),
        }
    }
}

fn round_to_tenths(value: f64) -> f64 {
    (value * 10.0).round() / 10.0
}

/// Returns a checksum as reports have it.
pub fn checksum_text(checksum: u32) -> String {
    format!("{checksum:#010x}")
}

impl Report {
    /// Writes the report as JSON.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write(&self, path: &Path) -> anyhow::Result<()> {
        let text = serde_json::to_string_pretty(self).context("cannot put the report into JSON")?;
        std::fs::write(path, text + "\n").with_context(|| format!("cannot write {}", path.display()))
    }

    /// Returns a row for each scene, all numbers sums over its frames.
    pub fn table(&self) -> Table {
        let numbers =
            ["frames", "submitted", "drawn", "clipped", "packets", "words", "instr./vertex", "instr./triangle"];
        let mut table = Table::new([Column::text("scene")].into_iter().chain(numbers.map(Column::number)));
        for scene in &self.scenes {
            table.row([
                scene.name.clone(),
                thousands(scene.frames.into()),
                thousands(scene.triangles_submitted),
                thousands(scene.triangles_drawn),
                thousands(scene.triangles_clipped),
                thousands(scene.packets),
                thousands(scene.words),
                format!("{:.1}", scene.instructions_per_vertex),
                format!("{:.1}", scene.instructions_per_triangle),
            ]);
        }
        table
    }

    /// Returns what the torus, where the bar is set, costs a triangle.
    pub fn torus_instructions(&self) -> Option<f64> {
        self.scenes.iter().find(|scene| scene.name == "torus").map(|scene| scene.instructions_per_triangle)
    }
}

/// Returns whether a cost is within its bar, in words.
pub fn verdict(found: f64, bar: f64) -> &'static str {
    if found <= bar { "holds" } else { "MISSED" }
}
