//! Steps that run the FPGA's design in Verilator.

use super::State;
use super::cargo::run;
use crate::setup::{ensure_verilator, ensure_wave_library};
use crate::verilated;

const FAILED: &str = "the failed test is named above; rtl-sim/README.md says how to run it alone";

pub(super) fn tools(state: &mut State) -> anyhow::Result<()> {
    ensure_verilator(&state.progress)?;
    ensure_wave_library(&state.progress)
}

pub(super) fn clippy() -> anyhow::Result<()> {
    run(
        &[
            "clippy",
            "--quiet",
            "--package",
            verilated::CRATE,
            "--all-targets",
            "--all-features",
            "--",
            "-D",
            "warnings",
        ],
        "mend what clippy names above",
    )
}

/// Random streams, the demonstration's, the registers, VGA's pins, the bars.
pub(super) fn tests() -> anyhow::Result<()> {
    run(&["test", "--package", verilated::CRATE], FAILED)
}

/// The one test that needs a build with waves.
pub(super) fn waves() -> anyhow::Result<()> {
    run(&["test", "--quiet", "--package", verilated::CRATE, "--features", "waves", "--test", "wave"], FAILED)
}
