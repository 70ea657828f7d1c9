//! Runs an installer with its output in a log file, of which a failure shows the end.

use std::fs::{self, File, OpenOptions};
use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, bail};

use crate::paths;
use crate::progress::Step;

const TAIL_LINES: usize = 15;
const POLL: Duration = Duration::from_millis(50);

/// A log file under `target/setup/`.
pub(super) struct Log {
    path: PathBuf,
}

impl Log {
    /// Starts the log `name` anew.
    pub(super) fn new(name: &str) -> anyhow::Result<Self> {
        let path = paths::target_folder().join("setup").join(format!("{name}.log"));
        let remedy = || format!("cannot write {}: check the folder's permissions", path.display());
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).with_context(remedy)?;
        }
        File::create(&path).with_context(remedy)?;
        Ok(Self { path })
    }

    /// Runs `command` to its end and updates `step` meanwhile.
    ///
    /// # Errors
    ///
    /// When it cannot start, fails, or takes longer than `limit`; with the end of its output.
    pub(super) fn run(&self, mut command: Command, step: &Step, limit: Duration) -> anyhow::Result<()> {
        let shown = shown(&command);
        let mut file = OpenOptions::new()
            .append(true)
            .open(&self.path)
            .with_context(|| format!("cannot write {}", self.path.display()))?;
        writeln!(file, "$ {shown}")?;
        command.stdin(Stdio::null()).stdout(file.try_clone()?).stderr(file);
        let mut child = command.spawn().with_context(|| format!("cannot start `{shown}`"))?;
        let started = Instant::now();
        let outcome = loop {
            if let Some(status) = child.try_wait()? {
                break status.to_string();
            }
            if started.elapsed() > limit {
                child.kill()?;
                child.wait()?;
                break format!("stopped after {} s", limit.as_secs());
            }
            step.update(&shown);
            thread::sleep(POLL);
        };
        if outcome == "exit status: 0" {
            return Ok(());
        }
        bail!("`{shown}` failed ({outcome}); the end of {}:\n{}", paths::for_display(&self.path).display(), self.tail())
    }

    /// Returns the last lines, indented.
    fn tail(&self) -> String {
        let bytes = fs::read(&self.path).unwrap_or_default();
        let text = String::from_utf8_lossy(&bytes);
        let lines: Vec<&str> = text.lines().collect();
        let tail = &lines[lines.len().saturating_sub(TAIL_LINES)..];
        tail.iter().map(|line| format!("    {line}")).collect::<Vec<_>>().join("\n")
    }
}

/// Returns the command as a person would type it.
fn shown(command: &Command) -> String {
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    words.map(|word| word.to_string_lossy()).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::progress::Progress;

    fn shell(script: &str) -> Command {
        let mut command = Command::new("sh");
        command.args(["-c", script]);
        command
    }

    #[test]
    fn a_failure_shows_the_command_and_the_end_of_its_output() {
        let log = Log::new("test-failure").expect("the target folder can be written");
        let step = Progress::quiet().step("testing");
        let minute = Duration::from_secs(60);
        log.run(shell("echo fine"), &step, minute).expect("it succeeds");
        let error = log.run(shell("seq 1 40; echo bad >&2; exit 3"), &step, minute).expect_err("it fails").to_string();
        assert!(error.contains("exit status: 3") && error.contains("test-failure.log"), "{error}");
        assert!(error.contains("    40\n    bad") && !error.contains("    20\n"), "{error}");
        assert!(log.run(Command::new("no-such-program"), &step, minute).is_err());
    }

    #[test]
    fn a_command_that_hangs_is_stopped() {
        let log = Log::new("test-hang").expect("the target folder can be written");
        let started = Instant::now();
        let step = Progress::quiet().step("testing");
        let error = log.run(shell("exec sleep 60"), &step, Duration::from_millis(100)).expect_err("it hangs");
        assert!(error.to_string().contains("stopped after"), "{error}");
        assert!(started.elapsed() < Duration::from_secs(30));
    }
}
