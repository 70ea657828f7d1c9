//! `cargo xtask prove`: theorems about the FPGA's design.

use std::thread;

use anyhow::Context;

use crate::cli::ProveArguments;
use crate::paths::workspace_root;
use crate::progress::Progress;
use crate::prove::{PROOFS, Proof, Proven, Tools};
use crate::setup::{ensure_bitwuzla, ensure_yosys};
use crate::table::{Column, Table};

/// Proves all, or those for one number of pixel units.
///
/// # Errors
///
/// When Yosys or the solver cannot be had, and as [`Proof::prove`].
pub fn run(arguments: &ProveArguments) -> anyhow::Result<()> {
    let progress = Progress::new();
    let tools = Tools { yosys: ensure_yosys(&progress)?, python: ensure_bitwuzla(&progress)? };
    let is_wanted = |proof: &Proof| arguments.units.is_none_or(|units| proof.units.is_none_or(|of| of == units));
    let proofs: Vec<Proof> = PROOFS.into_iter().filter(is_wanted).collect();
    let step = progress.step(format!("proving {} theorems", proofs.len()));
    let proven = prove_all(&proofs, &tools)?;
    step.done();
    let mut table = Table::new([
        Column::text("theorem"),
        Column::number("pixel units"),
        Column::number("assertions"),
        Column::number("states reached"),
        Column::number("seconds"),
    ]);
    for (proof, Proven { assertions, reached, time }) in proofs.iter().zip(proven) {
        let units = proof.units.map_or_else(|| "any".to_string(), |units| units.to_string());
        let seconds = format!("{:.0}", time.as_secs_f64());
        table.row([proof.claim.to_string(), units, assertions.to_string(), reached.to_string(), seconds]);
    }
    print!("{table}");
    Ok(())
}

/// Proves each on a thread of its own.
///
/// # Errors
/// The first that fails, by its name.
pub fn prove_all(proofs: &[Proof], tools: &Tools) -> anyhow::Result<Vec<Proven>> {
    let root = workspace_root();
    thread::scope(|scope| {
        let running: Vec<_> =
            proofs.iter().map(|proof| (proof, scope.spawn(|| proof.prove(tools, &root, "design")))).collect();
        running
            .into_iter()
            .map(|(proof, thread)| {
                let outcome = thread.join().ok().context("a thread that proved has panicked")?;
                outcome.with_context(|| format!("not proven: {} ({})", proof.claim, proof.name()))
            })
            .collect()
    })
}
