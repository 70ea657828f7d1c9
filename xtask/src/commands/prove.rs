//! `cargo xtask prove`: theorems about the FPGA's design.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;

use anyhow::Context;

use crate::cli::ProveArguments;
use crate::progress::Progress;
use crate::prove::{PROOFS, Proof, Proven, Tools};
use crate::setup::{ensure_bitwuzla, ensure_yosys};
use crate::table::{Column, Table};
use crate::yosys::folder_with_design;

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
    let step = progress.step(format!("proving {} theorems, some minutes", proofs.len()));
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

/// Proves them, as many at a time as there are processors. What is left of a failure stays in `target/prove`.
///
/// # Errors
/// The first that fails, by its name; those under way are waited for.
pub fn prove_all(proofs: &[Proof], tools: &Tools) -> anyhow::Result<Vec<Proven>> {
    let folder = folder_with_design("prove")?;
    let next = AtomicUsize::new(0);
    let (sender, receiver) = mpsc::channel();
    let workers = thread::available_parallelism().map_or(1, usize::from).min(proofs.len());
    thread::scope(|scope| {
        for _ in 0..workers {
            let (next, folder, sender) = (&next, &folder, sender.clone());
            scope.spawn(move || {
                while let Some(proof) = proofs.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let outcome = proof.prove(tools, folder);
                    if outcome.is_err() {
                        next.store(proofs.len(), Ordering::Relaxed);
                    }
                    let _ = sender.send((proof, outcome));
                }
            });
        }
        drop(sender);
        let mut proven = Vec::new();
        for (proof, outcome) in receiver {
            let outcome = outcome.with_context(|| format!("not proven: {} ({})", proof.claim, proof.name()))?;
            proven.push((proof.units, outcome));
        }
        proven.sort_by_key(|(units, _)| *units);
        Ok(proven.into_iter().map(|(_, outcome)| outcome).collect())
    })
}
