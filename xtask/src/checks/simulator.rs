//! Steps that run the image that is flashed, in the DE1-SoC's simulator.

use std::fs;
use std::path::Path;

use anyhow::Context;

use super::{State, cargo};
use crate::card::PROGRAM_NAME;
use crate::card::program::Program;
use crate::cli::Board;
use crate::demo;
use crate::golden::{self, Golden};
use crate::machine::Simulated;
use crate::session;
use crate::simulated::{Build, CRATE, Design, Simulator};

/// How many frames of each scene are drawn, from its first on: all 204 would take minutes. The plate's cost least.
const ELF_FRAMES: [usize; 3] = [24, 6, 4];
const RTL_FRAMES: [usize; 3] = [3, 2, 1];
/// What names the image to the tests of the crate: the ELF file, and the program on the card.
const IMAGE: &str = "HALFSPACE_IMAGE";
const BINARY: &str = "HALFSPACE_BINARY";

/// Features that the crate's other steps leave out.
pub(super) fn clippy() -> anyhow::Result<()> {
    cargo::run(
        &["clippy", "--quiet", "--package", CRATE, "--all-targets", "--all-features", "--", "-D", "warnings"],
        "mend what clippy names above",
    )
}

/// The tests that start the board with the image and break something.
pub(super) fn faults(state: &mut State) -> anyhow::Result<()> {
    let (folder, elf) = (state.folder("simulator"), image(state)?);
    fs::create_dir_all(&folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
    let binary = folder.join(PROGRAM_NAME);
    fs::write(&binary, Program::read(elf)?.bytes).with_context(|| format!("cannot write {}", binary.display()))?;
    cargo::run_with(
        &["test", "--quiet", "--package", CRATE, "--test", "image", "--", "--include-ignored"],
        &[(IMAGE, elf), (BINARY, &binary)],
        "the failed test is named above",
    )
}

/// The demonstration from the ELF file.
pub(super) fn demonstration(state: &mut State) -> anyhow::Result<()> {
    let elf = image(state)?.to_path_buf();
    play(state, Design::Model, &elf, ELF_FRAMES)
}

/// The same on the FPGA's design; the pictures come from its VGA pins.
pub(super) fn demonstration_on_the_design(state: &mut State) -> anyhow::Result<()> {
    let elf = image(state)?.to_path_buf();
    play(state, Design::Rtl, &elf, RTL_FRAMES)
}

fn image(state: &State) -> anyhow::Result<&Path> {
    let board = Board::De1Soc;
    state.elves.get(&board).map(AsRef::as_ref).with_context(|| format!("the firmware for {board} was not built"))
}

/// Plays the first frames of the session's scenes, and compares each picture with the golden one.
fn play(state: &State, design: Design, image: &Path, frames: [usize; 3]) -> anyhow::Result<()> {
    let golden = Golden::read(golden::DEMO)?.with_context(|| format!("{} is missing", golden::DEMO))?;
    let mut parts = session::demo()?;
    for (part, count) in parts.iter_mut().zip(frames) {
        part.frames.truncate(count);
    }
    parts.retain(|part| !part.frames.is_empty());
    let simulator = Simulator::prepare(design, false, Build::Checked, &state.progress)?;
    let mut machine = Simulated::start(&simulator, image, &state.folder("simulator"))?;
    let played = demo::play(&mut machine, &parts, &state.progress)?;
    golden
        .beginning(&parts)
        .check(&Golden::from(&played.report))
        .with_context(|| format!("in the DE1-SoC's simulator ({design:?}), from {}", image.display()))
}
