//! The firmware's console: every line it prints, kept for those who wait for one or explain a failure.

use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Read, Write};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// Lines that are kept; firmware that prints for ever must not fill the memory.
const LINES_KEPT: usize = 10_000;
/// A line that is longer is cut into several.
const LINE_BYTES: u64 = 4_096;

/// What a console printed so far; a thread adds to it. Clones share it.
#[derive(Clone, Default)]
pub struct Console {
    shared: Arc<Shared>,
}

#[derive(Default)]
struct Shared {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    lines: VecDeque<String>,
    ended: bool,
}

impl Console {
    /// Starts to read `stream`; each line also goes to all of `copies` (a file, standard output).
    ///
    /// # Errors
    ///
    /// When the system gives no thread.
    pub fn start(stream: impl Read + Send + 'static, copies: Vec<Box<dyn Write + Send>>) -> std::io::Result<Self> {
        let console = Self::default();
        let reader = console.clone();
        thread::Builder::new().name("console".into()).spawn(move || reader.read(stream, copies))?;
        Ok(console)
    }

    fn read(&self, stream: impl Read, mut copies: Vec<Box<dyn Write + Send>>) {
        let mut stream = BufReader::new(stream);
        let mut bytes = Vec::new();
        while let Ok(1..) = stream.by_ref().take(LINE_BYTES).read_until(b'\n', &mut bytes) {
            let line = String::from_utf8_lossy(bytes.trim_ascii_end()).into_owned();
            bytes.clear();
            // A copy that can no longer be written (a closed terminal) must not stop the firmware.
            copies.retain_mut(|copy| writeln!(copy, "{line}").and_then(|()| copy.flush()).is_ok());
            let mut state = self.state();
            if state.lines.len() == LINES_KEPT {
                state.lines.pop_front();
            }
            state.lines.push_back(line);
            self.shared.changed.notify_all();
        }
        self.state().ended = true;
        self.shared.changed.notify_all();
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.shared.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for a line that `wanted` accepts, among those printed already too, and returns it;
    /// `None` when the time is over or the console ended without it.
    pub fn wait_for(&self, limit: Duration, wanted: impl Fn(&str) -> bool) -> Option<String> {
        let deadline = Instant::now() + limit;
        let mut state = self.state();
        loop {
            if let Some(line) = state.lines.iter().find(|line| wanted(line)) {
                return Some(line.clone());
            }
            let left = deadline.saturating_duration_since(Instant::now());
            if state.ended || left.is_zero() {
                return None;
            }
            state = self.shared.changed.wait_timeout(state, left).unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    /// Waits until the console has ended, which it does with QEMU; `false` when the time is over.
    pub fn wait_for_end(&self, limit: Duration) -> bool {
        let waited = self.shared.changed.wait_timeout_while(self.state(), limit, |state| !state.ended);
        waited.unwrap_or_else(PoisonError::into_inner).0.ended
    }

    /// Returns the lines so far, the last 10,000 of them.
    pub fn lines(&self) -> Vec<String> {
        self.state().lines.iter().cloned().collect()
    }

    /// Returns the last lines, indented, for an error message.
    pub fn last_lines(&self, count: usize) -> String {
        let state = self.state();
        if state.lines.is_empty() {
            return "    (nothing)".into();
        }
        let skipped = state.lines.len().saturating_sub(count);
        state.lines.iter().skip(skipped).map(|line| format!("    {line}")).collect::<Vec<_>>().join("\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;
    use std::os::unix::net::UnixStream;

    const MINUTE: Duration = Duration::from_secs(60);

    #[test]
    fn lines_are_kept_and_found() {
        let text = "one\r\ntwo \u{fffd}\nlast without end";
        let console = Console::start(Cursor::new(text), Vec::new()).expect("a thread");
        assert!(console.wait_for_end(MINUTE));
        assert_eq!(console.lines(), ["one", "two \u{fffd}", "last without end"]);
        assert_eq!(console.wait_for(MINUTE, |line| line.starts_with("two")).as_deref(), Some("two \u{fffd}"));
        assert_eq!(console.wait_for(MINUTE, |line| line == "three"), None);
        assert_eq!(console.last_lines(2), "    two \u{fffd}\n    last without end");
    }

    #[test]
    fn a_line_that_comes_later_is_waited_for() {
        let (mut guest, host) = UnixStream::pair().expect("sockets");
        let console = Console::start(host, Vec::new()).expect("a thread");
        assert_eq!(console.last_lines(3), "    (nothing)");
        assert_eq!(console.wait_for(Duration::from_millis(20), |_| true), None);
        let waiting = console.clone();
        let waiter = thread::spawn(move || waiting.wait_for(MINUTE, |line| line == "ready"));
        guest.write_all(b"boot\nready\n").expect("the console reads");
        assert_eq!(waiter.join().expect("no panic").as_deref(), Some("ready"));
    }

    #[test]
    fn memory_is_bounded() {
        let endless = std::io::repeat(b'x').take(LINE_BYTES * 3).chain(Cursor::new("\ny".repeat(LINES_KEPT + 5)));
        let console = Console::start(endless, Vec::new()).expect("a thread");
        assert!(console.wait_for_end(MINUTE));
        assert_eq!(console.lines().len(), LINES_KEPT);
        assert!(console.lines().iter().all(|line| line == "y"));
    }
}
