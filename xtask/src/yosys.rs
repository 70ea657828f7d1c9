//! Yosys at work on the FPGA's design.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, bail};

use crate::paths::{target_folder, workspace_root};

/// Makes a folder under the target folder that has a copy of `rtl/`, for Yosys to work in.
///
/// Yosys comes as WebAssembly, which sees the system's temporary folder otherwise than this program does. So it is
/// only given paths below the folder that it works in.
///
/// # Errors
/// When something cannot be read or written.
pub fn folder_with_design(name: &str) -> anyhow::Result<PathBuf> {
    let folder = target_folder().join(name);
    let design = folder.join("rtl");
    if design.exists() {
        fs::remove_dir_all(&design).with_context(|| format!("cannot remove {}", design.display()))?;
    }
    copy_folder(&workspace_root().join("rtl"), &design)?;
    Ok(folder)
}

/// Runs a script in a folder, with its log in `NAME.log` there.
///
/// # Errors
/// When Yosys does not start, or fails, with the last that it said.
pub fn run_yosys(yosys: &Path, folder: &Path, name: &str, script: &str) -> anyhow::Result<()> {
    let log = format!("{name}.log");
    let output = Command::new(yosys)
        .current_dir(folder)
        .args(["-Q", "-q", "-l", &log, "-p", script])
        .output()
        .with_context(|| format!("cannot start {}", yosys.display()))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        let last = said.lines().last().unwrap_or("nothing said");
        bail!("Yosys failed on {name} ({last}): see {}", folder.join(log).display());
    }
    Ok(())
}

fn copy_folder(from: &Path, to: &Path) -> anyhow::Result<()> {
    fs::create_dir_all(to).with_context(|| format!("cannot make {}", to.display()))?;
    for entry in fs::read_dir(from).with_context(|| format!("cannot read {}", from.display()))? {
        let entry = entry?;
        let target = to.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            copy_folder(&entry.path(), &target)?;
        } else {
            fs::copy(entry.path(), &target).with_context(|| format!("cannot write {}", target.display()))?;
        }
    }
    Ok(())
}
