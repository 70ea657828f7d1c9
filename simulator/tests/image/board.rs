//! The board with the image, and what a person at it sees.

use std::path::PathBuf;

use simulator::devices::ResetCause;
use simulator::time::milliseconds;
use simulator::{Event, Image, Machine, PowerOn};

/// What names the raw binary.
const BINARY: &str = "HALFSPACE_BINARY";
/// Longest time from power-on to the first frame, in milliseconds.
const START: u64 = 300;
/// Longest time that a frame may take, in milliseconds.
const FRAME: u64 = 100;

/// Returns the image, from its ELF file.
pub fn image() -> Image {
    named("HALFSPACE_IMAGE")
}

/// Returns the image as the card has it, a raw binary.
pub fn binary() -> Image {
    named(BINARY)
}

/// Returns the raw binary with each of its words as `change` makes it.
pub fn changed(mut change: impl FnMut(u32) -> u32) -> Image {
    let path = path(BINARY);
    let bytes = std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let words = bytes.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]));
    Image::from_binary(words.flat_map(|word| change(word).to_le_bytes()).collect())
}

fn path(variable: &str) -> PathBuf {
    let path = std::env::var_os(variable)
        .unwrap_or_else(|| panic!("{variable} names no image: `cargo xtask test --only simulator` builds it"));
    PathBuf::from(path)
}

fn named(variable: &str) -> Image {
    let path = path(variable);
    Image::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The board, and how much of its console was read.
pub struct Board {
    pub machine: Machine,
    read: usize,
}

impl Board {
    /// Turns a board on.
    pub fn start(power_on: PowerOn) -> Self {
        Self { machine: power_on.start(), read: 0 }
    }

    /// Turns a board on and waits until the program has found the FPGA. Its first frame is a while off.
    pub fn connected() -> Self {
        let mut board = Self::start(PowerOn::new(image()));
        board.connects();
        board
    }

    /// Turns a board on and waits for its first frame.
    pub fn draws() -> Self {
        let mut board = Self::connected();
        board.first_frame();
        board
    }

    /// Returns what the console said since it was read last.
    pub fn unread(&self) -> String {
        String::from_utf8_lossy(&self.machine.console()[self.read..]).into_owned()
    }

    /// Waits for words on the console, and reads up to their end.
    #[track_caller]
    pub fn says(&mut self, within: u64, words: &str) {
        let (words, read) = (words.as_bytes(), self.read);
        let find = |machine: &Machine| {
            machine.console()[read..].windows(words.len()).position(|window| window == words).map(|at| read + at)
        };
        let event = self.machine.run_until(milliseconds(within), |machine| find(machine).is_some());
        match (event, find(&self.machine)) {
            (Ok(_), Some(at)) => self.read = at + words.len(),
            (other, _) => self.fail(&format!("waited {within} ms for `{}`; {other:?}", String::from_utf8_lossy(words))),
        }
    }

    /// Waits until the program has found the FPGA.
    #[track_caller]
    pub fn connects(&mut self) {
        self.says(START, "bridges open");
    }

    /// Waits for the first frame after a start.
    #[track_caller]
    pub fn first_frame(&mut self) {
        self.says(START, "first frame after");
    }

    /// Waits for more frames, each in time.
    #[track_caller]
    pub fn frames(&mut self, count: u64) {
        for _ in 0..count {
            let wanted = self.machine.frames_shown() + 1;
            match self.machine.run_until_frame(milliseconds(FRAME), wanted) {
                Ok(Event::Met) => {}
                other => self.fail(&format!("no frame in {FRAME} ms; {other:?}")),
            }
        }
    }

    /// Waits for a reset, after which all of the console before counts as read.
    #[track_caller]
    pub fn resets(&mut self, within: u64, cause: ResetCause) {
        match self.machine.run(milliseconds(within)) {
            Ok(Event::Reset(found)) if found == cause => self.read = self.machine.console().len(),
            other => self.fail(&format!("no reset by {cause:?} in {within} ms; {other:?}")),
        }
    }

    /// Lets time pass in which nothing may reset the board or stop it.
    #[track_caller]
    pub fn passes(&mut self, time: u64) {
        match self.machine.run(milliseconds(time)) {
            Ok(Event::Limit) => {}
            other => self.fail(&format!("{time} ms should pass; {other:?}")),
        }
    }

    /// Returns how often the HPS LED goes on in a round of its flashes, two seconds.
    #[track_caller]
    pub fn flashes(&mut self) -> usize {
        self.flashes_in(2_000)
    }

    /// Returns how often the HPS LED goes on in so many milliseconds.
    #[track_caller]
    pub fn flashes_in(&mut self, time: u64) -> usize {
        // The console's line ends first.
        self.passes(30);
        let mut lit = self.machine.hardware(|hardware| hardware.hps_led());
        let mut flashes = 0;
        for _ in 0..time / 10 {
            self.passes(10);
            let now = self.machine.hardware(|hardware| hardware.hps_led());
            flashes += usize::from(now && !lit);
            lit = now;
        }
        flashes
    }

    /// Presses the HPS key for a moment, once what is being said was said.
    #[track_caller]
    pub fn press_hps_key(&mut self) {
        self.passes(30);
        self.machine.hardware(|hardware| hardware.set_hps_key(true));
        self.passes(5);
        self.machine.hardware(|hardware| hardware.set_hps_key(false));
    }

    /// Ends the test with all that the console said.
    #[track_caller]
    pub fn fail(&self, why: &str) -> ! {
        panic!("{why}\nthe console said:\n{}", self.machine.console_text())
    }
}
