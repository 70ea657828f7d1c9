//! The DE1-SoC in its simulator as a machine.

use std::collections::VecDeque;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};

use super::Machine;
use crate::picture::Picture;
use crate::simulated::{Running, Simulator};
use crate::software_fpga::buffer_of_screen;

/// How long the board may take to answer, in milliseconds of its own time.
const PATIENCE: u64 = 5_000;
/// What an instruction takes of the board's time: a clock of 800 MHz.
const NANOSECONDS_PER_INSTRUCTION: f64 = 1.25;
/// Bytes of the console's end that an error shows.
const SHOWN: usize = 2_000;

/// A board in the simulator.
pub struct Simulated {
    board: Running,
    console: PathBuf,
    screen: PathBuf,
    received: VecDeque<u8>,
}

impl Simulated {
    /// Powers a board on, and waits until the firmware greets. The console goes to `console.txt` in `folder`.
    ///
    /// # Errors
    /// When the simulator does not start, stops the firmware, or the firmware does not greet in time.
    pub fn start(simulator: &Simulator, image: &Path, folder: &Path) -> anyhow::Result<Self> {
        fs::create_dir_all(folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
        let console = folder.join("console.txt");
        let board = simulator.start(image, &console)?;
        let mut machine = Self { board, console, screen: folder.join("screen"), received: VecDeque::new() };
        let greeting = b"first frame";
        let mut said = Vec::new();
        while !said.windows(greeting.len()).any(|part| part == greeting) {
            said.push(machine.receive("the firmware to start")?);
        }
        Ok(machine)
    }
}

impl Machine for Simulated {
    fn send(&mut self, bytes: &[u8]) -> anyhow::Result<()> {
        self.board.send(bytes)
    }

    fn receive(&mut self, what: &str) -> anyhow::Result<u8> {
        if self.received.is_empty() {
            self.received.extend(self.board.receive(PATIENCE)?);
        }
        match self.received.pop_front() {
            Some(byte) => Ok(byte),
            None => {
                let said = fs::read(&self.console).unwrap_or_default();
                let end = String::from_utf8_lossy(&said[said.len().saturating_sub(SHOWN)..]).into_owned();
                bail!("nothing came within {PATIENCE} ms of the board's time; waited for {what}; console:\n{end}")
            }
        }
    }

    fn screen(&mut self) -> anyhow::Result<(u32, Picture)> {
        let picture = self.board.screen(&self.screen)?;
        Ok((raster_model::picture_checksum(&buffer_of_screen(&picture)?), picture))
    }

    fn nanoseconds_per_instruction(&self) -> f64 {
        NANOSECONDS_PER_INSTRUCTION
    }

    fn end(mut self: Box<Self>) -> anyhow::Result<()> {
        // No frame more than there were.
        println!("{}", self.board.frames(0)?.caches);
        Ok(())
    }
}
