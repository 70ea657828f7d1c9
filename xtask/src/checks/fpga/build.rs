//! The Makefile calls Quartus's tools in order, says what is missing, and keeps no image that misses timing.

use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use anyhow::{Context, ensure};

use crate::paths::TemporaryFolder;
use crate::setup::find_program;

/// What takes the place of each of Quartus's tools: writes down its call and leaves what the tool would.
const TOOL: &str = r#"#!/bin/sh
echo "${0##*/} $*" >> "$CALLS"
case "${0##*/} $*" in
    qsys-script*) touch halfspace_system.qsys ;;
    qsys-generate*) mkdir -p halfspace_system/synthesis; touch halfspace_system/synthesis/halfspace_system.qip ;;
    "quartus_sh --flow"*)
        mkdir -p output_files
        echo image > output_files/de1_soc.sof
        printf 'Type  : Slow Model Setup\nSlack : %s\n' "$SLACK" > output_files/de1_soc.sta.summary ;;
    quartus_cpf*) for last; do :; done; echo image > "$last" ;;
esac
"#;
const TOOLS: [&str; 7] =
    ["qsys-script", "qsys-generate", "quartus_sh", "quartus_map", "quartus_cdb", "quartus_sta", "quartus_cpf"];
/// The tools in the order of a build, with what tells the calls apart.
const ORDER: [&str; 8] = [
    "qsys-script --search-path=",
    "qsys-generate halfspace_system.qsys",
    "quartus_sh -t ../project.tcl",
    "quartus_map de1_soc",
    "quartus_cdb --merge de1_soc",
    "quartus_sta -t halfspace_system/synthesis/submodules/hps_sdram_p0_pin_assignments.tcl de1_soc",
    "quartus_sh --flow compile de1_soc",
    "quartus_cpf -c -o bitstream_compression=on build/output_files/de1_soc.sof build/halfspace.rbf",
];
/// What the Makefile needs besides.
const HELPERS: [&str; 11] = ["sh", "echo", "mkdir", "touch", "rm", "cp", "cmp", "awk", "grep", "test", "make"];

/// A copy of the project with a PATH of its own.
struct Copy {
    folder: TemporaryFolder,
    make: PathBuf,
}

impl Copy {
    fn new(make: &Path, root: &Path, with_tools: bool) -> anyhow::Result<Self> {
        let folder = TemporaryFolder::new().context("cannot make a temporary folder")?;
        let copy = Self { folder, make: make.to_owned() };
        for (from, to) in [("fpga", "fpga"), ("fpga/ip", "fpga/ip"), ("rtl", "rtl")] {
            let target = copy.path(to);
            fs::create_dir_all(&target).with_context(|| format!("cannot make {}", target.display()))?;
            for entry in fs::read_dir(root.join(from)).with_context(|| format!("cannot read {from}"))? {
                let path = entry?.path();
                if path.is_file() {
                    fs::copy(&path, target.join(path.file_name().unwrap_or_default()))?;
                }
            }
        }
        let bin = copy.path("bin");
        fs::create_dir_all(&bin)?;
        for helper in HELPERS {
            if let Some(program) = find_program(helper) {
                symlink(program, bin.join(helper))?;
            }
        }
        for tool in TOOLS.iter().filter(|_| with_tools) {
            let path = bin.join(tool);
            fs::write(&path, TOOL)?;
            fs::set_permissions(&path, fs::Permissions::from_mode(0o755))?;
        }
        Ok(copy)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Runs make; returns what it said and which tools it called.
    fn make(&self, arguments: &[&str], slack: &str) -> anyhow::Result<(Output, Vec<String>)> {
        let calls = self.path("calls");
        fs::write(&calls, "")?;
        let output = Command::new(&self.make)
            .current_dir(self.path("fpga"))
            .args(arguments)
            .env("PATH", self.path("bin"))
            .env("CALLS", &calls)
            .env("SLACK", slack)
            .env_remove("MAKEFLAGS")
            .output()
            .with_context(|| format!("cannot start {}", self.make.display()))?;
        Ok((output, fs::read_to_string(&calls)?.lines().map(str::to_owned).collect()))
    }

    fn has_image(&self) -> bool {
        self.path("fpga/build/halfspace.rbf").is_file()
    }
}

/// Runs the Makefile with tools that only write down their calls.
///
/// # Errors
/// What it did otherwise than it should.
pub(super) fn check(make: &Path, root: &Path) -> anyhow::Result<()> {
    let without = Copy::new(make, root, false)?;
    let (output, _) = without.make(&[], "1.0")?;
    let said = String::from_utf8_lossy(&output.stderr);
    ensure!(
        !output.status.success() && said.contains("not on PATH: qsys-script") && said.contains("export PATH="),
        "fpga/Makefile: without Quartus it does not name the missing tools and the remedy:\n{said}"
    );

    let with = Copy::new(make, root, true)?;
    let (output, calls) = with.make(&["BUS_MHZ=62.5", "PIXEL_UNITS=4"], "1.0")?;
    let said = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "fpga/Makefile: the build fails with tools that do nothing:\n{said}");
    let in_order = calls.len() == ORDER.len() && calls.iter().zip(ORDER).all(|(call, start)| call.starts_with(start));
    ensure!(
        in_order,
        "fpga/Makefile: the tools are called as\n  {}\nbut should be as\n  {}",
        calls.join("\n  "),
        ORDER.join("\n  ")
    );
    ensure!(
        calls[0].contains("--cmd=set bus_mhz 62.5; set pixel_units 4 "),
        "fpga/Makefile: BUS_MHZ and PIXEL_UNITS do not reach system.tcl: {}",
        calls[0]
    );
    let (_, calls) = with.make(&["BUS_MHZ=62.5", "PIXEL_UNITS=4"], "1.0")?;
    ensure!(calls.is_empty(), "fpga/Makefile: a second build with the same settings calls {}", calls.join(", "));

    let (output, calls) = with.make(&[], "-0.1")?;
    let said = String::from_utf8_lossy(&output.stderr);
    ensure!(calls.len() >= ORDER.len() - 1, "fpga/Makefile: other settings do not build anew");
    ensure!(
        !output.status.success() && said.contains("timing is missed") && !with.has_image(),
        "fpga/Makefile: a negative slack does not stop the build, or leaves an image:\n{said}"
    );
    let (output, _) = with.make(&["IGNORE_TIMING=1"], "-0.1")?;
    ensure!(output.status.success() && with.has_image(), "fpga/Makefile: IGNORE_TIMING=1 gives no image");
    for wrong in ["PIXEL_UNITS=3", "BUS_MHZ=fast"] {
        let (output, calls) = with.make(&[wrong], "1.0")?;
        let said = String::from_utf8_lossy(&output.stderr);
        ensure!(
            !output.status.success() && calls.is_empty() && said.contains(wrong),
            "fpga/Makefile: {wrong} is not refused by name:\n{said}"
        );
    }
    Ok(())
}
