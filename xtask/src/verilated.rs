//! The FPGA's design in Verilator: builds the programs of `rtl-sim` and starts them.
//!
//! They are programs of their own because xtask must build where there is no Verilator. A job goes
//! to them as an argument, in JSON; figures come back as lines of JSON, pictures as files.

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

use anyhow::{Context, bail, ensure};
use fpga_regs::screen::{HEIGHT, PIXELS, WIDTH};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::cargo_build;
use crate::console::Console;
use crate::measure::Measurement;
use crate::paths::{TemporaryFolder, target_folder};
use crate::picture::Picture;
use crate::progress::Progress;
use crate::setup::{ensure_verilator, ensure_wave_library};

/// The crate of the programs; no default member, as it wants Verilator.
pub const CRATE: &str = "rtl-sim";
/// The numbers of pixel units that there are builds for.
pub const UNITS: [u32; 4] = [1, 2, 4, 8];
/// Lines of a failed program's errors that are shown.
const LINES_SHOWN: usize = 15;
/// Longest time for the errors to arrive after the end.
const PATIENCE: Duration = Duration::from_secs(5);
/// Columns and rows of the picture on the VGA pins: each pixel doubled.
const PINS: [u32; 2] = [2 * WIDTH, 2 * HEIGHT];

/// The programs, built.
#[derive(Debug, Clone)]
pub struct Verilated {
    folder: PathBuf,
}

/// A stream to draw.
#[derive(Debug, Clone, Serialize)]
pub struct Job {
    /// File of words: 32 bits each, little-endian, ending behind a packet.
    pub words: PathBuf,
    /// Number of pixel units, one of [`UNITS`].
    pub units: u32,
    /// Whether the picture is taken from the VGA pins as well.
    pub pins: bool,
    /// The wave to record, if any.
    pub wave: Option<Wave>,
}

/// A wave to record.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Wave {
    /// FST file to write.
    pub file: PathBuf,
    /// First bus clock, counted from the simulation's start.
    pub from: u64,
    /// Number of bus clocks.
    pub clocks: u64,
}

/// What a frame cost; it ends with a swap, or with the stream.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
pub struct FrameCost {
    /// The bus clock in which it began, counted from the simulation's start.
    pub first_clock: u64,
    /// Bus clocks from its first word until it was drawn.
    pub clocks: u64,
    /// Of them, those in which a word had to wait because the FIFO was full.
    pub held: u64,
    /// Its words.
    pub words: u64,
    /// Triangles drawn.
    pub triangles: u32,
    /// Pixels tested against the depth buffer.
    pub pixels_tested: u32,
    /// Pixels of them that were written.
    pub pixels_written: u32,
    /// Tiles visited, those of clears among them.
    pub tiles: u64,
    /// Whether it ended with a swap.
    pub swapped: bool,
}

/// What the device's memories hold after a stream, row 0 first.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Drawn {
    /// The buffer that shows, RGB332.
    pub front: Vec<u8>,
    /// The buffer that is drawn to, RGB332.
    pub back: Vec<u8>,
    /// The depths; 0 is near.
    pub depth: Vec<u16>,
    /// The 640×480 picture on the VGA pins, if it was wanted.
    pub pins: Option<Picture>,
}

impl Verilated {
    /// Makes sure of Verilator and builds the programs; with `waves` so that they can record some.
    ///
    /// # Errors
    /// When something is missing and cannot be installed, or the build fails.
    pub fn prepare(waves: bool, progress: &Progress) -> anyhow::Result<Self> {
        ensure_verilator(progress)?;
        if waves {
            ensure_wave_library(progress)?;
        }
        let step = progress.step("building the FPGA's design with Verilator, which takes a minute the first time");
        let mut cargo = cargo_build::cargo();
        cargo.args(["build", "--package", CRATE, "--bins"]);
        cargo.args(waves.then_some(["--features", "waves"]).iter().flatten());
        cargo_build::run(cargo, "the FPGA's design", &step)?;
        step.done();
        Ok(Self::at(target_folder().join("debug")))
    }

    /// Takes programs that are built already, and lie in `folder`.
    pub fn at(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into() }
    }

    /// Draws a stream; `each` gets what a frame cost as soon as it is drawn.
    ///
    /// # Errors
    /// When the program fails, with what it says, or leaves something else than pictures.
    pub fn replay(&self, job: &Job, each: impl FnMut(FrameCost)) -> anyhow::Result<Drawn> {
        /// A job, and where its results go.
        #[derive(Serialize)]
        struct Order<'a> {
            #[serde(flatten)]
            job: &'a Job,
            folder: &'a Path,
        }
        let folder = TemporaryFolder::new().context("cannot make a temporary folder")?;
        let order = serde_json::to_string(&Order { job, folder: folder.path() }).context("cannot write the job")?;
        self.run("rtl-replay", &[&order], each)?;
        let read = |name: &str, expected: usize| {
            let path = folder.path().join(name);
            let bytes = fs::read(&path).with_context(|| format!("cannot read {}", path.display()))?;
            ensure!(bytes.len() == expected, "{name}: {} bytes instead of {expected}", bytes.len());
            Ok(bytes)
        };
        let [width, height] = PINS;
        let pins = job.pins.then(|| Picture::new(width, height, read("pins", (3 * width * height) as usize)?));
        Ok(Drawn {
            front: read("front", PIXELS)?,
            back: read("back", PIXELS)?,
            depth: read("depth", 2 * PIXELS)?.as_chunks().0.iter().map(|bytes| u16::from_le_bytes(*bytes)).collect(),
            pins: pins.transpose()?,
        })
    }

    /// Measures how many clocks work takes.
    ///
    /// # Errors
    /// As [`replay`](Self::replay).
    pub fn bench(&self) -> anyhow::Result<Vec<Measurement>> {
        let mut measurements = Vec::new();
        self.run("rtl-bench", &[], |measurement| measurements.push(measurement))?;
        Ok(measurements)
    }

    /// Runs a program and hands over each line that it prints.
    fn run<T: DeserializeOwned>(
        &self,
        program: &str,
        arguments: &[&str],
        mut each: impl FnMut(T),
    ) -> anyhow::Result<()> {
        let path = self.folder.join(program);
        let mut child = Command::new(&path)
            .args(arguments)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .with_context(|| format!("cannot start {}", path.display()))?;
        let output = child.stdout.take().context("its output is not connected")?;
        let errors = child.stderr.take().context("its errors are not connected")?;
        let said = Console::start(errors, Vec::new()).context("cannot start a thread")?;
        let mut others = String::new();
        for line in BufReader::new(output).lines() {
            let line = line.with_context(|| format!("cannot read what {program} says"))?;
            match serde_json::from_str(&line) {
                Ok(value) => each(value),
                // Verilator tells of a failed assertion in this way, before it stops.
                Err(_) => others.push_str(&format!("    {line}\n")),
            }
        }
        let status = child.wait().with_context(|| format!("cannot wait for {program}"))?;
        if !status.success() {
            said.wait_for_end(PATIENCE);
            bail!("{program} failed ({status}):\n{others}{}", said.last_lines(LINES_SHOWN));
        }
        Ok(())
    }
}
