//! Steps that run the image that is flashed, in the DE1-SoC's simulator.

use std::fs;

use anyhow::Context;

use super::{State, cargo, rtl};
use crate::card::PROGRAM_NAME;
use crate::card::program::Program;
use crate::cli::Board;
use crate::demo;
use crate::golden::{self, Golden};
use crate::machine::Simulated;
use crate::session;
use crate::simulated::{Build, CRATE, Design, RTL_FEATURES, Simulator};

/// What names the image to the tests of the crate: the ELF file, and the program on the card.
const IMAGE: &str = "HALFSPACE_IMAGE";
const BINARY: &str = "HALFSPACE_BINARY";

/// The crate's own tests, and those that start the board with the image and break something.
pub(super) fn tests(state: &State) -> anyhow::Result<()> {
    let (folder, elf) = (state.folder("simulator"), state.elf(Board::De1Soc)?);
    rtl::tools(state)?;
    fs::create_dir_all(&folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
    let binary = folder.join(PROGRAM_NAME);
    fs::write(&binary, Program::read(&elf)?.bytes).with_context(|| format!("cannot write {}", binary.display()))?;
    cargo::run_with(
        &["test", "--quiet", "--package", CRATE, "--features", RTL_FEATURES, "--", "--include-ignored"],
        &[(IMAGE, &elf), (BINARY, &binary)],
        "the failed test is named above",
    )
}

/// The demonstration from the ELF file.
pub(super) fn demonstration(state: &State) -> anyhow::Result<()> {
    play(state, Design::Model, "simulator-demo")
}

/// The same on the FPGA's design; the pictures come from its VGA pins.
pub(super) fn demonstration_on_the_design(state: &State) -> anyhow::Result<()> {
    play(state, Design::Rtl, "simulator-demo-rtl")
}

/// Plays the session, and compares each picture with the golden one.
fn play(state: &State, design: Design, folder: &str) -> anyhow::Result<()> {
    let golden = Golden::read(golden::DEMO)?.with_context(|| format!("{} is missing", golden::DEMO))?;
    let parts = session::demo()?;
    let image = state.elf(Board::De1Soc)?;
    let simulator = Simulator::prepare(design, false, Build::Tested, &state.progress)?;
    let mut machine = Simulated::start(&simulator, &image, &state.folder(folder))?;
    let played = demo::play(&mut machine, &parts, &state.progress)?;
    golden
        .check(&Golden::from(&played.report))
        .with_context(|| format!("in the DE1-SoC's simulator ({design:?}), from {}", image.display()))
}
