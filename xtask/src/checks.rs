//! The steps of `cargo xtask test`: everything CI runs, the quick ones first.
//!
//! A step has the whole computer, as cargo's have, or runs [beside](beside) the steps next to it in the list that may,
//! too. What a step needs of toolchains and firmware it makes sure of by itself, and it costs little once it is there:
//! so any step runs alone.

mod beside;
mod board;
mod card;
mod cargo;
mod fpga;
mod mesh;
mod prove;
mod rtl;
mod simulator;
mod uboot;
mod usb;

use std::cell::{OnceCell, RefCell};
use std::collections::HashMap;
use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context, ensure};

use crate::boot::Bootable;
use crate::cli::Board;
use crate::firmware_build::build_firmware;
use crate::generated;
use crate::paths::target_folder;
use crate::progress::Progress;
use crate::setup::{FirmwareToolchain, ensure_firmware_toolchain, ensure_qemu, ensure_uboot};

/// What steps have in common, found or built when the first one asks.
struct State {
    progress: Progress,
    toolchain: OnceCell<FirmwareToolchain>,
    qemu: OnceCell<PathBuf>,
    elves: RefCell<HashMap<Board, PathBuf>>,
}

impl State {
    fn new() -> Self {
        Self { progress: Progress::new(), toolchain: OnceCell::new(), qemu: OnceCell::new(), elves: RefCell::default() }
    }

    fn toolchain(&self) -> anyhow::Result<&FirmwareToolchain> {
        if self.toolchain.get().is_none() {
            let _ = self.toolchain.set(ensure_firmware_toolchain(&self.progress)?);
        }
        self.toolchain.get().context("no Rust toolchain for the boards was found")
    }

    fn qemu(&self) -> anyhow::Result<PathBuf> {
        if self.qemu.get().is_none() {
            let _ = self.qemu.set(ensure_qemu(&self.progress)?);
        }
        self.qemu.get().cloned().context("QEMU was not found")
    }

    /// Returns the firmware for a board.
    fn elf(&self, board: Board) -> anyhow::Result<PathBuf> {
        if let Some(elf) = self.elves.borrow().get(&board) {
            return Ok(elf.clone());
        }
        let elf = build_firmware(board, &[], self.toolchain()?, &self.progress)?;
        self.elves.borrow_mut().insert(board, elf.clone());
        Ok(elf)
    }

    fn bootable(&self, board: Board) -> anyhow::Result<Bootable> {
        Ok(Bootable { board, elf: self.elf(board)?, qemu: self.qemu()? })
    }

    /// Returns the folder for what a step's firmware says.
    fn folder(&self, name: &str) -> PathBuf {
        target_folder().join("test").join(name)
    }
}

/// A step: what it checks, and the check.
struct Check {
    name: &'static str,
    run: fn(&State) -> anyhow::Result<()>,
    /// Whether it leaves a processor to another step that does.
    beside: bool,
}

/// A step that has the whole computer.
const fn alone(name: &'static str, run: fn(&State) -> anyhow::Result<()>) -> Check {
    Check { name, run, beside: false }
}

/// A step that another one may run beside: it writes no file that others do, and needs no quiet.
const fn beside(name: &'static str, run: fn(&State) -> anyhow::Result<()>) -> Check {
    Check { name, run, beside: true }
}

