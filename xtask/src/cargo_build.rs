//! Cargo as a command, and a build of its with its words as the progress of a step.

use std::env;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

use anyhow::{Context, bail};

use crate::paths::workspace_root;
use crate::progress::Step;

/// Returns the cargo that this program was started by, else that of the path, in the workspace.
pub fn cargo() -> Command {
    let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(workspace_root());
    cargo
}

/// Runs `cargo`; `what` is what it builds, like `the firmware for de1-soc`.
///
/// # Errors
///
/// When cargo cannot start or fails, with all that it said.
pub fn run(mut cargo: Command, what: &str, step: &Step) -> anyhow::Result<()> {
    cargo.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
    let program = cargo.get_program().to_string_lossy().into_owned();
    let mut child = cargo.spawn().with_context(|| format!("cannot start {program}: is Rust installed?"))?;
    let mut said = String::new();
    if let Some(output) = child.stderr.take() {
        for line in BufReader::new(output).split(b'\n') {
            let line = line.context("cannot read what cargo says")?;
            let line = String::from_utf8_lossy(&line);
            step.update(line.trim());
            said.push_str(&line);
            said.push('\n');
        }
    }
    let status = child.wait().context("cannot wait for cargo")?;
    if !status.success() {
        bail!("{what} does not build ({status}); cargo says:\n{said}");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::progress::Progress;

    fn shell(script: &str) -> anyhow::Result<()> {
        let mut command = Command::new("sh");
        command.args(["-c", script]);
        run(command, "a thing", &Progress::quiet().step("testing"))
    }

    #[test]
    fn a_failure_says_all_that_cargo_said() {
        shell("echo fine >&2").expect("it succeeds");
        let error = shell("echo one >&2; echo two >&2; exit 3").expect_err("it fails").to_string();
        assert_eq!(error, "a thing does not build (exit status: 3); cargo says:\none\ntwo\n");
        let missing = run(Command::new("no-such-cargo"), "a thing", &Progress::quiet().step("testing"));
        assert!(missing.expect_err("missing").to_string().contains("cannot start no-such-cargo"));
    }
}
