//! The Rust target of the Cortex-A9, by the first of four ways that works:
//!
//! 1. the active toolchain has it;
//! 2. `rustup target add` can download it;
//! 3. Debian's compiler, with `core` built from its source package (see `debian_rust`);
//! 4. nothing: what to do is told.
//!
//! A toolchain "has it" when it compiles and links an empty program for it. That takes 0.1 s, and
//! also finds libraries that an upgrade of the compiler has made useless, and a missing linker.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

use anyhow::{Context, bail};

use super::debian_rust::{self, DEBIAN_CARGO, DEBIAN_RUSTC};
use super::lock::SetupLock;
use super::logged::Log;
use super::packages::find_program;
use crate::paths::TemporaryFolder;
use crate::progress::Progress;

/// The target triple of the firmware.
pub const TARGET: &str = "armv7a-none-eabihf";

/// Longest time for rustup's download (about 30 MB); a network that swallows packets ends here.
const DOWNLOAD_LIMIT: Duration = Duration::from_secs(300);

const EMPTY_PROGRAM: &str = "\
#![no_std]
#![no_main]
extern crate alloc;
struct NoMemory;
unsafe impl alloc::alloc::GlobalAlloc for NoMemory {
    unsafe fn alloc(&self, _: core::alloc::Layout) -> *mut u8 { core::ptr::null_mut() }
    unsafe fn dealloc(&self, _: *mut u8, _: core::alloc::Layout) {}
}
#[global_allocator]
static NO_MEMORY: NoMemory = NoMemory;
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! { loop {} }
";

/// How to run cargo so that it builds for [`TARGET`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FirmwareToolchain {
    /// The cargo to start.
    pub cargo: PathBuf,
    /// Environment variables it needs.
    pub environment: Vec<(String, String)>,
    /// The compiler that belongs to it.
    rustc: PathBuf,
}

impl FirmwareToolchain {
    /// The toolchain that runs this program.
    fn active() -> Self {
        Self { cargo: "cargo".into(), environment: Vec::new(), rustc: "rustc".into() }
    }

    /// Debian's, by its name in rustup or, where there is no rustup, by its path.
    pub(super) fn debian() -> Self {
        if find_program("rustup").is_some() {
            let environment = vec![("RUSTUP_TOOLCHAIN".into(), debian_rust::RUSTUP_NAME.into())];
            return Self { environment, ..Self::active() };
        }
        let environment = vec![("RUSTC".into(), DEBIAN_RUSTC.into())];
        Self { cargo: DEBIAN_CARGO.into(), environment, rustc: DEBIAN_RUSTC.into() }
    }

    /// Returns a cargo command with the environment set.
    pub fn cargo(&self) -> Command {
        self.command(&self.cargo)
    }

    fn command(&self, program: &Path) -> Command {
        let mut command = Command::new(program);
        // With RUSTC_BOOTSTRAP some build scripts take the compiler for a nightly one. Cargo's own
        // choice of a compiler for xtask must not reach the firmware's build either.
        command.env_remove("RUSTC_BOOTSTRAP").env_remove("RUSTC").env("RUSTUP_AUTO_INSTALL", "0");
        command.envs(self.environment.iter().map(|(name, value)| (name, value)));
        command
    }

    /// Builds an empty program for the target.
    ///
    /// # Errors
    ///
    /// The compiler's words when it cannot.
    pub(super) fn check(&self) -> anyhow::Result<()> {
        let folder = TemporaryFolder::new().context("cannot make a temporary folder")?;
        let source = folder.path().join("empty.rs");
        fs::write(&source, EMPTY_PROGRAM).with_context(|| format!("cannot write {}", source.display()))?;
        let mut command = self.command(&self.rustc);
        command
            .args(["--edition=2021", "--target", TARGET, "-Cpanic=abort", "-o"])
            .arg(folder.path().join("empty"))
            .arg(&source);
        let output =
            command.stdin(Stdio::null()).output().with_context(|| format!("cannot start {}", self.rustc.display()))?;
        if !output.status.success() {
            let text = String::from_utf8_lossy(&output.stderr);
            let reason = text.lines().find(|line| line.starts_with("error")).unwrap_or("it gave no reason");
            bail!("the compiler cannot build for {TARGET}: {reason}");
        }
        Ok(())
    }
}

/// Finds a toolchain that builds for [`TARGET`], or makes one.
///
/// # Errors
///
/// When no way works; the error says what each lacked and what to type.
pub fn ensure_firmware_toolchain(progress: &Progress) -> anyhow::Result<FirmwareToolchain> {
    if let Some(toolchain) = ready() {
        return Ok(toolchain);
    }
    let lock = SetupLock::take(progress)?;
    // Another process may have done all while this one waited.
    if let Some(toolchain) = ready() {
        return Ok(toolchain);
    }
    let by_rustup = match add_by_rustup(progress) {
        Ok(toolchain) => return Ok(toolchain),
        Err(error) => error,
    };
    let by_debian = match debian_rust::install(progress, &lock) {
        Ok(toolchain) => return Ok(toolchain),
        Err(error) => error,
    };
    bail!(
        "no Rust toolchain for {TARGET}, the processor of the board.\n\
         rustup: {by_rustup:#}\n\
         Debian's packages: {by_debian:#}\n\
         To have it, type one of:\n  \
         rustup target add {TARGET}\n  \
         sudo apt-get install {}   (Debian 12; then run this again as root)",
        debian_rust::PACKAGES.join(" ")
    )
}

/// Returns a toolchain that has the target already.
fn ready() -> Option<FirmwareToolchain> {
    let active = FirmwareToolchain::active();
    if active.check().is_ok() {
        return Some(active);
    }
    let debian = FirmwareToolchain::debian();
    (Path::new(DEBIAN_RUSTC).exists() && debian.check().is_ok()).then_some(debian)
}

fn add_by_rustup(progress: &Progress) -> anyhow::Result<FirmwareToolchain> {
    if find_program("rustup").is_none() {
        bail!("it is not installed");
    }
    let step = progress.step(format!("downloading the Rust target {TARGET} with rustup"));
    let mut command = Command::new("rustup");
    command.args(["target", "add", TARGET]).env("RUST_BACKTRACE", "0");
    if let Err(error) = Log::new("rustup")?.run(command, &step, DOWNLOAD_LIMIT) {
        step.end_without("it cannot be downloaded here");
        return Err(error);
    }
    let active = FirmwareToolchain::active();
    active.check()?;
    step.done();
    Ok(active)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn debian_s_toolchain_is_named_by_one_variable() {
        let toolchain = FirmwareToolchain::debian();
        let names: Vec<&str> = toolchain.environment.iter().map(|(name, _)| name.as_str()).collect();
        assert!(names == ["RUSTUP_TOOLCHAIN"] || names == ["RUSTC"], "{names:?}");
        let command = toolchain.cargo();
        assert!(command.get_envs().any(|(name, value)| name == "RUSTC_BOOTSTRAP" && value.is_none()));
    }

    #[test]
    fn a_compiler_that_cannot_is_told_from_one_that_is_missing() {
        let missing = FirmwareToolchain { rustc: "no-such-rustc".into(), ..FirmwareToolchain::active() };
        assert!(missing.check().expect_err("missing").to_string().contains("cannot start no-such-rustc"));
        let unable = FirmwareToolchain { rustc: "false".into(), ..FirmwareToolchain::active() };
        assert!(unable.check().expect_err("unable").to_string().contains("it gave no reason"));
    }
}
