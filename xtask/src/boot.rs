//! From nothing to a firmware that runs: toolchain, QEMU or the DE1-SoC's simulator, build, start.

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, ensure};

use crate::cli::Board;
use crate::firmware_build::build_firmware;
use crate::log_decoder::LogDecoder;
use crate::machine::{Emulated, Machine, Simulated};
use crate::progress::Progress;
use crate::qemu::{ICOUNT_SHIFT, Qemu, QemuOptions};
use crate::setup::{ensure_firmware_toolchain, ensure_qemu};
use crate::simulated::{Build, Design, Simulator};

/// Builds the firmware for a board and starts it, so that every run is the same: in QEMU, or the DE1-SoC's in its
/// simulator with `design` as its FPGA; with a mesh file in its memory, if there is one. What it says goes to `folder`.
///
/// # Errors
/// When something is missing and cannot be installed, a build fails, or the firmware does not start.
pub fn start(
    board: Board,
    design: Design,
    mesh: Option<PathBuf>,
    folder: &Path,
    progress: &Progress,
) -> anyhow::Result<Box<dyn Machine>> {
    if board.runs_in_qemu() {
        let bootable = Bootable::prepare(board, progress)?;
        let step = progress.step(format!("booting {board} in QEMU"));
        let machine = bootable.start_with_mesh(folder, mesh)?;
        step.done();
        return Ok(Box::new(machine));
    }
    let (simulator, elf) = simulator(board, design, false, progress)?;
    let step = progress.step(format!("booting {board} in its simulator"));
    let machine = Simulated::start(&simulator.with_mesh(mesh), &elf, folder)?;
    step.done();
    Ok(Box::new(machine))
}

/// Builds the DE1-SoC's simulator, for a window if it shall open one, and the firmware.
///
/// # Errors
/// When something is missing and cannot be installed, or a build fails.
pub fn simulator(
    board: Board,
    design: Design,
    window: bool,
    progress: &Progress,
) -> anyhow::Result<(Simulator, PathBuf)> {
    let toolchain = ensure_firmware_toolchain(progress)?;
    let simulator = Simulator::prepare(design, window, Build::Checked, progress)?;
    Ok((simulator, build_firmware(board, &[], &toolchain, progress)?))
}

/// A firmware that is built, and a QEMU to run it in.
#[derive(Debug, Clone)]
pub struct Bootable {
    /// The board.
    pub board: Board,
    /// The firmware for it.
    pub elf: PathBuf,
    /// QEMU's program.
    pub qemu: PathBuf,
}

impl Bootable {
    /// Makes sure of toolchain and QEMU, and builds the firmware.
    ///
    /// # Errors
    /// When QEMU does not have the board, something is missing and cannot be installed, or the
    /// firmware does not build.
    pub fn prepare(board: Board, progress: &Progress) -> anyhow::Result<Self> {
        ensure!(board.runs_in_qemu(), "QEMU has no {board}: it runs in its simulator");
        let toolchain = ensure_firmware_toolchain(progress)?;
        let qemu = ensure_qemu(progress)?;
        Ok(Self { board, elf: build_firmware(board, &[], &toolchain, progress)?, qemu })
    }

    /// Starts the firmware so that every run is the same: an instruction takes a fixed time.
    ///
    /// What it says goes to `console.txt` and, on a board that logs, to `log.txt` in `folder`.
    ///
    /// # Errors
    /// When QEMU or the firmware does not start.
    pub fn start(&self, folder: &Path) -> anyhow::Result<Emulated> {
        self.start_with_mesh(folder, None)
    }

    /// Does the same with a mesh file in memory, if there is one.
    ///
    /// # Errors
    /// As [`start`](Self::start).
    pub fn start_with_mesh(&self, folder: &Path, mesh: Option<PathBuf>) -> anyhow::Result<Emulated> {
        self.start_with(folder, |options| {
            options.icount_shift = Some(ICOUNT_SHIFT);
            options.mesh = mesh;
        })
    }

    /// Starts the firmware on the wall clock, with other options where `change` wants them.
    ///
    /// # Errors
    /// As [`start`](Self::start).
    pub fn start_with(&self, folder: &Path, change: impl FnOnce(&mut QemuOptions)) -> anyhow::Result<Emulated> {
        fs::create_dir_all(folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
        let mut options = QemuOptions::new(&self.qemu, self.board, &self.elf);
        options.console_file = Some(folder.join("console.txt"));
        change(&mut options);
        let (mut qemu, log) = start_with_log(&options, folder)?;
        qemu.resume()?;
        Emulated::new(qemu, log)
    }
}

/// Starts QEMU, still paused, with its defmt log decoded to `log.txt` in `folder`.
///
/// # Errors
/// When QEMU does not start, the file cannot be written, or the firmware's log cannot be read.
pub fn start_with_log(options: &QemuOptions, folder: &Path) -> anyhow::Result<(Qemu, Option<LogDecoder>)> {
    let mut qemu = Qemu::start(options)?;
    let Some(stream) = qemu.take_log() else { return Ok((qemu, None)) };
    let path = folder.join("log.txt");
    let mut file = File::create(&path).with_context(|| format!("cannot write {}", path.display()))?;
    let decoder = LogDecoder::start(&options.elf, stream, move |line| {
        // A full disk must not stop the firmware.
        let _ = writeln!(file, "{line}");
    })?;
    Ok((qemu, Some(decoder)))
}
