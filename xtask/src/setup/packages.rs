//! Tools from the machine's package manager.
//!
//! Only apt is run by us, and only where it needs no password; for the other managers the exact
//! command is told. A package list that is stale or was never fetched (a fresh container) is
//! fetched once, after a first attempt without it has failed.

use std::env;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::{Context, bail};

use super::lock::SetupLock;
use super::logged::Log;
use super::privilege::Privilege;
use crate::progress::{Progress, Step};

/// Longest time for one run of the package manager.
const INSTALL_LIMIT: Duration = Duration::from_secs(1_800);

/// What a tool's packages are called.
#[derive(Clone, Copy, Debug)]
pub struct Packages {
    /// Debian and Ubuntu.
    pub apt: &'static [&'static str],
    /// Fedora.
    pub dnf: &'static [&'static str],
    /// Arch Linux.
    pub pacman: &'static [&'static str],
    /// macOS with Homebrew.
    pub brew: &'static [&'static str],
}

impl Packages {
    /// Returns the command to type on each system, a line for each.
    pub fn instructions(&self) -> String {
        let commands = [
            ("Debian, Ubuntu", "sudo apt-get install --no-install-recommends", self.apt),
            ("Fedora", "sudo dnf install", self.dnf),
            ("Arch Linux", "sudo pacman -S", self.pacman),
            ("macOS", "brew install", self.brew),
        ];
        let lines = commands.iter().filter(|(_, _, packages)| !packages.is_empty());
        lines
            .map(|(system, command, packages)| format!("  {system:<16}{command} {}", packages.join(" ")))
            .collect::<Vec<_>>()
            .join("\n")
    }
}

/// Finds `program`, or installs its packages where that needs no question.
///
/// # Errors
///
/// When it is missing and cannot be installed; the error has the command to type.
pub fn ensure_tool(program: &str, packages: &Packages, progress: &Progress) -> anyhow::Result<PathBuf> {
    if let Some(path) = find_program(program) {
        return Ok(path);
    }
    let lock = SetupLock::take(progress)?;
    // Another process may have installed it while this one waited.
    if let Some(path) = find_program(program) {
        return Ok(path);
    }
    install_locked(program, packages, progress, &lock)?;
    find_program(program).with_context(|| {
        format!("`{program}` is not on PATH although its packages are installed\n{}", packages.instructions())
    })
}

/// Finds a file that packages bring at one of `paths`, or installs them where that needs no question.
///
/// # Errors
///
/// As [`ensure_tool`].
pub fn ensure_file(what: &str, paths: &[&str], packages: &Packages, progress: &Progress) -> anyhow::Result<PathBuf> {
    let find = || paths.iter().map(PathBuf::from).find(|path| path.is_file());
    if let Some(path) = find() {
        return Ok(path);
    }
    install(what, packages, progress)?;
    find().with_context(|| format!("{} is not there although its packages are installed", paths.join(" or ")))
}

/// Installs `packages`; `what` is how messages call them.
pub(super) fn install(what: &str, packages: &Packages, progress: &Progress) -> anyhow::Result<()> {
    let lock = SetupLock::take(progress)?;
    install_locked(what, packages, progress, &lock)
}

/// As [`install`], for one who holds the lock.
pub(super) fn install_locked(
    what: &str,
    packages: &Packages,
    progress: &Progress,
    _lock: &SetupLock,
) -> anyhow::Result<()> {
    let remedy = || format!("`{what}` is missing; install it and try again:\n{}", packages.instructions());
    if packages.apt.is_empty() || find_program("apt-get").is_none() {
        bail!(remedy());
    }
    let Some(privilege) = Privilege::detect() else {
        bail!("{}\n  (installing it without asking takes root or a sudo without password)", remedy());
    };
    let log = Log::new(&format!("apt-{}", packages.apt.join("-")))?;
    let step = progress.step(format!("installing {}", packages.apt.join(", ")));
    apt_install(privilege, packages.apt, &log, &step).with_context(remedy)?;
    step.done();
    Ok(())
}

fn apt_install(privilege: Privilege, packages: &[&str], log: &Log, step: &Step) -> anyhow::Result<()> {
    let apt_get = |words: &[&str]| {
        let mut command = privilege.command("apt-get");
        command.args(["-o", "DPkg::Lock::Timeout=120", "-o", "Acquire::Retries=3"]).args(words);
        log.run(command, step, INSTALL_LIMIT)
    };
    let install = [&["install", "--yes", "--no-install-recommends"], packages].concat();
    if apt_get(&install).is_ok() {
        return Ok(());
    }
    apt_get(&["update"])?;
    apt_get(&install)
}

/// Returns where `program` lies on `PATH`.
pub fn find_program(program: &str) -> Option<PathBuf> {
    let path = env::var_os("PATH")?;
    env::split_paths(&path).map(|folder| folder.join(program)).find(|file| is_executable(file))
}

fn is_executable(file: &Path) -> bool {
    file.metadata().is_ok_and(|data| data.is_file() && data.permissions().mode() & 0o111 != 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOTHING: Packages = Packages { apt: &[], dnf: &["a-dnf"], pacman: &["a-pacman", "b"], brew: &["a-brew"] };

    #[test]
    fn a_program_on_the_path_is_found() {
        assert!(find_program("sh").is_some_and(|path| path.is_absolute()));
        assert_eq!(find_program("no-such-program-of-halfspace"), None);
        assert!(ensure_tool("sh", &NOTHING, &Progress::quiet()).is_ok());
    }

    #[test]
    fn what_cannot_be_installed_is_told_with_every_command() {
        let error =
            ensure_tool("no-such-program-of-halfspace", &NOTHING, &Progress::quiet()).expect_err("it does not exist");
        let expected = "`no-such-program-of-halfspace` is missing; install it and try again:
  Fedora          sudo dnf install a-dnf
  Arch Linux      sudo pacman -S a-pacman b
  macOS           brew install a-brew";
        assert_eq!(error.to_string(), expected);
    }
}
