//! Runs the Quartus scripts in a plain Tcl interpreter and gives what they ask Quartus for.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, bail};

use super::Place;
use crate::paths::TemporaryFolder;

/// The Tcl side.
const RECORDER: &str = include_str!("recorder.tcl");

/// Whose script it is; the recorder knows the commands of each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// qsys-script's.
    System,
    /// A component's description for Platform Designer.
    Component,
    /// quartus_sh's.
    Project,
    /// Timing constraints.
    Timing,
}

/// One command that a script gave, with what its variables stood for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Call {
    pub place: Place,
    pub name: String,
    pub arguments: Vec<String>,
}

impl Call {
    /// Returns the argument behind a flag: `-to` of `set_location_assignment PIN_A11 -to VGA_CLK`.
    pub fn after(&self, flag: &str) -> Option<&str> {
        let at = self.arguments.iter().position(|argument| argument == flag)?;
        self.arguments.get(at + 1).map(String::as_str)
    }

    /// Returns an argument by its place, or nothing's.
    pub fn argument(&self, index: usize) -> &str {
        self.arguments.get(index).map_or("", String::as_str)
    }
}

/// A Tcl interpreter.
pub(super) struct Interpreter {
    tclsh: PathBuf,
}

impl Interpreter {
    pub fn new(tclsh: PathBuf) -> Self {
        Self { tclsh }
    }

    /// Runs a script of the folder `root` and returns its calls, in order.
    ///
    /// # Errors
    /// What Tcl says is wrong with it, with file and line.
    pub fn run(&self, kind: Kind, root: &Path, script: &str) -> anyhow::Result<Vec<Call>> {
        let folder = TemporaryFolder::new().context("cannot make a temporary folder")?;
        let recorder = folder.path().join("recorder.tcl");
        std::fs::write(&recorder, RECORDER).with_context(|| format!("cannot write {}", recorder.display()))?;
        let kind = match kind {
            Kind::System => "system",
            Kind::Component => "component",
            Kind::Project => "project",
            Kind::Timing => "timing",
        };
        let output = Command::new(&self.tclsh)
            .arg(&recorder)
            .arg(kind)
            .arg(root.join(script))
            .output()
            .with_context(|| format!("cannot start {}", self.tclsh.display()))?;
        if !output.status.success() {
            let text = String::from_utf8_lossy(&output.stderr);
            bail!("{}", relative(text.trim(), root));
        }
        let text =
            String::from_utf8(output.stdout).with_context(|| format!("{script} gives text that is not UTF-8"))?;
        text.split_terminator('\u{1e}').map(|record| call(record, root)).collect()
    }
}

fn call(record: &str, root: &Path) -> anyhow::Result<Call> {
    let mut fields = record.split_terminator('\u{1f}').map(str::to_owned);
    let mut next = || fields.next().context("the recorder gave too few fields");
    let (file, line, name) = (next()?, next()?, next()?);
    let line = line.parse().context("the recorder gave no line")?;
    Ok(Call { place: Place::new(relative(&file, root), line), name, arguments: fields.collect() })
}

/// Takes the folder away from the paths in a text.
fn relative(text: &str, root: &Path) -> String {
    text.replace(&format!("{}/", root.display()), "")
}
