//! What a vertex, a triangle and a pixel cost: instructions on the board, nanoseconds here.

use std::time::Instant;

use anyhow::Context;
use controls::{Config, Controls};
use firmware::scene::Scene;
use firmware::scene::meshes::{MAX_VERTICES, MeshMemory, Meshes, Shape};
use firmware::style::Style;
use firmware::viewer::Viewer;
use fixed::types::{I4F28, I32F32};
use fpga_regs::packet::{Clear, FlatTriangle};
use fpga_regs::registers::{Control, Register};
use fpga_regs::screen::{DEPTH_FAR, Rgb332};
use geometry::{
    Culling, Drawn, Face, Matrix, Mesh, ObjectLight, ScreenTransform, ScreenVertex, Sink, Transformed, Winding,
};
use serde::{Deserialize, Serialize};

use crate::card::program::{BYTES_MAX, Program};
use crate::machine::{Link, Machine};
use crate::report::{INSTRUCTIONS_PER_TRIANGLE_MAX, SceneReport, verdict};
use crate::session::{self, ScenePart};
use crate::simulated::{CacheCounts, Design, Running};
use crate::software_fpga::with_model;

/// Runs of which the median counts.
const RUNS: usize = 15;
/// Frames in a run of the geometry.
const FRAMES: usize = 20;
/// Full screens in a run of the model.
const SCREENS: i32 = 40;
/// Frames of each scene on the board.
const BOARD_FRAMES: usize = 8;
/// Longest time from the DE1-SoC's entry to its first frame, in milliseconds.
const FIRST_FRAME_MS: f64 = 300.0;
/// Attempts to be quick, and frames of each.
const ATTEMPTS: usize = 10;
const ATTEMPT_FRAMES: u64 = 10;

/// Most instructions that smooth shading may cost a vertex more than flat shading.
const SMOOTH_EXTRA_INSTRUCTIONS_MAX: f64 = 25.0;

/// One number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Measurement {
    /// What was measured.
    pub name: String,
    /// How much it is.
    pub value: f64,
    /// Of what.
    pub unit: String,
    /// What it may not be worse than, if there is such a bar.
    pub bar: Option<f64>,
    /// Which way is better.
    pub better: Better,
    /// What else is to be said of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
}

/// Which way a number is better.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Better {
    /// More is better: a bar is a least value.
    Higher,
    /// Less is better: a bar is a largest value.
    Lower,
}

impl Measurement {
    /// Returns a figure without a bar, rounded to hundredths; less is better.
    pub fn new(name: &str, value: f64, unit: &str) -> Self {
        let value = (value * 100.0).round() / 100.0;
        Self { name: name.into(), value, unit: unit.into(), bar: None, better: Better::Lower, note: None }
    }

    /// Returns in words whether it reaches its bar, if it has one.
    pub fn verdict(&self) -> Option<&'static str> {
        self.bar.map(|bar| match self.better {
            Better::Higher => verdict(bar, self.value),
            Better::Lower => verdict(self.value, bar),
        })
    }
}

/// Counts the Cortex-A9's instructions in a few frames of the demonstration session.
///
/// # Errors
/// When the board fails.
pub fn on_board(machine: &mut impl Machine, parts: &[ScenePart]) -> anyhow::Result<Vec<Measurement>> {
    let mut link = Link::new(machine);
    let identity = link.identify()?;
    let mut report = |scene: Scene, style: Option<Style>| {
        let part = parts.iter().find(|part| part.scene == scene);
        let part = part.with_context(|| format!("the session has no scene {}", scene.name()))?;
        let part = ScenePart { scene, style, frames: part.frames.iter().take(BOARD_FRAMES).copied().collect() };
        let mut frames = Vec::new();
        session::play(&mut link, &part, |frame| {
            frames.push(frame);
            Ok(())
        })?;
        anyhow::Ok(SceneReport::new(scene.name(), &identity, &frames))
    };
    let (plate, torus, tunnel) =
        (report(Scene::Plate, None)?, report(Scene::Torus, None)?, report(Scene::Tunnel, None)?);
    let smooth = report(Scene::Torus, Some(Style::Smooth))?;
    let per = |name, value| Measurement::new(name, value, "instructions");
    Ok(vec![
        Measurement {
            bar: Some(INSTRUCTIONS_PER_TRIANGLE_MAX),
            ..per("geometry.instructions_per_triangle", torus.instructions_per_triangle)
        },
        Measurement {
            bar: Some(SMOOTH_EXTRA_INSTRUCTIONS_MAX),
            ..per("vertex.smooth_extra_instructions", smooth.instructions_per_vertex - torus.instructions_per_vertex)
        },
        per("geometry.instructions_per_smooth_triangle", smooth.instructions_per_triangle),
        per("geometry.instructions_per_vertex", torus.instructions_per_vertex),
        Measurement::new(
            "geometry.drawn_share",
            torus.triangles_drawn as f64 / torus.triangles_submitted.max(1) as f64,
            "of the submitted",
        ),
        per("geometry.instructions_per_large_triangle", plate.instructions_per_triangle),
        per("geometry.instructions_per_clipped_scene_triangle", tunnel.instructions_per_triangle),
    ])
}

