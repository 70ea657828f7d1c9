//! Builds a board's firmware with the toolchain that the set-up found.

use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::{Command, Stdio};

use anyhow::{Context, bail, ensure};

use crate::cli::Board;
use crate::paths;
use crate::progress::Progress;
use crate::setup::{FirmwareToolchain, TARGET};

/// Builds the firmware for `board`, with more of its features if wanted, and returns its ELF file.
///
/// The next build for the board writes the same file.
///
/// It has a target folder of its own, `target/firmware`: the host's build uses another compiler
/// at times, and each would throw away what the other built.
///
/// # Errors
///
/// When cargo fails, with all that it said.
pub fn build_firmware(
    board: Board,
    features: &[&str],
    toolchain: &FirmwareToolchain,
    progress: &Progress,
) -> anyhow::Result<PathBuf> {
    let with = if features.is_empty() { String::new() } else { format!(" with {}", features.join(", ")) };
    let step = progress.step(format!("building the firmware for {board}{with}"));
    let mut cargo = command(board, features, toolchain);
    let mut child =
        cargo.spawn().with_context(|| format!("cannot start {}: is Rust installed?", toolchain.cargo.display()))?;
    let mut said = String::new();
    if let Some(output) = child.stderr.take() {
        for line in BufReader::new(output).split(b'\n') {
            let line = line.context("cannot read what cargo says")?;
            let line = String::from_utf8_lossy(&line);
            step.update(line.trim());
            said.push_str(&line);
            said.push('\n');
        }
    }
    let status = child.wait().context("cannot wait for cargo")?;
    if !status.success() {
        bail!("the firmware for {board} does not build ({status}); cargo says:\n{said}");
    }
    let elf = elf_path(board);
    ensure!(elf.is_file(), "cargo built the firmware, but {} is not there", elf.display());
    step.done();
    Ok(elf)
}

fn command(board: Board, features: &[&str], toolchain: &FirmwareToolchain) -> Command {
    let mut cargo = toolchain.cargo();
    cargo
        .current_dir(paths::workspace_root())
        .args(["build", "--release", "--package", "firmware", "--bin", board.name(), "--features"])
        .arg([&[board.name()], features].concat().join(","))
        .args(["--target", TARGET, "--target-dir"])
        .arg(target_folder())
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    cargo
}

/// Returns where [`build_firmware`] leaves a board's ELF file.
pub fn elf_path(board: Board) -> PathBuf {
    target_folder().join(TARGET).join("release").join(board.name())
}

fn target_folder() -> PathBuf {
    paths::target_folder().join("firmware")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::setup::ensure_firmware_toolchain;

    #[test]
    #[ignore = "needs the Rust target of the board"]
    fn the_firmware_builds() {
        let progress = Progress::new();
        let toolchain = ensure_firmware_toolchain(&progress).expect("the target is there");
        for board in Board::ALL {
            let elf = build_firmware(board, &[], &toolchain, &progress).expect("the firmware builds");
            assert!(std::fs::read(elf).expect("it is there").starts_with(b"\x7fELF"));
        }
    }
}
