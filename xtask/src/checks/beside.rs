//! Runs steps beside each other, as many as there are processors.
//!
//! Each is a process of its own, whose words are shown whole and in order when it has ended. Most of them wait on one
//! thread for something that computes on one thread: a solver, QEMU, a compiler of one crate.

use std::env;
use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::thread;
use std::time::Instant;

use anyhow::{Context, bail};

use super::{Check, Ended};
use crate::paths::TemporaryFolder;

/// Runs a group of steps. After one has failed no other begins, and those under way are waited for.
pub(super) fn run(group: &[&Check], before: usize, count: usize) -> Ended {
    let program = env::current_exe().context("cannot find this program");
    let (program, folder) = match (program, TemporaryFolder::new().context("cannot make a temporary folder")) {
        (Ok(program), Ok(folder)) => (program, folder),
        (Err(error), _) | (_, Err(error)) => return Ended { passed: 0, failure: Some(error) },
    };
    let order = |check: &Check| {
        let mut command = Command::new(&program);
        command.args(["test", "--step", check.name]);
        command
    };
    run_with(group, before, count, folder.path(), order)
}

/// The same with any commands.
fn run_with(
    group: &[&Check],
    before: usize,
    count: usize,
    folder: &Path,
    order: impl Fn(&Check) -> Command + Sync,
) -> Ended {
    let waiting = Mutex::new(group.iter().enumerate());
    let ended = Mutex::new(Ended { passed: 0, failure: None });
    let next = || {
        let mut waiting = waiting.lock().expect("no thread panicked");
        let (index, check) = waiting.next().filter(|_| ended.lock().expect("no thread panicked").failure.is_none())?;
        println!("[{}/{count}] {}: begun", before + index + 1, check.name);
        Some((before + index + 1, *check))
    };
    let work = || {
        while let Some((number, check)) = next() {
            let log = folder.join(format!("{number}.txt"));
            let started = Instant::now();
            let outcome = to_its_end(order(check), &log);
            let said = fs::read(&log).unwrap_or_default();
            let mut ended = ended.lock().expect("no thread panicked");
            println!("[{number}/{count}] {}", check.name);
            print!("{}", String::from_utf8_lossy(&said));
            match outcome {
                Ok(()) => {
                    println!("        passed in {:.1} s", started.elapsed().as_secs_f64());
                    ended.passed += 1;
                }
                Err(error) => {
                    println!("        failed after {:.1} s", started.elapsed().as_secs_f64());
                    ended.failure.get_or_insert(error.context(format!("step {number} failed ({})", check.name)));
                }
            }
        }
    };
    let workers = thread::available_parallelism().map_or(1, usize::from).min(group.len());
    thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(work);
        }
    });
    ended.into_inner().expect("no thread panicked")
}

/// Runs a command with all that it says in one file.
fn to_its_end(mut command: Command, log: &Path) -> anyhow::Result<()> {
    let cannot = || format!("cannot write {}", log.display());
    let output = File::create(log).with_context(cannot)?;
    let errors = output.try_clone().with_context(cannot)?;
    let status = command.stdin(Stdio::null()).stdout(output).stderr(errors).status();
    let status = status.with_context(|| format!("cannot start {}", command.get_program().display()))?;
    if !status.success() {
        bail!("why stands above");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::beside;

    fn ended(scripts: &[&'static str]) -> (Ended, TemporaryFolder) {
        let folder = TemporaryFolder::new().expect("folders can be made");
        let checks: Vec<Check> = scripts.iter().map(|script| beside(script, |_| Ok(()))).collect();
        let group: Vec<&Check> = checks.iter().collect();
        let order = |check: &Check| {
            let mut command = Command::new("sh");
            command.current_dir(folder.path()).args(["-c", check.name]);
            command
        };
        (run_with(&group, 0, group.len(), folder.path(), order), folder)
    }

    #[test]
    fn all_run_and_their_words_are_kept() {
        let (ended, folder) = ended(&["echo one; echo two >&2; echo three", "true", "echo four"]);
        assert!(ended.failure.is_none());
        assert_eq!(ended.passed, 3);
        let said = |number: u32| fs::read_to_string(folder.path().join(format!("{number}.txt"))).expect("it is there");
        assert_eq!(said(1), "one\ntwo\nthree\n");
        assert_eq!(said(3), "four\n");
    }

    #[test]
    fn none_begins_after_a_failure_and_it_is_named() {
        let (ended, folder) = ended(&[&["exit 3"], ["sleep 1"; 63].as_slice(), &["touch late"; 64]].concat());
        let failure = ended.failure.expect("the first one fails");
        assert!(failure.to_string().contains("step 1 failed (exit 3)"), "{failure}");
        assert!(!folder.path().join("late").exists());
        let workers = thread::available_parallelism().map_or(1, usize::from);
        assert!(ended.passed < workers, "{} went on after the failure", ended.passed);
    }

    #[test]
    fn a_program_that_is_not_there_is_named() {
        let log = TemporaryFolder::new().expect("folders can be made");
        let error = to_its_end(Command::new("no-such-program"), &log.path().join("log")).expect_err("it is missing");
        assert!(error.to_string().contains("cannot start no-such-program"), "{error}");
    }
}
