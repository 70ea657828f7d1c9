//! QEMU as a process: its messages are kept, and it never outlives its owner.

use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, anyhow};

use super::LINES_SHOWN;
use crate::console::Console;

/// How often the process is asked whether it has ended.
pub(super) const POLL: Duration = Duration::from_millis(2);

/// A process that is killed when this value goes.
pub(super) struct Process {
    child: Child,
    /// What it prints: warnings, and the reason of a failure.
    messages: Console,
}

impl Process {
    pub(super) fn start(command: &mut Command) -> anyhow::Result<Self> {
        let program = command.get_program().to_string_lossy().into_owned();
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
        let mut child = command.spawn().with_context(|| format!("cannot start {program}: install QEMU again"))?;
        let messages = match child.stderr.take() {
            Some(stderr) => Console::start(stderr, Vec::new()).unwrap_or_default(),
            None => Console::default(),
        };
        Ok(Self { child, messages })
    }

    /// Returns how the process ended, or `None` when it has not within `limit`.
    pub(super) fn wait(&mut self, limit: Duration) -> anyhow::Result<Option<ExitStatus>> {
        let deadline = Instant::now() + limit;
        loop {
            if let Some(status) = self.child.try_wait().context("cannot wait for QEMU")? {
                return Ok(Some(status));
            }
            if Instant::now() >= deadline {
                return Ok(None);
            }
            thread::sleep(POLL);
        }
    }

    /// Adds to an error how the process ended, if it has, and what it printed.
    pub(super) fn explain(&mut self, error: anyhow::Error) -> anyhow::Error {
        // A process that is just ending closes its sockets first.
        let ended = match self.wait(Duration::from_millis(100)) {
            Ok(Some(status)) => {
                self.messages.wait_for_end(Duration::from_secs(1));
                format!("\n  QEMU has ended ({status})")
            }
            _ => String::new(),
        };
        if self.messages.lines().is_empty() {
            return anyhow!("{error:#}{ended}");
        }
        anyhow!("{error:#}{ended}\n  QEMU said:\n{}", self.messages.last_lines(LINES_SHOWN))
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // Both fail only when it has ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
