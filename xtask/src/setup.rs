//! Makes this machine able to build and run the firmware: finds what is needed, and installs what
//! is missing where that takes no question. Where all is there it says nothing and costs a tenth
//! of a second.
//!
//! | needed | how it is had |
//! | --- | --- |
//! | the Rust target | see [`rust_target`]: rustup, or Debian's packages and a build of `core` |
//! | Yosys, Bitwuzla | see [`python`]: a Python environment each, under the target folder |
//! | U-Boot | see [`uboot`]: built from Debian's source package under the target folder |
//! | QEMU, Verilator, a C++ compiler | see [`packages`]: apt as root or by `sudo -n`, else the command to type is told |
//!
//! Output of installers goes to `target/setup/*.log`; its end is shown when one fails. A lock
//! file there lets a second `cargo xtask` wait until the first has done.

mod debian_rust;
mod headers;
mod lock;
mod logged;
pub mod packages;
mod privilege;
mod python;
pub mod rust_target;
mod source_package;
mod uboot;
mod verilator;

use std::env;
use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, bail};

pub use packages::{Packages, ensure_file, ensure_tool, find_program};
pub use python::{ensure_bitwuzla, ensure_yosys};
pub use rust_target::{FirmwareToolchain, TARGET, ensure_firmware_toolchain};
pub use uboot::{BuiltUBoot, ensure_uboot};
pub use verilator::{ensure_verilator, ensure_wave_library};

use crate::progress::Progress;
use crate::qemu::Display;

const QEMU_PROGRAM: &str = "qemu-system-arm";
const QEMU_PACKAGES: Packages =
    Packages { apt: &["qemu-system-arm"], dnf: &["qemu-system-arm"], pacman: &["qemu-system-arm"], brew: &["qemu"] };
/// Debian keeps QEMU's windows in a package of their own.
const QEMU_WINDOW_PACKAGES: Packages =
    Packages { apt: &["qemu-system-gui"], dnf: &["qemu-ui-gtk"], pacman: &["qemu-ui-gtk"], brew: &["qemu"] };

/// Finds QEMU for ARM, or installs it.
///
/// # Errors
///
/// When it is missing and cannot be installed without asking; the error has the command to type.
pub fn ensure_qemu(progress: &Progress) -> anyhow::Result<PathBuf> {
    ensure_tool(QEMU_PROGRAM, &QEMU_PACKAGES, progress)
}

/// Finds QEMU with a window it can open here, or installs that.
///
/// # Errors
///
/// As [`ensure_qemu`], and when this computer has no screen to open a window on.
pub fn ensure_qemu_window(progress: &Progress) -> anyhow::Result<(PathBuf, Display)> {
    let has_screen =
        ["DISPLAY", "WAYLAND_DISPLAY"].iter().any(|name| env::var_os(name).is_some_and(|value| !value.is_empty()));
    if !cfg!(target_os = "macos") && !has_screen {
        bail!(
            "there is no screen for a window (DISPLAY and WAYLAND_DISPLAY are not set): use `cargo xtask run --headless --frames 60 --output target/run`"
        );
    }
    let qemu = ensure_qemu(progress)?;
    if let Some(display) = window_of(&qemu)? {
        return Ok((qemu, display));
    }
    packages::install("QEMU's window", &QEMU_WINDOW_PACKAGES, progress)?;
    match window_of(&qemu)? {
        Some(display) => Ok((qemu, display)),
        None => bail!(
            "{} still offers no window (gtk, sdl or cocoa)\n{}",
            qemu.display(),
            QEMU_WINDOW_PACKAGES.instructions()
        ),
    }
}

/// Asks QEMU which kinds of window it has.
fn window_of(qemu: &PathBuf) -> anyhow::Result<Option<Display>> {
    let output = Command::new(qemu)
        .args(["-display", "help"])
        .output()
        .with_context(|| format!("cannot start {}: install it again", qemu.display()))?;
    let text = String::from_utf8_lossy(&output.stdout);
    let offered = |display: &Display| text.lines().any(|line| line.trim() == display.name());
    Ok([Display::Cocoa, Display::Gtk, Display::Sdl].into_iter().find(offered))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::{Duration, Instant};

    /// Run on a machine that has nothing, twice: the first time installs, the second only looks.
    #[test]
    #[ignore = "installs what is missing on this machine"]
    fn a_fresh_machine_becomes_able() {
        let progress = Progress::new();
        for attempt in ["first", "second"] {
            let started = Instant::now();
            let toolchain = ensure_firmware_toolchain(&progress).expect("the target can be had");
            let target_time = started.elapsed();
            let qemu = ensure_qemu(&progress).expect("QEMU can be had");
            eprintln!("{attempt}: {toolchain:?} in {target_time:.2?}, {} in {:.2?}", qemu.display(), started.elapsed());
        }
        let started = Instant::now();
        ensure_firmware_toolchain(&progress).expect("the target is there");
        ensure_qemu(&progress).expect("QEMU is there");
        assert!(started.elapsed() < Duration::from_secs(1), "{:?}", started.elapsed());
    }
}
