//! The steps of `cargo xtask test`: everything CI runs, the quick ones first.

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
use crate::setup::{FirmwareToolchain, ensure_firmware_toolchain, ensure_qemu};

/// What earlier steps leave for later ones.
struct State {
    progress: Progress,
    toolchain: Option<FirmwareToolchain>,
    qemu: Option<PathBuf>,
    elves: HashMap<Board, PathBuf>,
}

impl State {
    fn toolchain(&self) -> anyhow::Result<&FirmwareToolchain> {
        self.toolchain.as_ref().context("no Rust toolchain for the boards was found")
    }

    fn bootable(&self, board: Board) -> anyhow::Result<Bootable> {
        let elf = self.elves.get(&board).with_context(|| format!("the firmware for {board} was not built"))?.clone();
        let qemu = self.qemu.clone().context("QEMU was not found")?;
        Ok(Bootable { board, elf, qemu })
    }

    /// Returns the folder for what a step's firmware says.
    fn folder(&self, name: &str) -> PathBuf {
        target_folder().join("test").join(name)
    }
}

/// A step: what it checks, and the check.
struct Check {
    name: &'static str,
    run: fn(&mut State) -> anyhow::Result<()>,
}

const CHECKS: &[Check] = &[
    Check { name: "the source is formatted", run: |_| cargo::formatting() },
    Check { name: "clippy finds nothing", run: |_| cargo::clippy() },
    Check { name: "the tests of every crate pass on this computer", run: |_| cargo::tests() },
    Check { name: "the generated files are fresh", run: |_| generated_files() },
    Check { name: "this computer has Verilator", run: rtl::tools },
    Check { name: "the Quartus project agrees with the design and with itself", run: fpga::project },
    Check { name: "the lint of the Quartus project finds mistakes", run: |_| cargo::fpga_tests() },
    Check { name: "the board's keys, switches, lights and displays answer", run: fpga::board_io },
    Check { name: "clippy finds nothing in the FPGA's simulation", run: |_| rtl::clippy() },
    Check {
        name: "the FPGA's design equals the software model, with 1, 2, 4 and 8 pixel units",
        run: |_| rtl::tests(),
    },
    Check { name: "theorems about the FPGA's design are proven", run: prove::theorems },
    Check { name: "theorems about a broken design are not", run: prove::broken_designs },
    Check { name: "a wave of the FPGA's design shows its words", run: |_| rtl::waves() },
    Check { name: "this computer has a Rust toolchain for the boards", run: toolchain },
    Check { name: "this computer has QEMU", run: qemu },
    Check { name: "the firmware for de1-soc builds", run: |state| build(state, Board::De1Soc) },
    Check { name: "the firmware for vexpress-a9 builds", run: |state| build(state, Board::VexpressA9) },
    Check { name: "the firmware for raspi2b builds", run: |state| build(state, Board::Raspi2b) },
    Check { name: "other people's tools read the card image", run: card::card },
    Check { name: "U-Boot follows the script of the card image", run: uboot::follows_the_script },
    Check { name: "QEMU is handled well", run: |_| cargo::qemu_tests() },
    Check {
        name: "the demonstration on vexpress-a9 equals the golden one and this computer's own",
        run: board::demonstration,
    },
    Check { name: "the demonstration on raspi2b equals the golden one", run: board::demonstration_on_raspi2b },
    Check { name: "the pictures of the five systems equal the golden ones on vexpress-a9", run: board::seeds },
    Check { name: "a mesh of 70,000 triangles in memory is drawn, a broken one is named", run: mesh::in_memory },
    Check { name: "the recorded game gives the same score on vexpress-a9", run: board::game },
    Check { name: "simulator: the image's demonstration equals the golden one", run: simulator::demonstration },
    Check {
        name: "simulator: and with the FPGA's design, from its VGA pins",
        run: simulator::demonstration_on_the_design,
    },
    Check { name: "simulator: a mesh of 70,000 triangles is drawn as on this computer", run: mesh::in_the_simulator },
    Check { name: "simulator: what goes wrong around the board is told and survived", run: simulator::faults },
    Check { name: "simulator: clippy finds nothing in its window and its FPGA", run: |_| simulator::clippy() },
    Check { name: "a serial line that loses bytes costs what it carried, no more", run: board::lossy_line },
    Check { name: "the firmware reports faults and panics, and ends", run: board::faults },
    Check { name: "usb: a keyboard on the root port", run: usb::on_the_root_port },
    Check { name: "usb: a keyboard behind a hub", run: usb::behind_a_hub },
    Check {
        name: "usb: a DualShock 3 and a keyboard behind a hub play the session",
        run: usb::session_beside_a_keyboard,
    },
    Check { name: "usb: of 1,200 reports none is lost, none doubled", run: usb::long_run },
    Check { name: "usb: devices come, go and take each other's place", run: usb::plugging_on_the_root_port },
    Check { name: "usb: the same behind a hub", run: usb::plugging_behind_a_hub },
    Check { name: "usb: requests that a pad refuses", run: usb::stalled_requests },
    Check { name: "usb: a keyboard torn out holds no frame up", run: usb::frame_rate },
];

impl Check {
    /// Returns whether other steps need what this one leaves.
    fn is_needed(&self) -> bool {
        self.name.starts_with("this computer has ") || self.name.ends_with(" builds")
    }

    /// Returns whether it runs when only steps with a text in their name are wanted.
    fn is_wanted(&self, only: Option<&str>) -> bool {
        only.is_none_or(|text| self.is_needed() || self.name.contains(text))
    }
}

/// Runs all steps, or those with `only` in their name and what they need; stops at the first that
/// fails.
///
/// # Errors
/// The step that failed, and why.
pub fn run(only: Option<&str>) -> anyhow::Result<()> {
    let checks: Vec<&Check> = CHECKS.iter().filter(|check| check.is_wanted(only)).collect();
    if let Some(text) = only {
        ensure!(checks.iter().any(|check| !check.is_needed()), "no step has `{text}` in its name");
    }
    let mut state = State { progress: Progress::new(), toolchain: None, qemu: None, elves: HashMap::new() };
    let started = Instant::now();
    for (index, check) in checks.iter().enumerate() {
        let step = Instant::now();
        println!("[{}/{}] {}", index + 1, checks.len(), check.name);
        if let Err(error) = (check.run)(&mut state) {
            println!("{index} passed, 1 failed, {} not run", checks.len() - index - 1);
            return Err(error.context(format!("step {} failed ({})", index + 1, check.name)));
        }
        println!("        passed in {:.1} s", step.elapsed().as_secs_f64());
    }
    println!("{} passed, 0 failed ({:.0} s)", checks.len(), started.elapsed().as_secs_f64());
    Ok(())
}

fn generated_files() -> anyhow::Result<()> {
    let files = generated::all()?;
    let stale: Vec<&str> = files.iter().filter(|file| !file.is_fresh()).map(|file| file.path).collect();
    ensure!(stale.is_empty(), "{} stale: run `cargo xtask generate` and commit the result", stale.join(", "));
    Ok(())
}

fn toolchain(state: &mut State) -> anyhow::Result<()> {
    state.toolchain = Some(ensure_firmware_toolchain(&state.progress)?);
    Ok(())
}

fn qemu(state: &mut State) -> anyhow::Result<()> {
    state.qemu = Some(ensure_qemu(&state.progress)?);
    Ok(())
}

fn build(state: &mut State, board: Board) -> anyhow::Result<()> {
    let elf = build_firmware(board, &[], state.toolchain()?, &state.progress)?;
    state.elves.insert(board, elf);
    Ok(())
}
