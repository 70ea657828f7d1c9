//! `cargo xtask area`: what the FPGA's design takes of the device.

use anyhow::ensure;

use crate::area;
use crate::cli::AreaArguments;
use crate::progress::Progress;
use crate::setup::ensure_yosys;
use crate::table::{Column, Table};
use crate::verilated::UNITS;
use crate::yosys::folder_with_design;

/// Synthesizes, and keeps `rtl/README.md` fresh.
///
/// # Errors
///
/// When Yosys cannot be had or fails, when memories became flip-flops, and with `--check` when the
/// README's table is stale.
pub fn run(arguments: &AreaArguments) -> anyhow::Result<()> {
    let progress = Progress::new();
    let yosys = ensure_yosys(&progress)?;
    let mut table = Table::new([
        Column::number("pixel units"),
        Column::number("ALUTs"),
        Column::number("flip-flops"),
        Column::number("M10K"),
        Column::number("DSP"),
        Column::number("longest path, cells"),
    ]);
    let folder = folder_with_design("area")?;
    let mut areas = Vec::new();
    for units in UNITS.into_iter().filter(|units| arguments.units.is_none_or(|only| only == *units)) {
        let step = progress.step(format!("synthesizing with {units} pixel unit{}", if units == 1 { "" } else { "s" }));
        let area = area::synthesize(&yosys, &folder, units)?;
        step.done();
        let cells = [area.units, area.aluts, area.flip_flops, area.m10k, area.dsp, area.longest_path];
        table.row(cells.map(|cell| cell.to_string()));
        areas.push(area);
    }
    print!("{table}");
    if arguments.units.is_some() {
        return Ok(());
    }
    if arguments.check {
        area::ensure_fresh()?;
        ensure!(area::committed()? == areas, "the area table in rtl/README.md is stale: run `cargo xtask area`");
    } else if area::write(&areas)? {
        println!("rtl/README.md has the new figures");
    }
    Ok(())
}
