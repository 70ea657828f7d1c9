//! `cargo xtask mesh`: turns a model into a file that the firmware draws.

use std::time::Instant;

use anyhow::Context;
use models::compile::{CACHE, Compiled, Looks, Options, Report, compile};

use crate::cli::MeshArguments;
use crate::model;
use crate::table::{Column, Table, thousands};

/// Turns the model into a `.mesh` file.
///
/// # Errors
///
/// When the model is malformed, or the file cannot be written.
pub fn run(arguments: &MeshArguments) -> anyhow::Result<()> {
    let started = Instant::now();
    let model = model::read(&arguments.model)?;
    let options = Options {
        looks: match (arguments.flat, arguments.smooth) {
            (true, _) => Looks::Flat,
            (_, true) => Looks::Smooth,
            _ => Looks::Both,
        },
        scale_to_fit: arguments.scale_to_fit,
        two_sided: arguments.two_sided,
        clockwise: arguments.clockwise,
    };
    let compiled = compile(&model, &options).with_context(|| format!("cannot use {}", arguments.model.display()))?;
    std::fs::write(&arguments.output, &compiled.bytes)
        .with_context(|| format!("cannot write {}: check its folder", arguments.output.display()))?;
    model.notes.iter().for_each(|note| println!("note: {note}"));
    if model.view.is_some() {
        println!("note: the eye, the plane and the window of the file are left out: the firmware has its own camera");
    }
    print!("{}", table(&compiled));
    println!("wrote {} ({:.2} s)", arguments.output.display(), started.elapsed().as_secs_f64());
    Ok(())
}

fn table(Compiled { bytes, report }: &Compiled) -> Table {
    let Report { positions, vertices, stored_vertices, faces, left_out, edges, blocks, cache_misses, error_bound } =
        report;
    let count = |number: usize| thousands(number as u64);
    let per_face = |number: f64| if *faces > 0 { format!("{number:.3}") } else { "–".into() };
    let mut table = Table::new([Column::text("what"), Column::number("number")]);
    table
        .row(["positions in the model".to_string(), count(*positions)])
        .row(["vertices that differ in position, normal or colour".into(), count(*vertices)])
        .row(["vertices in the file, one on a border in each block".into(), count(*stored_vertices)])
        .row(["triangles".into(), count(*faces)])
        .row(["triangles without area, left out".into(), count(*left_out)])
        .row(["edges".into(), count(*edges)])
        .row(["blocks".into(), count(*blocks)])
        .row([format!("misses a triangle of a cache of {CACHE} vertices, before"), per_face(cache_misses[0])])
        .row(["the same, after".into(), per_face(cache_misses[1])])
        .row(["vertices to transform a triangle".into(), per_face(*stored_vertices as f64 / *faces as f64)])
        .row(["a coordinate may be off by".into(), format!("{error_bound:.1e}")])
        .row(["bytes".into(), count(bytes.len())]);
    table
}
