//! The DE1-SoC's simulator: builds it and starts it, as a program of its own.
//!
//! It is not linked in, because its processor is a large crate that only this board needs, and its
//! FPGA wants Verilator where it is the true one. Orders go to it as lines of JSON, and each is
//! answered by a line.

use std::fmt;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use anyhow::{Context, bail, ensure};
use serde::{Deserialize, Serialize};

use crate::cargo_build;
use crate::paths::target_folder;
use crate::picture::Picture;
use crate::progress::Progress;
use crate::setup::{ensure_verilator, ensure_wave_library};

/// The crate of the program.
pub const CRATE: &str = "simulator";
/// Its features with the design, the same as the design's own tests are built with: so that is verilated once.
pub const RTL_FEATURES: &str = "rtl,rtl-sim/waves";
/// The program.
const PROGRAM: &str = "de1-soc-simulator";
/// Pixel units of the design that the board has.
const UNITS: u32 = 8;
/// Columns and rows of the screen.
const SCREEN: [u32; 2] = [640, 480];

/// What is in the FPGA.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Design {
    /// The software model: quick.
    Model,
    /// The SystemVerilog, verilated: exact, its picture from the VGA pins.
    Rtl,
}

/// The program, built.
#[derive(Debug, Clone)]
pub struct Simulator {
    program: PathBuf,
    design: Design,
    mesh: Option<PathBuf>,
}

/// How the program is built.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Build {
    /// With checks of its own.
    Checked,
    /// As its tests are, which leave nothing to build: with the design, whichever is wanted.
    Tested,
    /// As quick as it gets.
    Optimised,
}

/// What to run, and how.
#[derive(Serialize)]
struct Job<'a> {
    image: &'a Path,
    mesh: Option<&'a Path>,
    rtl: Option<u32>,
    console: &'a Path,
    window: bool,
}

impl Simulator {
    /// Builds the simulator with a design for its FPGA, and for a window if it shall open one.
    ///
    /// # Errors
    /// When something is missing and cannot be installed, or the build fails.
    pub fn prepare(design: Design, window: bool, build: Build, progress: &Progress) -> anyhow::Result<Self> {
        let (profile, folder) = match build {
            Build::Checked | Build::Tested => ("dev", "debug"),
            Build::Optimised => ("measure", "measure"),
        };
        let mut features = Vec::new();
        if design == Design::Rtl || build == Build::Tested {
            ensure_verilator(progress)?;
            ensure_wave_library(progress)?;
            features.push(RTL_FEATURES);
        }
        if window {
            features.push("window");
        }
        let step = progress.step("building the board's simulator, which takes a minute the first time");
        let mut cargo = cargo_build::cargo();
        cargo.args(["build", "--package", CRATE, "--bin", PROGRAM]);
        cargo.args(["--profile", profile, "--features", &features.join(",")]);
        cargo_build::run(cargo, "the simulator", &step)?;
        step.done();
        Ok(Self { program: target_folder().join(folder).join(PROGRAM), design, mesh: None })
    }

    /// Has a mesh file in the board's memory.
    #[must_use]
    pub fn with_mesh(self, mesh: Option<PathBuf>) -> Self {
        Self { mesh, ..self }
    }

    /// Powers the board on, with `image` on its card; its console goes to `console`.
    ///
    /// # Errors
    /// When the program does not start.
    pub fn start(&self, image: &Path, console: &Path) -> anyhow::Result<Running> {
        let mut child = self
            .command(image, console, false)?
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .with_context(|| format!("cannot start {}", self.program.display()))?;
        let orders = child.stdin.take().context("its input is not connected")?;
        let answers = BufReader::new(child.stdout.take().context("its output is not connected")?);
        Ok(Running { child, orders, answers })
    }

    /// Runs the board in a window until that is closed.
    ///
    /// # Errors
    /// When there is no display, or the simulator stops the firmware.
    pub fn live(&self, image: &Path, console: &Path) -> anyhow::Result<()> {
        let status = self.command(image, console, true)?.status();
        let status = status.with_context(|| format!("cannot start {}", self.program.display()))?;
        ensure!(status.success(), "the simulator ended with {status}; why stands above");
        Ok(())
    }

