//! `cargo xtask replay`: draws a file of packet words through the raster model.

use std::path::Path;

use anyhow::anyhow;
use fpga_regs::registers::{Control, Register};
use fpga_regs::screen::{HEIGHT, WIDTH};

use crate::cli::ReplayArguments;
use crate::picture::{write_depth_pgm, write_png};
use crate::software_fpga::{picture, with_model};
use crate::stream::WordFile;

/// Draws the packet words.
///
/// # Errors
///
/// When the file cannot be read or is truncated (nothing is written then), or a picture cannot
/// be written.
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
    draw(&file.words, &arguments.output, arguments.depth.as_deref())?;
    println!("{packets} packets, {} words: wrote {}", file.words.len(), arguments.output.display());
    Ok(())
}

fn draw(words: &[u32], output: &Path, depth: Option<&Path>) -> anyhow::Result<()> {
    with_model(|device| {
        // Straight into the device: the driver would stop at a bad packet.
        device.write(Register::Control, Control::default().with_enable(true).0);
        device.push(words);
        if device.counters().frames_shown == 0 {
            eprintln!("note: the stream has no swap: this is the back buffer, which would not show yet");
            write_png(output, &picture(device.back()))?;
        } else {
            write_png(output, &picture(device.front()))?;
        }
        depth.map_or(Ok(()), |path| write_depth_pgm(path, WIDTH, HEIGHT, device.depth()))
    })
}
