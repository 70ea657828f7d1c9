//! The DE1-SoC as a program: live in a window, or ordered about over its standard input.
//! `cargo xtask run --board de1-soc` starts it.
//!
//! Its one argument is a [`Job`] in JSON. Without a window it takes orders, a line of JSON each
//! ([`simulator::remote`]), and answers each with a line.

use std::error::Error;
use std::io::{self, BufRead, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use serde::Deserialize;
use simulator::remote::Remote;
use simulator::{Image, PowerOn};

/// Where a mesh file is loaded: behind the program and the FPGA's image.
const MESH_ADDRESS: u32 = 0x0A00_0000;

/// What to run, and how.
#[derive(Deserialize)]
struct Job {
    /// The program: an ELF file, or a raw binary.
    image: PathBuf,
    /// A mesh file that U-Boot loads and tells the program of.
    mesh: Option<PathBuf>,
    /// Pixel units of the verilated design; without, the software model draws.
    rtl: Option<u32>,
    /// File for what the console's line carries.
    console: PathBuf,
    /// Whether to open a window, and run until it is closed.
    window: bool,
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Box<dyn Error>> {
    let job = std::env::args().nth(1).ok_or("no job: `cargo xtask run --board de1-soc` starts this program")?;
    let job: Job = serde_json::from_str(&job).map_err(|error| format!("`{job}` is no job: {error}"))?;
    let image = Image::read(&job.image).map_err(|error| format!("{}: {error}", job.image.display()))?;
    let mut board = PowerOn::new(image);
    if let Some(path) = &job.mesh {
        let bytes = std::fs::read(path).map_err(|error| format!("cannot read {}: {error}", path.display()))?;
        let [address, length] = [MESH_ADDRESS, bytes.len() as u32].map(|number| format!("{number:#x}"));
        board = board.loaded(MESH_ADDRESS, &bytes).arguments(&["mesh", &address, &length]);
    }
    if let Some(units) = job.rtl {
        board = with_rtl(board, units)?;
    }
    let console = std::fs::File::create(&job.console)
        .map_err(|error| format!("cannot write {}: {error}", job.console.display()))?;
    let machine = board.start();
    if job.window {
        return live(machine, console);
    }
    let mut remote = Remote::new(machine, console);
    for line in io::stdin().lock().lines() {
        let answer = remote.obey(&line?);
        let mut out = io::stdout().lock();
        writeln!(out, "{answer}")?;
        out.flush()?;
    }
    Ok(())
}

#[cfg(feature = "rtl")]
fn with_rtl(board: PowerOn, units: u32) -> Result<PowerOn, Box<dyn Error>> {
    if !rtl_sim::UNITS.contains(&units) {
        return Err(format!("no build has {units} pixel units: there are {:?}", rtl_sim::UNITS).into());
    }
    Ok(board.design(Box::new(simulator::fpga::rtl::Verilated::new(units))))
}

#[cfg(not(feature = "rtl"))]
fn with_rtl(_: PowerOn, _: u32) -> Result<PowerOn, Box<dyn Error>> {
    Err("built without the feature `rtl`: `cargo xtask run --board de1-soc --rtl` builds it with".into())
}

#[cfg(feature = "window")]
fn live(machine: simulator::Machine, console: std::fs::File) -> Result<(), Box<dyn Error>> {
    simulator::live::run(machine, console)
}

#[cfg(not(feature = "window"))]
fn live(_: simulator::Machine, _: std::fs::File) -> Result<(), Box<dyn Error>> {
    Err("built without the feature `window`: `cargo xtask run --board de1-soc` builds it with".into())
}
