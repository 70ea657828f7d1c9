//! Proofs of parts of the FPGA's design: Yosys turns design and theorem into formulas, Bitwuzla decides them.
//!
//! A proof is by k-induction: the assertions hold in the first k clocks after power-on, and in any clock
//! that follows on k clocks in which they held. Each assertion is decided by itself, so a failure has a
//! name. What the assumptions must leave possible is asked for as well: a state that is reached from
//! power-on, or the proof would be of nothing.

mod query;
mod solver;

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Context, bail, ensure};

use crate::yosys::run_yosys;
use query::{Formulas, Goal};
use solver::Answer;

/// A theorem about a part of the design.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Proof {
    /// What is proven.
    pub claim: &'static str,
    /// Module with the theorem.
    top: &'static str,
    /// Its files, beside the design's.
    files: &'static [&'static str],
    /// Pixel units, where it depends on them.
    pub units: Option<u32>,
    /// Clocks that an assertion is derived from.
    depth: usize,
    /// Clocks from power-on within which all that must be possible happens.
    reach: usize,
}

const fn traversal(units: u32) -> Proof {
    Proof {
        claim: "the traversal visits every covered pixel's tile exactly once, and ends",
        top: "traversal_proof",
        files: &[
            "rtl/formal/traversal_proof_pkg.sv",
            "rtl/formal/followed_primitive.sv",
            "rtl/formal/traversal_proof.sv",
        ],
        units: Some(units),
        depth: 1,
        reach: 10,
    }
}

/// All proofs, the quickest first, those of the traversal by pixel units.
pub const PROOFS: [Proof; 5] = [
    Proof {
        claim: "the command FIFO loses, doubles, reorders and keeps back no word",
        top: "command_fifo_proof",
        files: &["rtl/formal/command_fifo_proof.sv"],
        units: None,
        // An assertion at a clock's edge is about the clock before.
        depth: 2,
        reach: 8,
    },
    traversal(1),
    traversal(2),
    traversal(4),
    traversal(8),
];

/// The programs that prove.
#[derive(Debug, Clone)]
pub struct Tools {
    /// Yosys.
    pub yosys: PathBuf,
    /// The Python that has Bitwuzla.
    pub python: PathBuf,
}

/// What a proof took.
#[derive(Debug, Clone, Copy)]
pub struct Proven {
    /// Assertions that hold.
    pub assertions: usize,
    /// States that were to be possible, and are.
    pub reached: usize,
    /// How long it took.
    pub time: Duration,
}

impl Proof {
    /// Returns a name that files can have.
    pub fn name(&self) -> String {
        self.units.map_or_else(|| self.top.to_string(), |units| format!("{}_n{units}", self.top))
    }

    /// Proves it of the design in `folder`'s `rtl/`; leaves logs and formulas in `folder`.
    ///
    /// # Errors
    /// When an assertion does not hold, or was not decided, with its place; when a state that must be
    /// possible is not; when Yosys or the solver fails.
    pub fn prove(&self, tools: &Tools, folder: &Path) -> anyhow::Result<Proven> {
        let started = Instant::now();
        let smt = folder.join(format!("{}.smt2", self.name()));
        self.write_formulas(tools, folder)?;
        let text = fs::read_to_string(&smt).with_context(|| format!("cannot read {}", smt.display()))?;
        let formulas = Formulas::new(self.top, &text)?;
        let goals = formulas.goals();
        let query = folder.join(format!("{}.query.smt2", self.name()));
        fs::write(&query, formulas.query(self.depth, self.reach))
            .with_context(|| format!("cannot write {}", query.display()))?;
        let expected: Vec<Answer> = goals.iter().map(expected).collect();
        if let Some((index, answer)) = solver::first_surprise(&tools.python, &query, &expected)? {
            bail!("{} ({answer:?}): see {}", goals[index], query.display());
        }
        let reached = goals.iter().filter(|goal| matches!(goal, Goal::Reached(_))).count();
        let assertions = goals.iter().filter(|goal| matches!(goal, Goal::Step(_))).count();
        ensure!(assertions > 0 && reached > 0, "{} has no assertion or nothing that must be possible", self.top);
        Ok(Proven { assertions, reached, time: started.elapsed() })
    }

    fn write_formulas(&self, tools: &Tools, folder: &Path) -> anyhow::Result<()> {
        let (top, name) = (self.top, self.name());
        let parameter = self.units.map_or_else(String::new, |units| format!("-G PixelUnits={units}"));
        let script = format!(
            "read_slang -j 1 -D SYNTHESIS {parameter} -F rtl/files.f {} --top {top}; prep -top {top} -nokeepdc; \
             async2sync; dffunmap; opt_clean; write_smt2 {name}.smt2",
            self.files.join(" "),
        );
        run_yosys(&tools.yosys, folder, &name, &script)
    }
}

/// A state that breaks an assertion must not be found; one that must be possible must be.
fn expected(goal: &Goal) -> Answer {
    match goal {
        Goal::Base(_) | Goal::Step(_) => Answer::Unsatisfiable,
        Goal::Reached(_) => Answer::Satisfiable,
    }
}
