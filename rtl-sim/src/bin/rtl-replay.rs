//! Draws a file of packet words through the verilated device. `cargo xtask replay --rtl` starts it.
//!
//! Its one argument is a [`Job`] in JSON. Prints a line of JSON for each frame, a [`FrameCost`], and
//! leaves in the job's folder what the memories hold, row 0 first: `front` and `back` (RGB332, a byte
//! a pixel), `depth` (16 bits a pixel, little-endian), and with `pins` the 640×480 picture on the VGA
//! pins (`pins`: red, green, blue).

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use rtl_sim::replay::{FrameCost, replay};
use rtl_sim::{Frame, Rtl};
use serde::Deserialize;

/// What to do.
#[derive(Deserialize)]
struct Job {
    /// File of words: 32 bits each, little-endian.
    words: PathBuf,
    /// Number of pixel units: 1, 2, 4 or 8.
    units: u32,
    /// Folder for the results; it exists.
    folder: PathBuf,
    /// Whether the picture is taken from the VGA pins as well.
    pins: bool,
    /// The wave to record, if any.
    wave: Option<Wave>,
}

/// A wave.
#[derive(Deserialize)]
struct Wave {
    /// FST file to write.
    file: PathBuf,
    /// First bus clock.
    from: u64,
    /// Number of bus clocks.
    clocks: u64,
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Box<dyn Error>> {
    let job = std::env::args().nth(1).ok_or("no job: `cargo xtask replay WORDS --rtl` starts this program")?;
    let job: Job = serde_json::from_str(&job).map_err(|error| format!("`{job}` is no job: {error}"))?;
    let bytes = fs::read(&job.words).map_err(|error| format!("cannot read {}: {error}", job.words.display()))?;
    let words: Vec<u32> = bytes.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect();
    let mut rtl = Rtl::new(job.units);
    if let Some(wave) = &job.wave {
        rtl.record_wave(&wave.file, wave.from..wave.from.saturating_add(wave.clocks))?;
    }
    replay(&mut rtl, &words, |cost: FrameCost| {
        println!("{}", serde_json::to_string(&cost).expect("a cost is plain data"));
    });
    rtl.end_wave();
    let clocks = rtl.clocks();
    if let Some(wave) = job.wave.filter(|wave| wave.from >= clocks) {
        // It holds nothing, and would only puzzle a viewer.
        fs::remove_file(&wave.file)?;
        return Err(format!("the stream ends at clock {clocks}, before the wave's first clock {}", wave.from).into());
    }
    let memories = rtl.memories();
    write(&job.folder, "front", memories.front())?;
    write(&job.folder, "back", memories.back())?;
    write(&job.folder, "depth", &memories.depths.iter().flat_map(|depth| depth.to_le_bytes()).collect::<Vec<_>>())?;
    if job.pins {
        let frame = Frame::take(&mut rtl, |_| ()).map_err(|error| format!("the VGA pins: {error}"))?;
        write(&job.folder, "pins", frame.pixels().as_flattened())?;
    }
    Ok(())
}

fn write(folder: &Path, name: &str, bytes: &[u8]) -> Result<(), String> {
    let path = folder.join(name);
    fs::write(&path, bytes).map_err(|error| format!("cannot write {}: {error}", path.display()))
}
