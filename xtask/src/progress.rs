//! Says what is being done while it is done, on standard error.
//!
//! On a terminal one line is rewritten until the step ends. Elsewhere (a file, CI) a step is a
//! line when it starts, and another one with its time only when it took longer than a second.

use std::io::{self, IsTerminal, Write};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// A step that took longer than this says so in a log.
const WORTH_A_TIME: Duration = Duration::from_secs(1);
/// A detail longer than this would wrap the terminal's line, which could then not be rewritten.
const LINE_CHARACTERS: usize = 78;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Style {
    Terminal,
    Lines,
    Quiet,
}

/// Where progress goes; clones share it.
#[derive(Clone)]
pub struct Progress {
    style: Style,
    output: Arc<Mutex<dyn Write + Send>>,
}

impl Progress {
    /// Returns a reporter on standard error, one updating line if that is a terminal.
    pub fn new() -> Self {
        let style = if io::stderr().is_terminal() { Style::Terminal } else { Style::Lines };
        Self { style, output: Arc::new(Mutex::new(io::stderr())) }
    }

    /// Returns a reporter that says nothing.
    pub fn quiet() -> Self {
        Self { style: Style::Quiet, output: Arc::new(Mutex::new(io::sink())) }
    }

    /// Starts a step; `what` is a phrase like `building the firmware for vexpress-a9`.
    pub fn step(&self, what: impl Into<String>) -> Step {
        let step = Step { progress: self.clone(), what: what.into(), started: Instant::now(), ended: false };
        match self.style {
            Style::Terminal => step.rewrite(""),
            Style::Lines => self.print(&format!("{} …\n", step.what)),
            Style::Quiet => {}
        }
        step
    }

    /// Prints a line that stays.
    pub fn note(&self, text: &str) {
        match self.style {
            Style::Terminal => self.print(&format!("\r\x1b[2K{text}\n")),
            Style::Lines => self.print(&format!("{text}\n")),
            Style::Quiet => {}
        }
    }

    fn print(&self, text: &str) {
        let mut output: MutexGuard<'_, _> = self.output.lock().unwrap_or_else(PoisonError::into_inner);
        // Nothing sensible is left to do when standard error is gone.
        let _ = output.write_all(text.as_bytes()).and_then(|()| output.flush());
    }
}

impl Default for Progress {
    fn default() -> Self {
        Self::new()
    }
}

/// A step under way. Ends with [`done`](Self::done); dropped before that, it is reported as failed.
pub struct Step {
    progress: Progress,
    what: String,
    started: Instant,
    ended: bool,
}

impl Step {
    /// Shows what the step is at now; a terminal alone shows it.
    pub fn update(&self, detail: &str) {
        if self.progress.style == Style::Terminal {
            self.rewrite(detail);
        }
    }

    /// Ends the step and returns how long it took.
    pub fn done(mut self) -> Duration {
        self.end("done")
    }

    /// Ends a step that was tried and did not work out, where another way is taken next.
    pub fn end_without(mut self, reason: &str) {
        self.end(reason);
    }

    fn end(&mut self, outcome: &str) -> Duration {
        self.ended = true;
        let elapsed = self.started.elapsed();
        let line = format!("{}: {outcome} ({:.1} s)", self.what, elapsed.as_secs_f64());
        match self.progress.style {
            Style::Lines if outcome == "done" && elapsed < WORTH_A_TIME => {}
            _ => self.progress.note(&line),
        }
        elapsed
    }

    fn rewrite(&self, detail: &str) {
        let line = format!("{} … {:.0} s {detail}", self.what, self.started.elapsed().as_secs_f64());
        let line: String = line.chars().filter(|character| !character.is_control()).take(LINE_CHARACTERS).collect();
        self.progress.print(&format!("\r\x1b[2K{}", line.trim_end()));
    }
}

impl Drop for Step {
    fn drop(&mut self) {
        if !self.ended {
            self.end("failed");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn recorded(style: Style, work: impl FnOnce(&Progress)) -> String {
        let output = Arc::new(Mutex::new(Vec::<u8>::new()));
        work(&Progress { style, output: output.clone() });
        let bytes = output.lock().expect("no writer panicked").clone();
        String::from_utf8(bytes).expect("progress is text")
    }

    #[test]
    fn a_log_gets_one_line_for_a_short_step() {
        let text = recorded(Style::Lines, |progress| {
            let step = progress.step("linking");
            step.update("half way");
            step.done();
            progress.note("kept");
        });
        assert_eq!(text, "linking …\nkept\n");
    }

    #[test]
    fn a_terminal_line_is_rewritten_and_never_wraps() {
        let text = recorded(Style::Terminal, |progress| {
            let step = progress.step("linking");
            step.update(&"long\n".repeat(100));
            step.done();
        });
        assert_eq!(text.matches("\r\x1b[2K").count(), 3);
        assert_eq!(text.matches('\n').count(), 1);
        assert!(text.ends_with("linking: done (0.0 s)\n"));
        assert!(text.split('\r').all(|line| line.chars().count() <= LINE_CHARACTERS + 8));
    }

    #[test]
    fn a_step_that_is_dropped_has_failed() {
        let text = recorded(Style::Lines, |progress| drop(progress.step("linking")));
        assert_eq!(text, "linking …\nlinking: failed (0.0 s)\n");
    }

    #[test]
    fn quiet_says_nothing() {
        let text = recorded(Style::Quiet, |progress| {
            progress.step("linking").done();
            progress.note("kept");
        });
        assert_eq!(text, "");
    }
}
