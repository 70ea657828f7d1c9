//! Steps that run the FPGA's design in Verilator.

use super::State;
use super::cargo::run;
use crate::setup::{ensure_verilator, ensure_wave_library};
use crate::verilated;

pub(super) fn tools(state: &State) -> anyhow::Result<()> {
    ensure_verilator(&state.progress)?;
    ensure_wave_library(&state.progress)
}

/// Random streams, the demonstration's, the registers, VGA's pins, waves, the bars.
pub(super) fn tests(state: &State) -> anyhow::Result<()> {
    tools(state)?;
    run(
        &["test", "--package", verilated::CRATE, "--features", "waves"],
        "the failed test is named above; rtl-sim/README.md says how to run it alone",
    )
}