const CHECKS: &[Check] = &[
    alone("the source is formatted", |_| cargo::formatting()),
    alone("this computer has Verilator", rtl::tools),
    alone("this computer has a Rust toolchain for the boards", |state| state.toolchain().map(drop)),
    alone("this computer has QEMU", |state| state.qemu().map(drop)),
    alone("this computer has Yosys and Bitwuzla", prove::installed),
    alone("clippy finds nothing", cargo::clippy),
    alone("the tests of every crate pass on this computer", |_| cargo::tests()),
    alone("the generated files are fresh", |_| generated_files()),
    alone("the FPGA's design equals the software model, with 1, 2, 4 and 8 pixel units", rtl::tests),
    // The longest first, so that none is left over at the end.
    beside("theorems about the FPGA's design are proven", prove::theorems),
    beside("the firmware for de1-soc builds", |state| state.elf(Board::De1Soc).map(drop)),
    beside("theorems about a broken design are not", prove::broken_designs),
    beside("the firmware for vexpress-a9 builds", |state| state.elf(Board::VexpressA9).map(drop)),
    beside("the lint of the Quartus project finds mistakes", |_| cargo::fpga_tests()),
    beside("the firmware for raspi2b builds", |state| state.elf(Board::Raspi2b).map(drop)),
    beside("the board's U-Boot builds", |state| ensure_uboot(&state.progress).map(drop)),
    beside("the Quartus project agrees with the design and with itself", fpga::project),
    beside("the board's keys, switches, lights and displays answer", fpga::board_io),
    beside("other people's tools read the card image", card::card),
    beside("U-Boot follows the script of the card image", uboot::follows_the_script),
    alone("simulator: its tests pass, and what goes wrong around the board is told and survived", simulator::tests),
    beside("simulator: the image's demonstration equals the golden one", simulator::demonstration),
    beside("simulator: a mesh of 70,000 triangles is drawn as on this computer", mesh::in_the_simulator),
    beside("simulator: and with the FPGA's design, from its VGA pins", simulator::demonstration_on_the_design),
    beside("QEMU is handled well", |_| cargo::qemu_tests()),
    beside("the demonstration on vexpress-a9 equals the golden one and this computer's own", board::demonstration),
    beside("the demonstration on raspi2b equals the golden one", board::demonstration_on_raspi2b),
    beside("the pictures of the five systems equal the golden ones on vexpress-a9", board::seeds),
    beside("a mesh of 70,000 triangles in memory is drawn, a broken one is named", mesh::in_memory),
    beside("the recorded game gives the same score on vexpress-a9 and raspi2b", board::game),
    beside("a serial line that loses bytes costs what it carried, no more", board::lossy_line),
    beside("usb: a keyboard on the root port", usb::on_the_root_port),
    beside("usb: a keyboard behind a hub", usb::behind_a_hub),
    beside("usb: a DualShock 3 and a keyboard behind a hub play the session", usb::session_beside_a_keyboard),
    beside("usb: of 1,200 reports none is lost, none doubled", usb::long_run),
    beside("usb: devices come, go and take each other's place", usb::plugging_on_the_root_port),
    beside("usb: the same behind a hub", usb::plugging_behind_a_hub),
    beside("usb: requests that a pad refuses", usb::stalled_requests),
    beside("usb: a keyboard torn out holds no frame up", usb::frame_rate),
    // It builds another firmware for vexpress-a9.
    alone("the firmware reports faults and panics, and ends", board::faults),
];

/// Runs all steps, or those with `only` in their name; stops when one has failed.
///
/// # Errors
/// The step that failed, and why.
pub fn run(only: Option<&str>) -> anyhow::Result<()> {
    let wanted = |check: &&Check| only.is_none_or(|text| check.name.contains(text));
    let checks: Vec<&Check> = CHECKS.iter().filter(wanted).collect();
    ensure!(!checks.is_empty(), "no step has `{}` in its name", only.unwrap_or_default());
    let (state, started) = (State::new(), Instant::now());
    let mut passed = 0;
    for group in checks.chunk_by(|one, next| one.beside && next.beside) {
        let ended = match group {
            [check] => alone_in_turn(check, passed, checks.len(), &state),
            group => beside::run(group, passed, checks.len()),
        };
        passed += ended.passed;
        if let Some(failure) = ended.failure {
            println!("{passed} passed, then one failed, of {} steps", checks.len());
            return Err(failure);
        }
    }
    println!("{passed} passed, 0 failed ({:.0} s)", started.elapsed().as_secs_f64());
    Ok(())
}

/// How steps ended.
struct Ended {
    passed: usize,
    /// Of the first that failed.
    failure: Option<anyhow::Error>,
}

/// Runs a step in this process, its words on this terminal.
fn alone_in_turn(check: &Check, before: usize, count: usize, state: &State) -> Ended {
    let (number, started) = (before + 1, Instant::now());
    println!("[{number}/{count}] {}", check.name);
    match (check.run)(state) {
        Ok(()) => {
            println!("        passed in {:.1} s", started.elapsed().as_secs_f64());
            Ended { passed: 1, failure: None }
        }
        Err(error) => {
            Ended { passed: 0, failure: Some(error.context(format!("step {number} failed ({})", check.name))) }
        }
    }
}

/// Runs the step of just this name: what [`beside`] starts.
///
/// # Errors
/// Why it failed, or that there is none.
pub fn run_one(name: &str) -> anyhow::Result<()> {
    let check =
        CHECKS.iter().find(|check| check.name == name).with_context(|| format!("no step is called `{name}`"))?;
    (check.run)(&State::new())
}

fn generated_files() -> anyhow::Result<()> {
    let files = generated::all()?;
    let stale: Vec<&str> = files.iter().filter(|file| !file.is_fresh()).map(|file| file.path).collect();
    ensure!(stale.is_empty(), "{} stale: run `cargo xtask generate` and commit the result", stale.join(", "));
    Ok(())
}
