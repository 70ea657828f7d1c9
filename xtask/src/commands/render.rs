//! `cargo xtask render`: draws a model through the geometry and the raster model, on the host.

use std::fmt::Write as _;
use std::path::Path;
use std::time::Instant;

use anyhow::Context;
use firmware::style::Style;
use fpga_regs::screen::{HEIGHT, WIDTH};
use geometry::{Culling, Matrix};

use crate::cli::RenderArguments;
use crate::model::{self, Model};
use crate::picture::{write_depth_pgm, write_png};
use crate::render::camera::{Fit, of_window, to_matrix};
use crate::render::{SetUp, View, mvp, render};
use crate::stream::to_bytes;
use crate::table::thousands;

/// Draws the model.
///
/// # Errors
///
/// When the model or the matrix is malformed, or an output cannot be written.
pub fn run(arguments: &RenderArguments) -> anyhow::Result<()> {
    let started = Instant::now();
    let source = model::read(&arguments.model)?;
    source.notes.iter().for_each(|note| println!("note: {note}"));
    let model = Model::new(&source).with_context(|| format!("cannot use {}", arguments.model.display()))?;
    let culling = if arguments.two_sided { Culling::None } else { Culling::BackFaces };
    let (model_to_clip, turned) = match (&arguments.mvp, &source.view, arguments.rotate) {
        (Some(path), ..) => (mvp::read(path)?, Matrix::IDENTITY),
        (None, Some(view), None) => (of_window(view), Matrix::IDENTITY),
        (None, _, rotate) => {
            let fit = Fit::new(&source.positions, rotate.map_or([0.0; 3], |rotation| rotation.degrees));
            (fit.model_to_clip(), fit.rotation_matrix())
        }
    };
    let model_to_clip = to_matrix(&model_to_clip, model.scale_log2);
    let view = View { model_to_clip, model: turned, culling, style: arguments.style };
    let rendered = render(&source, &model, &view)?;
    write_png(&arguments.output, &rendered.picture)?;
    if let Some(path) = &arguments.dump {
        write(path, &to_bytes(&rendered.words))?;
    }
    if let Some(path) = &arguments.triangles {
        write(path, triangles_text(&rendered.triangles).as_bytes())?;
    }
    if let Some(path) = &arguments.depth {
        write_depth_pgm(path, WIDTH, HEIGHT, &rendered.depth)?;
    }
    let statistics = rendered.statistics;
    let number = |count: u32| thousands(count.into());
    println!(
        "{} vertices; {} {} submitted, {} drawn, {} clipped; {} words; {:.2} s",
        number(statistics.vertices),
        if model.is_wire() || arguments.style == Style::Wire { "lines" } else { "triangles" },
        number(statistics.submitted),
        number(statistics.drawn),
        number(statistics.clipped),
        thousands(rendered.words.len() as u64),
        started.elapsed().as_secs_f64()
    );
    if statistics.drawn == 0 {
        println!("note: nothing is visible; if the model's faces go clockwise, try --two-sided");
    }
    println!("wrote {}", arguments.output.display());
    Ok(())
}

/// A line for each triangle: three corners of x, y, depth, then red, green, blue.
fn triangles_text(triangles: &[SetUp]) -> String {
    let mut text = String::new();
    for triangle in triangles {
        for part in triangle.corners.as_flattened() {
            let _ = write!(text, "{part} ");
        }
        let [red, green, blue] = triangle.colour;
        let _ = writeln!(text, "{red} {green} {blue}");
    }
    text
}

fn write(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    std::fs::write(path, bytes).with_context(|| format!("cannot write {}: check its folder", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_is_a_line_of_twelve_numbers() {
        let triangle = SetUp { corners: [[1, -2, 3], [4, 5, 6], [7, 8, 65_535]], colour: [9, 10, 255] };
        assert_eq!(triangles_text(&[triangle]), "1 -2 3 4 5 6 7 8 65535 9 10 255\n");
    }
}