    fn command(&self, image: &Path, console: &Path, window: bool) -> anyhow::Result<Command> {
        let rtl = (self.design == Design::Rtl).then_some(UNITS);
        let job = serde_json::to_string(&Job { image, mesh: self.mesh.as_deref(), rtl, console, window })
            .context("cannot write the job")?;
        let mut command = Command::new(&self.program);
        command.arg(job);
        Ok(command)
    }
}

/// What the simulator is told; `simulator::remote` says what each does.
#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
enum Order<'a> {
    Send(&'a [u8]),
    Receive(u64),
    Screen(&'a Path),
    Frames(u64),
}

/// What a board has done since power-on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
pub struct Done {
    /// Frames shown.
    pub frames: u64,
    /// Virtual time, in nanoseconds.
    pub nanoseconds: u64,
    /// Instructions since the last reset.
    pub instructions: u64,
    /// What was done to caches, and by bus masters.
    pub caches: CacheCounts,
}

/// How often caches were maintained, and bus masters at work.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
pub struct CacheCounts {
    /// L1 operations by address.
    pub l1_lines: u64,
    /// L1 operations by set and way.
    pub l1_sets: u64,
    /// L2 operations by address.
    pub l2_lines: u64,
    /// L2 operations by way.
    pub l2_ways: u64,
    /// Lines that bus masters read.
    pub dma_reads: u64,
    /// Lines that bus masters wrote.
    pub dma_writes: u64,
}

impl fmt::Display for CacheCounts {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { l1_lines, l1_sets, l2_lines, l2_ways, dma_reads, dma_writes } = self;
        write!(
            out,
            "caches maintained: L1 {l1_lines} times by line and {l1_sets} by set and way, L2 {l2_lines} by line and \
             {l2_ways} by way; bus masters read {dma_reads} lines and wrote {dma_writes}"
        )
    }
}

/// What it answers.
#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
enum Answer {
    Done,
    Received(Vec<u8>),
    Ran(Done),
    Failed(String),
}

/// A board that runs.
pub struct Running {
    child: Child,
    orders: ChildStdin,
    answers: BufReader<ChildStdout>,
}

impl Running {
    /// Sends bytes to the board over its console's line.
    ///
    /// # Errors
    /// When the simulator is gone.
    pub fn send(&mut self, bytes: &[u8]) -> anyhow::Result<()> {
        self.order(&Order::Send(bytes)).map(|_| ())
    }

    /// Runs until the board has sent something, for at most so many milliseconds of the board's time,
    /// and returns it.
    ///
    /// # Errors
    /// When the simulator has stopped the firmware, with why.
    pub fn receive(&mut self, limit: u64) -> anyhow::Result<Vec<u8>> {
        match self.order(&Order::Receive(limit))? {
            Answer::Received(bytes) => Ok(bytes),
            _ => bail!("the simulator answers something else than what it received"),
        }
    }

    /// Runs until what shows now has been scanned out, and returns the screen; the file is for its way here.
    ///
    /// # Errors
    /// When the simulator has stopped the firmware, or the file cannot be read.
    pub fn screen(&mut self, file: &Path) -> anyhow::Result<Picture> {
        self.order(&Order::Screen(file))?;
        let pixels = std::fs::read(file).with_context(|| format!("cannot read {}", file.display()))?;
        Picture::new(SCREEN[0], SCREEN[1], pixels)
    }

    /// Runs until so many frames were shown since power-on, and returns what was done by then.
    ///
    /// # Errors
    /// When the simulator has stopped the firmware, or no frame came for long.
    pub fn frames(&mut self, count: u64) -> anyhow::Result<Done> {
        match self.order(&Order::Frames(count))? {
            Answer::Ran(done) => Ok(done),
            _ => bail!("the simulator answers something else than what was done"),
        }
    }

    fn order(&mut self, order: &Order<'_>) -> anyhow::Result<Answer> {
        let line = serde_json::to_string(order).context("cannot write an order")?;
        let sent = writeln!(self.orders, "{line}").and_then(|()| self.orders.flush());
        let mut answer = String::new();
        let read = sent.and_then(|()| self.answers.read_line(&mut answer));
        if read.context("the simulator does not listen any more; why stands above")? == 0 {
            bail!("the simulator ended; why stands above");
        }
        match serde_json::from_str(&answer).with_context(|| format!("the simulator answers `{}`", answer.trim()))? {
            Answer::Failed(why) => bail!("{why}"),
            answer => Ok(answer),
        }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // The end of its orders would end it, too, but not before its work is done.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
