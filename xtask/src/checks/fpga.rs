//! The Quartus project in `fpga/`, as far as it can be checked without Quartus.
//!
//! Its Tcl scripts are run in a plain Tcl interpreter that writes down what they ask Quartus for
//! ([`script`]); what comes out is compared with the SystemVerilog ([`verilog`]) and with `fpga-regs`.

mod build;
mod components;
mod constraints;
mod language;
mod pins;
mod script;
mod sources;
mod system;
#[cfg(test)]
mod tests;
mod top;
mod verilog;

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, bail, ensure};

use super::State;
use crate::paths::{TemporaryFolder, workspace_root};
use crate::progress::Progress;
use crate::setup::{Packages, ensure_tool, ensure_verilator};
use script::{Interpreter, Kind};
use verilog::Source;

const TCL: Packages = Packages { apt: &["tcl"], dnf: &["tcl"], pacman: &["tcl"], brew: &["tcl-tk"] };
const MAKE: Packages = Packages { apt: &["make"], dnf: &["make"], pacman: &["make"], brew: &["make"] };

/// A place in a file of the workspace.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Place {
    file: String,
    line: usize,
}

impl Place {
    fn new(file: String, line: usize) -> Self {
        Self { file, line }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}:{}", self.file, self.line)
    }
}

/// What was found, each with its place and its remedy.
#[derive(Debug, Default)]
struct Problems(Vec<String>);

impl Problems {
    fn add(&mut self, place: &Place, message: String) {
        self.0.push(format!("{place}: {message}"));
    }

    fn add_file(&mut self, file: &str, message: String) {
        self.0.push(format!("{file}: {message}"));
    }
}

/// The tools of the checks.
struct Tools {
    tcl: Interpreter,
    verilator: PathBuf,
    make: PathBuf,
}

impl Tools {
    fn find(progress: &Progress) -> anyhow::Result<Self> {
        Ok(Self {
            tcl: Interpreter::new(ensure_tool("tclsh", &TCL, progress)?),
            verilator: ensure_verilator(progress)?,
            make: ensure_tool("make", &MAKE, progress)?,
        })
    }
}

/// Scripts, pins, constraints and sources agree with the design and with one another.
pub(super) fn project(state: &State) -> anyhow::Result<()> {
    let tools = Tools::find(&state.progress)?;
    check(&tools, &workspace_root())?;
    build::check(&tools.make, &workspace_root())
}

/// Checks the project in a folder that has `fpga/` and `rtl/`.
fn check(tools: &Tools, root: &Path) -> anyhow::Result<()> {
    let mut problems = Problems::default();
    let list = fs::read_to_string(root.join("rtl/files.f")).context("cannot read rtl/files.f")?;
    let list = sources::list(&list);
    let mut paths: Vec<String> = list.iter().map(|name| format!("rtl/{name}")).collect();
    paths.extend(["fpga/board_io_pkg.sv", "fpga/board_io.sv", "fpga/de1_soc.sv"].map(str::to_owned));
    let missing: Vec<&String> = paths.iter().filter(|path| !root.join(path).is_file()).collect();
    ensure!(missing.is_empty(), "rtl/files.f: {missing:?} are not there: mend the list");
    let design = paths.iter().map(|path| Source::read(root, path)).collect::<anyhow::Result<Vec<_>>>()?;
    let find = |name: &str| {
        let found = design.iter().find(|source| source.module() == Some(name));
        found.with_context(|| format!("no source has the module {name}"))
    };
    let (halfspace, board_io, top) = (find("halfspace")?, find("board_io")?, find("de1_soc")?);
    design.iter().for_each(|source| language::check(source, &mut problems));

    let rasterizer_calls = tools.tcl.run(Kind::Component, root, "fpga/ip/halfspace_hw.tcl")?;
    let board_calls = tools.tcl.run(Kind::Component, root, "fpga/ip/board_io_hw.tcl")?;
    let system_calls = tools.tcl.run(Kind::System, root, "fpga/system.tcl")?;
    let project_calls = tools.tcl.run(Kind::Project, root, "fpga/project.tcl")?;
    let timing_calls = tools.tcl.run(Kind::Timing, root, "fpga/de1_soc.sdc")?;

    sources::component(root, &list, &rasterizer_calls, &mut problems);
    sources::files(root, &board_calls, &mut problems);
    sources::files(root, &project_calls, &mut problems);
    let components = [
        components::check(halfspace, &rasterizer_calls, &mut problems),
        components::check(board_io, &board_calls, &mut problems),
    ];
    let system = system::System::new(&system_calls, &components);
    system.check(&system_calls, &mut problems);
    let ports = top.ports();
    pins::check(&ports, &project_calls, &mut problems);
    constraints::check(&ports, &design, &system, &timing_calls, &mut problems);
    let system_ports = system.ports(&system_calls, &mut problems);

    if !problems.0.is_empty() {
        bail!("mistakes in the Quartus project: {}\n  {}", problems.0.len(), problems.0.join("\n  "));
    }
    top::lint(&tools.verilator, root, &system_ports)
}

/// The board's keys, switches, lights and displays answer as their registers say.
pub(super) fn board_io(state: &State) -> anyhow::Result<()> {
    let tools = Tools::find(&state.progress)?;
    let folder = TemporaryFolder::new().context("cannot make a temporary folder")?;
    let run = |command: &mut Command| -> anyhow::Result<String> {
        let output = command.output().with_context(|| format!("cannot start {command:?}"))?;
        let text = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).concat();
        ensure!(output.status.success(), "{}", text.trim_end());
        Ok(text)
    };
    run(Command::new(&tools.verilator)
        .current_dir(workspace_root())
        .args(["--binary", "--assert", "-CFLAGS", "-O0", "--top-module", "board_io_tb", "--Mdir"])
        .arg(folder.path())
        .args(["fpga/board_io_pkg.sv", "rtl/synchronizer.sv", "fpga/board_io.sv", "fpga/tests/board_io_tb.sv"]))
    .context("fpga/tests/board_io_tb.sv does not compile")?;
    let said = run(&mut Command::new(folder.path().join("Vboard_io_tb"))).context("fpga/board_io.sv")?;
    ensure!(
        said.contains("board_io: all checks passed"),
        "fpga/tests/board_io_tb.sv ended without its last word:\n{said}"
    );
    Ok(())
}
