//! Steps that are cargo's.

use std::path::Path;
use std::process::Command;

use anyhow::{Context, bail};

use super::{State, rtl};
use crate::{cargo_build, simulated, verilated};

/// Features that are off by default.
const FEATURES: &str = "rtl-sim/waves,simulator/rtl,simulator/window";

pub(super) fn formatting() -> anyhow::Result<()> {
    component("rustfmt", &["fmt", "--version"])?;
    run(&["fmt", "--all", "--check"], "run `cargo fmt --all`")
}

/// All crates in one call, which reads each once, with the features that a plain call leaves out.
pub(super) fn clippy(state: &State) -> anyhow::Result<()> {
    component("clippy", &["clippy", "--version"])?;
    rtl::tools(state)?;
    run(
        &["clippy", "--quiet", "--workspace", "--all-targets", "--features", FEATURES, "--", "-D", "warnings"],
        "mend what clippy names above; most it can mend itself with `cargo clippy --fix`",
    )
}

/// The tests of the crates that neither want the FPGA's design nor run the board's image.
pub(super) fn tests() -> anyhow::Result<()> {
    run(
        &["test", "--workspace", "--exclude", verilated::CRATE, "--exclude", simulated::CRATE],
        "the failed test is named above; `cargo test NAME` runs it alone",
    )
}

/// The tests that start a QEMU of their own.
pub(super) fn qemu_tests() -> anyhow::Result<()> {
    run(
        &["test", "--quiet", "--package", "xtask", "--lib", "--", "--ignored", "qemu::tests"],
        "the failed test is named above",
    )
}

/// The tests that break a copy of the Quartus project on purpose.
pub(super) fn fpga_tests() -> anyhow::Result<()> {
    run(
        &["test", "--quiet", "--package", "xtask", "--lib", "--", "--ignored", "checks::fpga::tests"],
        "the failed test is named above",
    )
}

/// Runs cargo in the workspace, its words on this terminal.
pub(super) fn run(arguments: &[&str], remedy: &str) -> anyhow::Result<()> {
    run_with(arguments, &[], remedy)
}

/// The same with variables in the environment.
pub(super) fn run_with(arguments: &[&str], variables: &[(&str, &Path)], remedy: &str) -> anyhow::Result<()> {
    let status =
        cargo(arguments).envs(variables.iter().copied()).status().context("cannot start cargo: is Rust installed?")?;
    if !status.success() {
        bail!("`cargo {}` failed ({status}): {remedy}", arguments.join(" "));
    }
    Ok(())
}

/// Finds out whether a part of the Rust distribution is there.
fn component(name: &str, version: &[&str]) -> anyhow::Result<()> {
    let output = cargo(version).output().context("cannot start cargo: is Rust installed?")?;
    if !output.status.success() {
        bail!("{name} is missing: install it with `rustup component add {name}`");
    }
    Ok(())
}

fn cargo(arguments: &[&str]) -> Command {
    // The cargo that runs this program, if one does.
    let mut command = cargo_build::cargo();
    command.args(arguments);
    command
}
