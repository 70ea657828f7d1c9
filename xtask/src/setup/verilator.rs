//! Verilator, the C++ compiler that its output wants, and the library that its waves want.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, bail, ensure};

use super::headers::has_header;
use super::packages::{self, Packages, ensure_tool};
use crate::progress::Progress;

const VERILATOR: Packages =
    Packages { apt: &["verilator"], dnf: &["verilator"], pacman: &["verilator"], brew: &["verilator"] };
/// What the build calls; Debian's Verilator does not bring it.
const COMPILER: &str = "c++";
const COMPILERS: Packages = Packages { apt: &["g++"], dnf: &["gcc-c++"], pacman: &["gcc"], brew: &["gcc"] };
const ZLIB: Packages =
    Packages { apt: &["zlib1g-dev"], dnf: &["zlib-ng-compat-devel"], pacman: &["zlib"], brew: &["zlib"] };
/// Oldest that the design is built with.
const OLDEST: [u32; 2] = [5, 6];

/// Finds Verilator and a C++ compiler, or installs them; returns where Verilator is.
///
/// # Errors
///
/// When one is missing and cannot be installed without asking, with the command to type; and when
/// Verilator is too old.
pub fn ensure_verilator(progress: &Progress) -> anyhow::Result<PathBuf> {
    let program = ensure_tool("verilator", &VERILATOR, progress)?;
    ensure_tool(COMPILER, &COMPILERS, progress)?;
    let output = Command::new(&program)
        .arg("--version")
        .output()
        .with_context(|| format!("cannot start {}: install it again", program.display()))?;
    check_version(&program, &String::from_utf8_lossy(&output.stdout))?;
    Ok(program)
}

fn check_version(program: &Path, text: &str) -> anyhow::Result<()> {
    let [major, minor] = OLDEST;
    let version = version(text).with_context(|| format!("{} tells no version: `{text}`", program.display()))?;
    ensure!(
        version >= OLDEST,
        "{} is version {}.{:03}, too old: {major}.{minor:03} or newer is needed (Debian 12 has it)",
        program.display(),
        version[0],
        version[1]
    );
    Ok(())
}

/// Reads `Verilator 5.006 2023-01-22 rev (Debian 5.006-3)`.
fn version(text: &str) -> Option<[u32; 2]> {
    let (major, minor) = text.strip_prefix("Verilator ")?.split_whitespace().next()?.split_once('.')?;
    Some([major.parse().ok()?, minor.parse().ok()?])
}

/// Finds the library that waves are packed with, or installs it.
///
/// # Errors
///
/// As [`ensure_verilator`].
pub fn ensure_wave_library(progress: &Progress) -> anyhow::Result<()> {
    if has_header(COMPILER, "c++", "zlib.h")? {
        return Ok(());
    }
    packages::install("zlib.h", &ZLIB, progress)?;
    if !has_header(COMPILER, "c++", "zlib.h")? {
        bail!("`{COMPILER}` finds no zlib.h although its packages are installed\n{}", ZLIB.instructions());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_compared_by_number() {
        let check = |text: &str| check_version(Path::new("verilator"), text).map_err(|error| error.to_string());
        assert_eq!(check("Verilator 5.006 2023-01-22 rev (Debian 5.006-3)\n"), Ok(()));
        assert_eq!(check("Verilator 5.032 devel rev v5.032"), Ok(()));
        assert_eq!(check("Verilator 10.000 2030"), Ok(()));
        let old = check("Verilator 4.038 2020-07-11 rev v4.036").expect_err("too old");
        assert!(old.starts_with("verilator is version 4.038, too old: 5.006 or newer"), "{old}");
        assert!(check("Icarus 5.1").expect_err("another program").contains("tells no version"));
    }
}
