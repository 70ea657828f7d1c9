//! Verilator reads the top level, with a stub in the place of the generated system, and our component.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, bail};

use super::system::SystemPort;
use super::verilog::Direction;
use crate::paths::TemporaryFolder;

/// Intel's register of the VGA clock's pin.
const ALTDDIO_OUT: &str = include_str!("altddio_out.v");

/// Lints the top level and the board's component.
///
/// # Errors
/// Verilator's words: file, line, what.
pub(super) fn lint(verilator: &Path, root: &Path, ports: &[SystemPort]) -> anyhow::Result<()> {
    let folder = TemporaryFolder::new().context("cannot make a temporary folder")?;
    let stub = folder.path().join("halfspace_system.sv");
    let register = folder.path().join("altddio_out.v");
    for (path, text) in [(&stub, &stub_text(ports)), (&register, &ALTDDIO_OUT.to_owned())] {
        fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))?;
    }
    let temporary = |path: &Path| path.display().to_string();
    let board = ["fpga/board_io_pkg.sv", "rtl/synchronizer.sv", "fpga/board_io.sv"].map(str::to_owned);
    let top = [temporary(&stub), temporary(&register), "fpga/de1_soc.sv".to_owned()];
    for (module, sources) in [("board_io", board), ("de1_soc", top)] {
        let output = Command::new(verilator)
            .current_dir(root)
            .args(["--lint-only", "-Wall", "--top-module", module, "fpga/lint/waivers.vlt"])
            .args(sources)
            .output()
            .with_context(|| format!("cannot start {}", verilator.display()))?;
        if !output.status.success() {
            let text = String::from_utf8_lossy(&output.stderr);
            let text = text.replace(&temporary(&stub), "the system that fpga/system.tcl exports");
            bail!("Verilator finds fault with {module}:\n{}", text.trim_end());
        }
    }
    Ok(())
}

/// The system as a module that does nothing.
fn stub_text(ports: &[SystemPort]) -> String {
    let mut text = String::from(
        "/* verilator lint_off UNUSEDSIGNAL */\n/* verilator lint_off UNDRIVEN */\nmodule halfspace_system (\n",
    );
    for (index, port) in ports.iter().enumerate() {
        let direction = match port.direction {
            Direction::Input => "input ",
            Direction::Output => "output",
            Direction::Bidirectional => "inout ",
        };
        let comma = if index + 1 < ports.len() { "," } else { "" };
        let _ = writeln!(text, "    {direction} wire [{}:0] {}{comma}", port.width.saturating_sub(1), port.name);
    }
    text.push_str(");\nendmodule\n");
    text
}