/// Returns how large the DE1-SoC's program is: code and constants.
pub fn image(program: &Program) -> Measurement {
    let bytes = program.bytes.len() as f64;
    Measurement { bar: Some(BYTES_MAX as f64), ..Measurement::new("de1_soc.image_bytes", bytes, "bytes") }
}

/// Starts the DE1-SoC in its simulator and returns how long its start takes, in its own time, and how many frames
/// of its first scene the simulator shows in a second of this computer's: the best of a few attempts, since other
/// programs can only make it slower. `design` is in the FPGA.
///
/// # Errors
/// When the simulator stops the firmware.
pub fn on_simulator(board: &mut Running, design: Design) -> anyhow::Result<Vec<Measurement>> {
    let mut done = board.frames(1)?;
    let first = Measurement {
        bar: Some(FIRST_FRAME_MS),
        ..Measurement::new("de1_soc.first_frame_ms", done.nanoseconds as f64 / 1e6, "ms")
    };
    let (name, bar) = match design {
        Design::Model => ("simulator.model_fps", 60.0),
        Design::Rtl => ("simulator.rtl_fps", 15.0),
    };
    let mut best = 0.0_f64;
    for _ in 0..ATTEMPTS {
        let started = Instant::now();
        done = board.frames(done.frames + ATTEMPT_FRAMES)?;
        best = best.max(ATTEMPT_FRAMES as f64 / started.elapsed().as_secs_f64());
    }
    let rate = Measurement { bar: Some(bar), better: Better::Higher, ..Measurement::new(name, best, "frames/s") };
    Ok(match design {
        Design::Model => [vec![first, rate], cache_counts(done.caches)].concat(),
        Design::Rtl => vec![rate],
    })
}

/// Returns how often caches were maintained and bus masters at work since power-on.
fn cache_counts(counts: CacheCounts) -> Vec<Measurement> {
    let count = |name: &str, count: u64, unit| Measurement::new(&format!("de1_soc.{name}"), count as f64, unit);
    vec![
        count("cache_l1_by_line", counts.l1_lines, "operations"),
        count("cache_l1_by_set_and_way", counts.l1_sets, "operations"),
        count("cache_l2_by_line", counts.l2_lines, "operations"),
        count("cache_l2_by_way", counts.l2_ways, "operations"),
        count("dma_lines_read", counts.dma_reads, "lines"),
        count("dma_lines_written", counts.dma_writes, "lines"),
    ]
}

/// Times geometry and software model in this process.
///
/// # Errors
/// When a built-in mesh is malformed.
pub fn on_host() -> anyhow::Result<Vec<Measurement>> {
    let mut mesh_memory = Box::<MeshMemory>::default();
    let meshes = Meshes::new(&mut mesh_memory)?;
    let mesh = &meshes.of(Shape::Torus).mesh;
    let stage = Viewer::new(Scene::Torus).stage(&Controls::new(Config::default()).state());
    let model = stage.objects.first().context("the torus's stage has no object")?.model;
    let model_to_clip = stage.camera.projection.times(&stage.camera.view).times(&model);
    let transform = ScreenTransform::new(&model_to_clip, mesh);
    let light = ObjectLight::new(&stage.light, &model);
    let mut cache = vec![ScreenVertex::default(); MAX_VERTICES];
    let mut words = Words { buffer: vec![0; 2 * mesh.faces().len() * FlatTriangle::WORDS], used: 0 };

    let vertices = median_nanoseconds(|| {
        for _ in 0..FRAMES {
            std::hint::black_box(Transformed::new(mesh, &transform, &mut cache).is_ok());
        }
    });
    let triangles = median_nanoseconds(|| {
        for _ in 0..FRAMES {
            words.used = 0;
            if let Ok(transformed) = Transformed::new(mesh, &transform, &mut cache) {
                std::hint::black_box(transformed.draw(&light, Culling::BackFaces, &mut words));
            }
        }
    });
    let each = |nanoseconds: f64, count: usize| nanoseconds / (FRAMES * count) as f64;
    Ok(vec![
        Measurement::new("geometry.host_ns_per_vertex", each(vertices, mesh.positions().len()), "ns"),
        Measurement::new("geometry.host_ns_per_triangle", each(triangles, mesh.faces().len()), "ns"),
        Measurement::new("model.host_ns_per_pixel", pixel_nanoseconds()?, "ns"),
    ])
}

