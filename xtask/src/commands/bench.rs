//! `cargo xtask bench`: measures the cost per vertex, triangle and pixel, the FPGA's clocks, and the USB code.

use std::fs;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, ensure};

use crate::area;
use crate::boot::Bootable;
use crate::card::program::Program;
use crate::cargo_build;
use crate::cli::{BenchArguments, Board};
use crate::code_size;
use crate::fill;
use crate::firmware_build::build_firmware;
use crate::frame_model;
use crate::measure::{self, Measurement};
use crate::paths::target_folder;
use crate::progress::Progress;
use crate::session;
use crate::setup::ensure_firmware_toolchain;
use crate::simulated::{Build, Design, Simulator};
use crate::table::{Column, Table};
use crate::usb_cost;
use crate::verilated::Verilated;

/// Measures.
///
/// # Errors
///
/// When something is missing that cannot be installed, or the firmware does not build or run.
pub fn run(arguments: &BenchArguments) -> anyhow::Result<()> {
    if cfg!(debug_assertions) {
        return run_optimised(arguments);
    }
    let progress = Progress::new();
    let parts = session::demo()?;
    let bootable = Bootable::prepare(Board::VexpressA9, &progress)?;
    let mut machine = bootable.start(&target_folder().join("bench"))?;
    let step = progress.step("counting instructions in QEMU");
    let mut measurements = measure::on_board(&mut machine, &parts)?;
    machine.quit()?;
    step.done();
    let step = progress.step("measuring on this computer");
    measurements.extend(measure::on_host()?);
    step.done();
    let verilated = Verilated::prepare(false, &progress)?;
    let step = progress.step("counting the FPGA's clocks");
    measurements.extend(verilated.bench()?);
    let fills = fill::measure(&verilated)?;
    measurements.extend(fill::measurements(&fills));
    step.done();
    let toolchain = ensure_firmware_toolchain(&progress)?;
    let elf = build_firmware(Board::De1Soc, &[], &toolchain, &progress)?;
    measurements.push(measure::image(&Program::read(&elf)?));
    for design in [Design::Model, Design::Rtl] {
        let simulator = Simulator::prepare(design, false, Build::Optimised, &progress)?;
        let step = progress.step("timing the DE1-SoC's simulator");
        let mut board = simulator.start(&elf, &target_folder().join("bench/console.txt"))?;
        measurements.extend(measure::on_simulator(&mut board, design)?);
        step.done();
    }
    let frames = frame_model::frames(&measurements)?;
    measurements.extend(area::measurements()?);
    measurements.push(code_size::measurement(&progress)?);
    let step = progress.step("counting what the USB driver asks of its core");
    measurements.extend(usb_cost::measurements()?);
    step.done();
    measurements.extend(frames);
    if arguments.json {
        println!("{}", serde_json::to_string_pretty(&measurements).context("cannot put the numbers into JSON")?);
    } else {
        print!("{}", table(&measurements));
        println!("\nwhat more pixel units bring, on the last frame of each picture of the five systems:\n");
        print!("{}", fill::table(&fills));
    }
    if let Some(path) = &arguments.plot {
        fs::write(path, fill::plot(&fills).svg())
            .with_context(|| format!("cannot write {}: check its folder", path.display()))?;
        progress.step(format!("writing {}", path.display())).done();
    }
    Ok(())
}

/// Runs this command again as the profile `measure` builds it: times with overflow checks say little.
fn run_optimised(arguments: &BenchArguments) -> anyhow::Result<()> {
    let step = Progress::new().step("building xtask optimised, which takes a minute the first time");
    let mut cargo = cargo_build::cargo();
    cargo.args(["build", "--quiet", "--profile", "measure", "--package", "xtask"]);
    let status = cargo.status().context("cannot start cargo: is Rust installed?")?;
    ensure!(status.success(), "xtask does not build optimised ({status}); cargo says why above");
    step.done();
    let program = target_folder().join("measure/xtask");
    let mut optimised = Command::new(&program);
    optimised.arg("bench").args(arguments.json.then_some("--json"));
    optimised.args(arguments.plot.iter().flat_map(|path| [Path::new("--plot"), path]));
    let status = optimised.status().with_context(|| format!("cannot start {}", program.display()))?;
    ensure!(status.success(), "the optimised build ended with {status}");
    Ok(())
}

fn table(measurements: &[Measurement]) -> Table {
    let mut table = Table::new([
        Column::text("what"),
        Column::number("value"),
        Column::text("unit"),
        Column::number("bar"),
        Column::text(""),
    ]);
    for it in measurements {
        let bar = it.bar.map(|bar| format!("{bar}")).unwrap_or_default();
        let remark = it.verdict().or(it.note.as_deref()).unwrap_or_default();
        table.row([&it.name, &format!("{:.2}", it.value), &it.unit, &bar, remark]);
    }
    table
}
