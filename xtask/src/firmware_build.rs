//! Builds a board's firmware with the toolchain that the set-up found.

use std::path::PathBuf;
use std::process::Command;

use anyhow::ensure;

use crate::cargo_build;
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
    cargo_build::run(command(board, features, toolchain), &format!("the firmware for {board}"), &step)?;
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
        .arg(target_folder());
    if cfg!(unix) {
        cargo.env("RUSTC_WORKSPACE_WRAPPER", paths::workspace_root().join("firmware/rustc-thumb"));
    }
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