/// Draws the whole screen again and again, each time nearer, so that every pixel is written.
fn pixel_nanoseconds() -> anyhow::Result<f64> {
    let words = screens()?;
    with_model(|device| {
        device.write(Register::Control, Control::default().with_enable(true).0);
        let before = device.counters().pixels_written;
        device.push(&words);
        let pixels = device.counters().pixels_written - before;
        anyhow::ensure!(pixels > 0, "the full-screen triangles drew nothing");
        Ok(median_nanoseconds(|| device.push(&words)) / f64::from(pixels))
    })
}

/// Returns a clear, and two triangles for each full screen.
fn screens() -> anyhow::Result<Vec<u32>> {
    let one = I4F28::ONE;
    let positions = [(-one, -one), (one, -one), (one, one), (-one, one)].map(|(x, y)| [x, y, I4F28::ZERO]);
    let faces = [[0, 1, 2], [0, 2, 3]].map(|corners| Face { corners, normal: [0; 3], colour: [200, 100, 50] });
    let mesh = Mesh::new(&positions, &faces, Winding::CounterClockwise)?;
    let mut cache = [ScreenVertex::default(); 4];
    let mut words = Words { buffer: vec![0; 2 * SCREENS as usize * FlatTriangle::WORDS], used: 0 };
    for screen in 0..SCREENS {
        let nearer = I32F32::from_num(SCREENS / 2 - screen) / i64::from(SCREENS);
        let transform = ScreenTransform::new(&Matrix::translation([I32F32::ZERO, I32F32::ZERO, nearer]), &mesh);
        Transformed::new(&mesh, &transform, &mut cache)?.draw(&ObjectLight::FULL, Culling::BackFaces, &mut words);
    }
    let clear = Clear { colour: Rgb332::BLACK, depth: DEPTH_FAR }.encode();
    Ok([&clear[..], &words.buffer[..words.used]].concat())
}

/// Puts words into memory, as the firmware does.
struct Words {
    buffer: Vec<u32>,
    used: usize,
}

impl Sink for Words {
    fn room<const N: usize>(&mut self) -> Option<&mut [u32; N]> {
        self.buffer[self.used..].first_chunk_mut()
    }

    fn take<const N: usize>(&mut self, _: Drawn<'_>) {
        self.used += N;
    }
}

fn median_nanoseconds(mut work: impl FnMut()) -> f64 {
    let mut times: Vec<u128> = (0..RUNS)
        .map(|_| {
            let start = Instant::now();
            work();
            start.elapsed().as_nanos()
        })
        .collect();
    times.sort_unstable();
    times[RUNS / 2] as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn everything_is_measured_and_is_above_nothing() {
        let measurements = on_host().expect("built-in meshes are good");
        assert_eq!(measurements.len(), 3);
        assert!(measurements.iter().all(|it| it.value > 0.0 && it.unit == "ns"), "{measurements:?}");
    }

    #[test]
    fn a_bar_is_a_least_or_a_largest_value() {
        let at = |value, better| Measurement { bar: Some(7.0), better, ..Measurement::new("it", value, "pixels") };
        assert_eq!(at(7.5, Better::Higher).verdict(), Some("holds"));
        assert_eq!(at(6.5, Better::Higher).verdict(), Some("MISSED"));
        assert_eq!(at(7.5, Better::Lower).verdict(), Some("MISSED"));
        assert_eq!(at(7.0, Better::Lower).verdict(), Some("holds"));
        assert_eq!(Measurement::new("it", 1.0, "ns").verdict(), None);
    }

    #[test]
    fn the_full_screens_write_every_pixel_each_time() {
        let words = screens().expect("a good mesh");
        let pixels = with_model(|device| {
            device.write(Register::Control, Control::default().with_enable(true).0);
            device.push(&words);
            device.counters().pixels_written
        });
        assert_eq!(pixels as usize, SCREENS as usize * fpga_regs::screen::PIXELS);
    }
}
