//! Steps that prove theorems about the FPGA's design, and see proofs of broken designs fail.

use std::fs;

use anyhow::{Context, bail, ensure};

use super::State;
use crate::commands::prove::prove_all;
use crate::prove::{PROOFS, Proof, Tools};
use crate::setup::{ensure_bitwuzla, ensure_yosys};
use crate::yosys::folder_with_design;

/// A change to a file that the proof with this number in [`PROOFS`] must notice.
struct Mistake {
    proof: usize,
    file: &'static str,
    right: &'static str,
    wrong: &'static str,
    /// Part of what is said.
    noticed: &'static str,
}

const MISTAKES: [Mistake; 8] = [
    // The last word is kept back.
    Mistake {
        proof: 0,
        file: "rtl/command_fifo.sv",
        right: "valid_d = read_d != write_q;",
        wrong: "valid_d = read_d != write_q && read_d + 1'b1 != write_q;",
        noticed: "does not follow",
    },
    // It goes left and right for ever.
    Mistake {
        proof: 1,
        file: "rtl/row_walker.sv",
        right: "else if (!neighbour_left_out && place_q",
        wrong: "else if (place_q",
        noticed: "does not follow",
    },
    // A row is left a tile early.
    Mistake {
        proof: 1,
        file: "rtl/span_scanner.sv",
        right: "row_done = place_q.column == constants_q.last_column;",
        wrong: "row_done = place_q.column >= constants_q.last_column - 1'b1;",
        noticed: "does not follow",
    },
    Mistake {
        proof: 0,
        file: "rtl/command_fifo.sv",
        right: "valid_d = read_d != write_q;",
        wrong: "valid_d = read_d != write_d;",
        noticed: "does not follow",
    },
    Mistake {
        proof: 0,
        file: "rtl/command_fifo.sv",
        right: "level_o != LevelWidth'(Depth);",
        wrong: "level_o != LevelWidth'(Depth + 1);",
        noticed: "does not follow",
    },
    Mistake {
        proof: 0,
        file: "rtl/formal/command_fifo_proof.sv",
        right: "initial started_q = 1'b0;",
        wrong: "initial started_q = 1'b1;",
        noticed: "does not hold after power-on",
    },
    Mistake {
        proof: 1,
        file: "rtl/row_walker.sv",
        right: "place_q.column != constants_q.last_column;",
        wrong: "place_q.column < constants_q.last_column - 1'b1;",
        noticed: "does not follow",
    },
    Mistake {
        proof: 0,
        file: "rtl/formal/command_fifo_proof.sv",
        right: "if (!started_q) assume (!rst_ni);",
        wrong: "assume (!rst_ni);",
        noticed: "too much is assumed",
    },
];

fn tools(state: &State) -> anyhow::Result<Tools> {
    Ok(Tools { yosys: ensure_yosys(&state.progress)?, python: ensure_bitwuzla(&state.progress)? })
}

/// Makes sure of the tools before two steps want them at once.
pub(super) fn installed(state: &State) -> anyhow::Result<()> {
    tools(state).map(drop)
}

/// The FIFO, and the traversal with as many pixel units as the board's; `cargo xtask prove` takes the others as well.
pub(super) fn theorems(state: &State) -> anyhow::Result<()> {
    let proofs: Vec<Proof> = PROOFS.into_iter().filter(|proof| matches!(proof.units, None | Some(8))).collect();
    prove_all(&proofs, &tools(state)?).map(drop)
}

pub(super) fn broken_designs(state: &State) -> anyhow::Result<()> {
    let tools = tools(state)?;
    MISTAKES.iter().enumerate().try_for_each(|(number, mistake)| mistake.is_noticed(&tools, number))
}

impl Mistake {
    fn is_noticed(&self, tools: &Tools, number: usize) -> anyhow::Result<()> {
        let Self { proof, file, right, wrong, noticed } = self;
        let proof: &Proof = PROOFS.get(*proof).context("there is no such proof")?;
        let folder = folder_with_design(&format!("prove/mistake-{number}"))?;
        let path = folder.join(file);
        let text = fs::read_to_string(&path).with_context(|| format!("cannot read {file}"))?;
        ensure!(text.matches(right).count() == 1, "{file} has not just one `{right}`: choose another mistake");
        fs::write(&path, text.replace(right, wrong))?;
        match proof.prove(tools, &folder) {
            Ok(_) => bail!("{} was proven with `{wrong}` in {file}", proof.name()),
            Err(error) if error.to_string().contains(noticed) => Ok(()),
            Err(error) => Err(error.context(format!("`{wrong}` in {file} was to be noticed otherwise ({noticed})"))),
        }
    }
}
