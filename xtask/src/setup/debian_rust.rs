//! Debian's Rust compiler for machines where rustup cannot download.
//!
//! Debian has the compiler and the source of the libraries, but not the libraries for the
//! Cortex-A9: `core`, `alloc` and `compiler_builtins` are built from the source once and put where
//! that compiler looks. Projects then need no unstable flag. The linker, `rust-lld`, comes from the
//! rustup toolchain, which has it for every target, or from Debian's package `lld`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use anyhow::{Context, bail, ensure};

use super::lock::SetupLock;
use super::logged::Log;
use super::packages::{Packages, find_program, install_locked};
use super::privilege::Privilege;
use super::rust_target::{FirmwareToolchain, TARGET};
use crate::paths::TemporaryFolder;
use crate::progress::{Progress, Step};

/// The packages: compiler, cargo, source of the libraries.
pub(super) const PACKAGES: &[&str] = &["rustc-web", "cargo-web", "rust-web-src"];
/// What rustup calls Debian's toolchain.
pub(super) const RUSTUP_NAME: &str = "debian";
pub(super) const DEBIAN_CARGO: &str = "/usr/bin/cargo";
pub(super) const DEBIAN_RUSTC: &str = "/usr/bin/rustc";

const RUSTLIB: &str = "/usr/lib/rustlib";
const LIBRARIES: [&str; 3] = ["core", "alloc", "compiler_builtins"];
const BUILD_LIMIT: Duration = Duration::from_secs(900);

/// Installs the packages, builds the libraries, and returns the toolchain they make.
pub(super) fn install(progress: &Progress, lock: &SetupLock) -> anyhow::Result<FirmwareToolchain> {
    ensure!(find_program("apt-get").is_some(), "this system has no apt-get");
    let privilege = Privilege::detect().context("they take root or a sudo without password")?;
    if !compiler_is_there() {
        let packages = Packages { apt: PACKAGES, dnf: &[], pacman: &[], brew: &[] };
        install_locked("Debian's Rust compiler", &packages, progress, lock)?;
        ensure!(
            compiler_is_there(),
            "{DEBIAN_RUSTC} is older than {} or its library source is missing",
            env!("CARGO_PKG_RUST_VERSION")
        );
    }
    let linker = find_linker(progress, lock)?;
    let log = Log::new("debian-rust")?;
    let step = progress.step(format!("building core and alloc for {TARGET} with Debian's compiler"));
    link_linker(privilege, &linker, &log, &step)?;
    let folder = TemporaryFolder::new().context("cannot make a temporary folder")?;
    let libraries = build_libraries(folder.path(), &log, &step)?;
    install_libraries(privilege, &libraries, &log, &step)?;
    if find_program("rustup").is_some() {
        let mut link = Command::new("rustup");
        link.args(["toolchain", "link", RUSTUP_NAME, "/usr"]);
        log.run(link, &step, BUILD_LIMIT)?;
    }
    let toolchain = FirmwareToolchain::debian();
    toolchain.check()?;
    step.done();
    Ok(toolchain)
}

/// Whether compiler, cargo and library source are there, and new enough for this workspace.
fn compiler_is_there() -> bool {
    let source = Path::new(RUSTLIB).join("src/rust/library/core");
    let new_enough =
        debian_rustc("release").is_some_and(|release| version(&release) >= version(env!("CARGO_PKG_RUST_VERSION")));
    new_enough && Path::new(DEBIAN_CARGO).exists() && source.exists()
}

/// Returns a line of `rustc -vV` of Debian's compiler.
fn debian_rustc(line_name: &str) -> Option<String> {
    line_of(&verbose_version(Path::new(DEBIAN_RUSTC))?, line_name)
}

fn verbose_version(rustc: &Path) -> Option<String> {
    let output = Command::new(rustc).arg("-vV").output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}

fn line_of(text: &str, line_name: &str) -> Option<String> {
    let line = text.lines().find_map(|line| line.strip_prefix(line_name)?.strip_prefix(": "))?;
    Some(line.to_string())
}

/// Returns a version's first two numbers, enough to tell Rust releases apart.
fn version(text: &str) -> Option<(u32, u32)> {
    let mut numbers = text.split('.');
    Some((numbers.next()?.parse().ok()?, numbers.next()?.parse().ok()?))
}

/// Returns the linker to use: the rustup toolchain's, or Debian's.
fn find_linker(progress: &Progress, lock: &SetupLock) -> anyhow::Result<PathBuf> {
    if let Some(linker) = rustup_linker() {
        return Ok(linker);
    }
    if find_program("lld").is_none() {
        let packages = Packages { apt: &["lld"], dnf: &[], pacman: &[], brew: &[] };
        install_locked("the linker lld", &packages, progress, lock)?;
    }
    find_program("lld").context("the package lld has brought no `lld`")
}

/// Returns the `rust-lld` of the active toolchain, if that is not Debian's.
fn rustup_linker() -> Option<PathBuf> {
    let rustc = Path::new("rustc");
    let host = line_of(&verbose_version(rustc)?, "host")?;
    let output = Command::new(rustc).args(["--print", "sysroot"]).output().ok()?;
    let sysroot = PathBuf::from(str::from_utf8(&output.stdout).ok()?.trim());
    let linker = sysroot.join("lib/rustlib").join(host).join("bin/rust-lld");
    (sysroot != Path::new("/usr") && linker.is_file()).then_some(linker)
}

