//! From nothing to a firmware that runs: toolchain, QEMU, build, start.

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};

use crate::cli::Board;
use crate::firmware_build::build_firmware;
use crate::log_decoder::LogDecoder;
use crate::machine::Emulated;
use crate::progress::Progress;
use crate::qemu::{ICOUNT_SHIFT, Qemu, QemuOptions};
use crate::setup::{ensure_firmware_toolchain, ensure_qemu};

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
    /// When the board cannot run here, something is missing and cannot be installed, or the
    /// firmware does not build.
    pub fn prepare(board: Board, progress: &Progress) -> anyhow::Result<Self> {
        check_runs(board)?;
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
        self.start_with(folder, |options| options.icount_shift = Some(ICOUNT_SHIFT))
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

/// Says clearly when a board cannot run yet.
///
/// # Errors
/// For a board without an emulator.
pub fn check_runs(board: Board) -> anyhow::Result<()> {
    if board.runs_in_qemu() {
        return Ok(());
    }
    bail!("the firmware for {board} builds, but nothing here can run it yet: use `--board {}`", Board::VexpressA9)
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
