//! `cargo xtask replay`: draws a file of packet words through the raster model, or the FPGA's design.

mod on_rtl;

use std::path::Path;

use anyhow::anyhow;
use fpga_regs::registers::{Control, Register};
use fpga_regs::screen::{HEIGHT, WIDTH};
use raster_model::Device;

use crate::cli::ReplayArguments;
use crate::picture::{write_depth_pgm, write_png};
use crate::software_fpga::{picture, with_model};
use crate::stream::WordFile;
use crate::table::thousands;

/// Draws the packet words.
///
/// # Errors
///
/// When the file cannot be read or is truncated (nothing is written then), or a picture cannot
/// be written; with `--rtl` also when something is missing that cannot be installed, or the design
/// draws something else than the model.
pub fn run(arguments: &ReplayArguments) -> anyhow::Result<()> {
    let file = WordFile::read(&arguments.words)?;
    let name = arguments.words.display();
    file.check_end().map_err(|truncated| anyhow!("{name}: {truncated}"))?;
    let (mut packets, mut bad) = (0, Vec::new());
    for entry in file.entries() {
        packets += 1;
        bad.extend(entry.packet.err().map(|reason| (entry.word, reason)));
    }
    if let Some((word, reason)) = bad.first() {
        eprintln!("warning: {} bad packets were skipped; the first, at word {word}: {reason}", bad.len());
    }
    if arguments.rtl {
        on_rtl::draw(arguments, &file)?;
    } else {
        with_drawn(&file.words, |device| save(device, &arguments.output, arguments.depth.as_deref()))?;
    }
    let words = thousands(file.words.len() as u64);
    println!("{} packets, {words} words: wrote {}", thousands(packets), arguments.output.display());
    Ok(())
}

/// Lends the model, with all words drawn, to `work`.
fn with_drawn<R>(words: &[u32], work: impl FnOnce(&Device<'_>) -> R) -> R {
    with_model(|device| {
        // Straight into the device: the driver would stop at a bad packet.
        device.write(Register::Control, Control::default().with_enable(true).0);
        device.push(words);
        work(device)
    })
}

fn save(device: &Device<'_>, output: &Path, depth: Option<&Path>) -> anyhow::Result<()> {
    write_png(output, &picture(shown(device.front(), device.back(), device.counters().frames_shown > 0)))?;
    depth.map_or(Ok(()), |path| write_depth_pgm(path, WIDTH, HEIGHT, device.depth()))
}

/// Returns the buffer to show: the front one, or without a swap the back one, with a note.
fn shown<'a>(front: &'a [u8], back: &'a [u8], swapped: bool) -> &'a [u8] {
    if swapped {
        return front;
    }
    eprintln!("note: the stream has no swap: this is the back buffer, which would not show yet");
    back
}