/// Puts a link to the linker where Debian's compiler looks for it, unless one is there.
fn link_linker(privilege: Privilege, linker: &Path, log: &Log, step: &Step) -> anyhow::Result<()> {
    let host = debian_rustc("host").with_context(|| format!("{DEBIAN_RUSTC} does not tell its host"))?;
    let folder = Path::new(RUSTLIB).join(host).join("bin");
    let link = folder.join("rust-lld");
    if link.is_file() {
        return Ok(());
    }
    let mut make_folder = privilege.command("mkdir");
    make_folder.arg("-p").arg(&folder);
    log.run(make_folder, step, BUILD_LIMIT)?;
    let mut make_link = privilege.command("ln");
    make_link.arg("-sfn").args([linker, &link]);
    log.run(make_link, step, BUILD_LIMIT)
}

/// Builds the libraries in `folder`, as what an empty crate depends on, and returns their files.
fn build_libraries(folder: &Path, log: &Log, step: &Step) -> anyhow::Result<Vec<PathBuf>> {
    let manifest = "[package]\nname = \"empty\"\nversion = \"0.0.0\"\nedition = \"2021\"\n\n[lib]\npath = \"lib.rs\"\n\n[workspace]\n";
    fs::write(folder.join("Cargo.toml"), manifest).context("cannot write the empty crate")?;
    fs::write(folder.join("lib.rs"), "#![no_std]\n").context("cannot write the empty crate")?;
    let mut build = Command::new(DEBIAN_CARGO);
    build
        .current_dir(folder)
        .args(["build", "--release", "-Zbuild-std=core,alloc", "--target", TARGET, "--target-dir"])
        .arg(folder.join("target"));
    // Keeps the flags of whoever runs this program out of the libraries.
    build.env("CARGO_ENCODED_RUSTFLAGS", "");
    build.env("RUSTC_BOOTSTRAP", "1").env("RUSTC", DEBIAN_RUSTC).env_remove("RUSTUP_TOOLCHAIN");
    log.run(build, step, BUILD_LIMIT)?;
    let built = folder.join("target").join(TARGET).join("release/deps");
    let files = LIBRARIES.iter().map(|library| {
        let found = library_files(&built, library)?;
        match found.as_slice() {
            [file] => Ok(file.clone()),
            _ => bail!("{} files lib{library}-*.rlib in {} instead of one", found.len(), built.display()),
        }
    });
    files.collect()
}

/// Copies the libraries to where Debian's compiler looks, in place of older ones.
fn install_libraries(privilege: Privilege, libraries: &[PathBuf], log: &Log, step: &Step) -> anyhow::Result<()> {
    let folder = Path::new(RUSTLIB).join(TARGET).join("lib");
    for library in LIBRARIES {
        // Two of one name would make the compiler refuse both.
        for old in library_files(&folder, library).unwrap_or_default() {
            let mut remove = privilege.command("rm");
            remove.arg("-f").arg(old);
            log.run(remove, step, BUILD_LIMIT)?;
        }
    }
    let mut copy = privilege.command("install");
    copy.args(["-D", "-m", "644", "-t"]).arg(&folder).args(libraries);
    log.run(copy, step, BUILD_LIMIT)
}

/// Returns the files `lib<library>-<hash>.rlib` in `folder`.
pub(super) fn library_files(folder: &Path, library: &str) -> anyhow::Result<Vec<PathBuf>> {
    let prefix = format!("lib{library}-");
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).with_context(|| format!("cannot list {}", folder.display()))? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if name.starts_with(&prefix) && name.ends_with(".rlib") {
            files.push(path);
        }
    }
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_compare_by_number() {
        assert!(version("1.96.0") > version("1.95"));
        assert!(version("1.100.0-nightly") > version("1.99.9"));
        assert!(version("1.63.0") < version("1.95"));
        assert_eq!(version("unknown"), None);
    }

    #[test]
    fn a_line_of_the_version_is_found() {
        let text = "rustc 1.96.0\nbinary: rustc\nhost: x86_64-unknown-linux-gnu\nrelease: 1.96.0\n";
        assert_eq!(line_of(text, "host").as_deref(), Some("x86_64-unknown-linux-gnu"));
        assert_eq!(line_of(text, "release").as_deref(), Some("1.96.0"));
        assert_eq!(line_of(text, "LLVM version"), None);
    }

    #[test]
    fn library_files_are_told_from_their_neighbours() {
        let folder = TemporaryFolder::new().expect("folders can be made");
        for name in ["libcore-1.rlib", "libcore-1.rmeta", "libcore_detect-1.rlib", "liballoc-2.rlib"] {
            fs::write(folder.path().join(name), []).expect("the folder takes files");
        }
        assert_eq!(library_files(folder.path(), "core").expect("it is there"), [folder.path().join("libcore-1.rlib")]);
        assert!(library_files(&folder.path().join("none"), "core").is_err());
    }
}
