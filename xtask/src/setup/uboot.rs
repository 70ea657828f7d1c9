//! U-Boot for the DE1-SoC, built from Debian's source package under the target folder.
//!
//! U-Boot has the board: what Halfspace adds to its configuration is [`SETTINGS`]. Without them it
//! stops at its prompt, and would take what was saved on the card before for its settings. The
//! build takes two minutes of one core; later calls find what it left.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread;
use std::time::Duration;

use anyhow::{Context, bail, ensure};

use super::headers::has_header;
use super::lock::SetupLock;
use super::logged::Log;
use super::packages::{self, Packages, find_program};
use super::source_package;
use crate::paths::target_folder;
use crate::progress::{Progress, Step};

/// Lines that follow those of the board's own configuration.
///
/// The script is looked for on partition 1 of the card alone, not over the network as well; settings are
/// never read from the card.
pub const SETTINGS: [&str; 4] = [
    "CONFIG_USE_BOOTCOMMAND=y",
    "CONFIG_BOOTCOMMAND=\"if load mmc 0:1 ${scriptaddr} boot.scr; then source ${scriptaddr}; \
     else echo boot.scr cannot be read from partition 1 of the SD card; fi\"",
    "# CONFIG_ENV_IS_IN_MMC is not set",
    "CONFIG_ENV_IS_NOWHERE=y",
];

const BOARD_CONFIGURATION: &str = "socfpga_de1_soc_defconfig";
const CONFIGURATION: &str = "halfspace_defconfig";
const OUTPUT: &str = "u-boot-with-spl.sfp";
const COMPILER: &str = "arm-none-eabi-gcc";
const CROSS_COMPILE: &str = "arm-none-eabi-";
/// Programs that the build calls; they come with [`PACKAGES`].
const PROGRAMS: [&str; 8] = [COMPILER, "gcc", "make", "bison", "flex", "bc", "dpkg-source", "xz"];
const HEADER: &str = "openssl/evp.h";
const PACKAGES: Packages = Packages {
    apt: &[
        "gcc-arm-none-eabi",
        "gcc",
        "libc6-dev",
        "make",
        "bison",
        "flex",
        "bc",
        "libssl-dev",
        "dpkg-dev",
        "xz-utils",
    ],
    dnf: &[],
    pacman: &[],
    brew: &[],
};
/// The time that U-Boot says it was built, so that every build gives the same bytes: 9 January 2023.
const SOURCE_DATE_EPOCH: &str = "1673222400";
const LIMIT: Duration = Duration::from_secs(1_800);

/// A U-Boot that was built here.
#[derive(Debug, Clone)]
pub struct BuiltUBoot {
    /// Preloader and U-Boot proper, as they go into the card's partition: `u-boot-with-spl.sfp`.
    pub image: PathBuf,
    /// U-Boot proper with its symbols.
    pub elf: PathBuf,
    /// Version of Debian's package.
    pub version: String,
}

/// Finds the U-Boot that was built before, or builds it.
///
/// # Errors
/// When the system has no Debian source packages, something is missing that cannot be installed
/// without asking, or the build fails, with the end of what it said.
pub fn ensure_uboot(progress: &Progress) -> anyhow::Result<BuiltUBoot> {
    build(progress).context("U-Boot could not be built here: build it on Debian 12, and give it with --uboot FILE")
}

fn build(progress: &Progress) -> anyhow::Result<BuiltUBoot> {
    let folder = target_folder().join("setup/uboot");
    if let Some(built) = built(&folder) {
        return Ok(built);
    }
    if find_program("apt-get").is_none() {
        bail!("its source is Debian's source package u-boot, and this system has no apt-get");
    }
    ensure_tools(progress)?;
    let _lock = SetupLock::take(progress)?;
    // Another process may have built it while this one waited.
    if let Some(built) = built(&folder) {
        return Ok(built);
    }
    let log = Log::new("uboot")?;
    let step = progress.step("fetching U-Boot's source package");
    let source = source_package::fetch("u-boot", &folder, &log, &step)?;
    step.done();
    let step = progress.step(format!("building U-Boot {}, which takes a minute", source.version));
    configure(&folder, &source.folder, &log, &step)?;
    let mut make = make(&folder, &source.folder);
    let jobs = thread::available_parallelism().map_or(1, usize::from);
    make.arg(format!("-j{jobs}")).arg(OUTPUT);
    log.run(make, &step, LIMIT)?;
    fs::write(folder.join("recipe"), recipe(&source.version)).context("cannot write U-Boot's recipe")?;
    step.done();
    self::built(&folder).context("U-Boot's build left nothing")
}

/// Returns what an earlier build by the same recipe has left.
fn built(folder: &Path) -> Option<BuiltUBoot> {
    let found = fs::read_to_string(folder.join("recipe")).ok()?;
    let version = found.lines().next()?.to_string();
    let build = folder.join("build");
    let (image, elf) = (build.join(OUTPUT), build.join("u-boot"));
    (found == recipe(&version) && image.is_file() && elf.is_file()).then_some(BuiltUBoot { image, elf, version })
}

/// Everything that the outcome hangs on.
fn recipe(version: &str) -> String {
    format!("{version}\n{BOARD_CONFIGURATION}\n{}\n{SOURCE_DATE_EPOCH}\n", SETTINGS.join("\n"))
}

fn ensure_tools(progress: &Progress) -> anyhow::Result<()> {
    // The header can be looked for only once there is a compiler.
    let complete = || {
        anyhow::Ok(PROGRAMS.iter().all(|program| find_program(program).is_some()) && has_header("gcc", "c", HEADER)?)
    };
    if complete()? {
        return Ok(());
    }
    packages::install("U-Boot's build tools", &PACKAGES, progress)?;
    ensure!(complete()?, "a tool is still not there although its packages are installed\n{}", PACKAGES.instructions());
    Ok(())
}

/// Configures the build, and makes sure that U-Boot took every setting.
fn configure(folder: &Path, source: &Path, log: &Log, step: &Step) -> anyhow::Result<()> {
    let configurations = source.join("configs");
    let board = configurations.join(BOARD_CONFIGURATION);
    let text = fs::read_to_string(&board)
        .with_context(|| format!("this U-Boot does not know the board: cannot read {}", board.display()))?;
    let text = format!("{text}{}\n", SETTINGS.join("\n"));
    fs::write(configurations.join(CONFIGURATION), text).context("cannot write U-Boot's configuration")?;
    let mut make = make(folder, source);
    make.arg(CONFIGURATION);
    log.run(make, step, LIMIT)?;
    let taken = fs::read_to_string(folder.join("build/.config")).context("U-Boot's build left no .config")?;
    let refused: Vec<&str> =
        SETTINGS.into_iter().filter(|setting| !taken.lines().any(|line| line == *setting)).collect();
    ensure!(refused.is_empty(), "this U-Boot does not take the setting {}", refused.join(" and "));
    Ok(())
}

fn make(folder: &Path, source: &Path) -> Command {
    let mut make = Command::new("make");
    // What a person exports for other builds must not get in.
    for name in ["MAKEFLAGS", "MAKELEVEL", "CFLAGS", "CPPFLAGS", "LDFLAGS", "ARCH", "KBUILD_OUTPUT"] {
        make.env_remove(name);
    }
    make.env("LC_ALL", "C").env("SOURCE_DATE_EPOCH", SOURCE_DATE_EPOCH).env("CROSS_COMPILE", CROSS_COMPILE);
    make.arg("-C").arg(source).arg(format!("O={}", folder.join("build").display()));
    make
}
