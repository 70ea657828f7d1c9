//! Bitwuzla, as a Python module.

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, bail};

/// Reads a file of SMT-LIB commands and prints the answers.
const PROGRAM: &str = "import sys
from bitwuzla import Options, Parser, TermManager
Parser(TermManager(), Options()).parse(sys.argv[1], False, True)";
/// A proof takes two minutes on a slow machine.
const LIMIT: Duration = Duration::from_secs(1200);

/// What the solver says of a formula.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Answer {
    Satisfiable,
    Unsatisfiable,
    Unknown,
}

/// Lets the solver answer a file's questions, until an answer is not as expected. Returns that one's index and
/// the answer, or nothing if all are as expected.
///
/// # Errors
/// When it cannot start, fails, says something else, leaves questions open, or has not ended after twenty minutes.
pub(super) fn first_surprise(
    python: &Path,
    query: &Path,
    expected: &[Answer],
) -> anyhow::Result<Option<(usize, Answer)>> {
    let errors = query.with_extension("errors");
    let errors_file = fs::File::create(&errors).with_context(|| format!("cannot write {}", errors.display()))?;
    let mut child = Command::new(python)
        .args(["-c", PROGRAM])
        .arg(query)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(errors_file)
        .spawn()
        .with_context(|| format!("cannot start {}", python.display()))?;
    let lines = child.stdout.take().map(lines_of).context("the solver has no output")?;
    let deadline = Instant::now() + LIMIT;
    let outcome = compare(&lines, deadline, expected);
    // It may be amid a question whose answer nobody wants.
    let _ = child.kill();
    child.wait()?;
    outcome.with_context(|| {
        let said = fs::read_to_string(&errors).unwrap_or_default();
        format!("{} ({})", query.display(), said.lines().last().unwrap_or("no error was printed"))
    })
}

/// Reads lines on a thread, so that waiting for one can end.
fn lines_of(output: impl Read + Send + 'static) -> Receiver<String> {
    let (sender, receiver) = mpsc::channel();
    thread::spawn(move || {
        for line in BufReader::new(output).lines().map_while(Result::ok) {
            if sender.send(line).is_err() {
                return;
            }
        }
    });
    receiver
}

fn compare(
    lines: &Receiver<String>,
    deadline: Instant,
    expected: &[Answer],
) -> anyhow::Result<Option<(usize, Answer)>> {
    for (index, expected) in expected.iter().enumerate() {
        let line = match lines.recv_timeout(deadline.saturating_duration_since(Instant::now())) {
            Ok(line) => line,
            Err(RecvTimeoutError::Timeout) => bail!("the solver did not end within {} s", LIMIT.as_secs()),
            Err(RecvTimeoutError::Disconnected) => bail!("the solver ended before question {}", index + 1),
        };
        let answer = answer(&line)?;
        if answer != *expected {
            return Ok(Some((index, answer)));
        }
    }
    Ok(None)
}

fn answer(line: &str) -> anyhow::Result<Answer> {
    match line.trim() {
        "sat" => Ok(Answer::Satisfiable),
        "unsat" => Ok(Answer::Unsatisfiable),
        "unknown" => Ok(Answer::Unknown),
        other => bail!("the solver said `{other}`"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_surprise_is_found_and_an_early_end_is_an_error() {
        use Answer::{Satisfiable, Unsatisfiable};
        let lines = || lines_of(&b"unsat\nsat\nunsat\n"[..]);
        let soon = Instant::now() + Duration::from_secs(60);
        let surprise = |expected: &[Answer]| compare(&lines(), soon, expected);
        assert_eq!(surprise(&[Unsatisfiable, Satisfiable, Unsatisfiable]).expect("all are there"), None);
        let found = surprise(&[Unsatisfiable, Unsatisfiable, Unsatisfiable]).expect("all are there");
        assert_eq!(found, Some((1, Satisfiable)));
        let error = surprise(&[Unsatisfiable, Satisfiable, Unsatisfiable, Satisfiable]).expect_err("one is missing");
        assert!(error.to_string().contains("before question 4"), "{error}");
        let error = compare(&lines_of(&b"(error)\n"[..]), soon, &[Satisfiable]).expect_err("no answer");
        assert!(error.to_string().contains("`(error)`"), "{error}");
    }
}
