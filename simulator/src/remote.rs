//! A machine that is ordered about in lines of JSON, for a program that has it as its child.

use std::fs::File;
use std::io::Write;
use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use crate::cache::Counts;
use crate::machine::{Event, Machine};
use crate::time::{in_milliseconds, in_nanoseconds, milliseconds};
use crate::violation::Violation;

/// What the machine is told.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Order {
    /// Send these bytes to the board over the console's line.
    Send(Vec<u8>),
    /// Run until the board has sent something, for at most so many milliseconds of virtual time.
    Receive(u64),
    /// Run until what shows has been scanned out, and write the screen to a file: 640×480, red, green, blue.
    Screen(PathBuf),
    /// Run until so many frames were shown since power-on, and say what was done by then.
    Frames(u64),
}

/// What a board has done since power-on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Done {
    /// Frames shown.
    pub frames: u64,
    /// Virtual time, in nanoseconds.
    pub nanoseconds: u64,
    /// Instructions since the last reset.
    pub instructions: u64,
    /// What was done to caches, and by bus masters.
    pub caches: Counts,
}

/// For how long a frame is waited for, in milliseconds of virtual time.
const FRAME_LIMIT: u64 = 5_000;

/// What it answers.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Answer {
    /// Done.
    Done,
    /// What the board has sent since it was asked last; nothing when the time was over.
    Received(Vec<u8>),
    /// So much was done.
    Ran(Done),
    /// The order cannot be obeyed, or the run has ended: why.
    Failed(String),
}

/// The machine.
pub struct Remote {
    machine: Machine,
    console: File,
    /// Bytes of the console's line that were written to its file, and those that were handed out.
    written: usize,
    handed: usize,
}

impl Remote {
    /// Returns a machine that takes orders; its console goes to a file as well.
    pub fn new(machine: Machine, console: File) -> Self {
        Self { machine, console, written: 0, handed: 0 }
    }

    /// Obeys a line, and returns the line that answers it.
    pub fn obey(&mut self, line: &str) -> String {
        let answer = match serde_json::from_str(line) {
            Ok(order) => self.answer(order),
            Err(error) => Answer::Failed(format!("`{line}` is no order: {error}")),
        };
        serde_json::to_string(&answer).unwrap_or_else(|error| format!("{{\"failed\":\"{error}\"}}"))
    }

    fn answer(&mut self, order: Order) -> Answer {
        let done = match order {
            Order::Send(bytes) => {
                self.machine.send(&bytes);
                Ok(Answer::Done)
            }
            Order::Receive(limit) => self.receive(limit),
            Order::Frames(count) => self.frames(count),
            Order::Screen(path) => self.machine.screen().map(|screen| match screen {
                Some(screen) => match std::fs::write(&path, screen.pixels().as_flattened()) {
                    Ok(()) => Answer::Done,
                    Err(error) => Answer::Failed(format!("cannot write {}: {error}", path.display())),
                },
                None => Answer::Failed("nothing was scanned out yet".into()),
            }),
        };
        self.write_console();
        done.unwrap_or_else(|violation| Answer::Failed(format!("the simulator stopped the program\n{violation}")))
    }

    fn receive(&mut self, limit: u64) -> Result<Answer, Violation> {
        let handed = self.handed;
        self.run(limit, |machine| machine.console().len() > handed)?;
        let bytes = self.machine.console()[handed..].to_vec();
        self.handed += bytes.len();
        Ok(Answer::Received(bytes))
    }

    fn frames(&mut self, count: u64) -> Result<Answer, Violation> {
        while self.machine.frames_shown() < count {
            let before = self.machine.frames_shown();
            self.run(FRAME_LIMIT, |machine| machine.frames_shown() > before)?;
            if self.machine.frames_shown() == before {
                return Ok(Answer::Failed(format!("no frame was shown for {FRAME_LIMIT} ms, {before} were before")));
            }
        }
        Ok(Answer::Ran(Done {
            frames: self.machine.frames_shown(),
            nanoseconds: in_nanoseconds(self.machine.now()),
            instructions: self.machine.instructions(),
            caches: self.machine.cache_counts(),
        }))
    }

    /// Runs; a reset is written to the console's file, and does not end the run.
    fn run(&mut self, time: u64, met: impl Fn(&Machine) -> bool) -> Result<(), Violation> {
        let end = self.machine.now() + milliseconds(time);
        loop {
            let left = end.saturating_sub(self.machine.now());
            let event = self.machine.run_until(left, &met)?;
            let Event::Reset(cause) = event else { return Ok(()) };
            self.write_console();
            // A full disk must not stop the board.
            let _ = writeln!(self.console, "[{:.3} ms: reset by {cause:?}]", in_milliseconds(self.machine.now()));
        }
    }

    fn write_console(&mut self) {
        let bytes = &self.machine.console()[self.written..];
        // A full disk must not stop the board.
        let _ = self.console.write_all(bytes);
        self.written += bytes.len();
    }
}
