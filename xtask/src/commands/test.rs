//! `cargo xtask test`: everything CI runs, in one command.

use crate::checks;
use crate::cli::TestArguments;

/// Runs all checks.
///
/// # Errors
///
/// The first check that fails, and what to do about it.
pub fn run(arguments: &TestArguments) -> anyhow::Result<()> {
    match &arguments.step {
        Some(name) => checks::run_one(name),
        None => checks::run(arguments.only.as_deref()),
    }
}
