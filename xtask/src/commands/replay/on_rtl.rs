//! `cargo xtask replay --rtl`: the FPGA's design draws, and is compared with the model.

use anyhow::{Context, bail};
use fpga_regs::packet::Packet;
use fpga_regs::screen::{HEIGHT, WIDTH};

use super::{shown, with_drawn};
use crate::cli::ReplayArguments;
use crate::picture::{write_depth_pgm, write_png};
use crate::progress::Progress;
use crate::software_fpga::picture;
use crate::stream::WordFile;
use crate::table::{Column, Table, thousands};
use crate::verilated::{Drawn, FrameCost, Job, Verilated, Wave};

/// Frames that have a line of their own in the table; more are summed up.
const LINES_MAX: usize = 20;

pub(super) fn draw(arguments: &ReplayArguments, file: &WordFile) -> anyhow::Result<()> {
    let progress = Progress::new();
    let wave = arguments.wave.clone().map(|file| Wave { file, from: arguments.from, clocks: arguments.clocks });
    let verilated = Verilated::prepare(wave.is_some(), &progress)?;
    let job = Job { words: arguments.words.clone(), units: arguments.units, pins: arguments.pins, wave };

    let swaps = file.entries().filter(|entry| entry.packet == Ok(Packet::Swap)).count();
    let step =
        progress.step(format!("drawing {} words with {} pixel units", thousands(file.words.len() as u64), job.units));
    let mut costs = Vec::new();
    let drawn = verilated.replay(&job, |cost| {
        costs.push(cost);
        step.update(&format!("frame {} of {swaps}", costs.len()));
    })?;
    step.done();

    let swapped = costs.iter().any(|cost| cost.swapped);
    match &drawn.pins {
        Some(pins) => write_png(&arguments.output, pins)?,
        None => write_png(&arguments.output, &picture(shown(&drawn.front, &drawn.back, swapped)))?,
    }
    if let Some(path) = &arguments.depth {
        write_depth_pgm(path, WIDTH, HEIGHT, &drawn.depth)?;
    }
    print!("{}", table(&costs));
    if let Some(wave) = &job.wave {
        let end = wave.from.saturating_add(wave.clocks);
        println!("wrote {}: clocks {} up to {}", wave.file.display(), thousands(wave.from), thousands(end));
    }
    compare(&drawn, file)?;
    println!("{} pixel units draw every pixel and every depth as the software model does", job.units);
    Ok(())
}

/// Holds what the design drew against the software model.
fn compare(drawn: &Drawn, file: &WordFile) -> anyhow::Result<()> {
    with_drawn(&file.words, |model| {
        for (name, found, expected) in
            [("front buffer", &drawn.front[..], model.front()), ("back buffer", &drawn.back, model.back())]
        {
            check(name, found, expected)?;
        }
        check("depth buffer", &drawn.depth, model.depth())?;
        match &drawn.pins {
            Some(pins) if *pins != picture(model.front()).doubled() => {
                bail!("the picture on the VGA pins is not the software model's front buffer")
            }
            _ => Ok(()),
        }
    })
    .context("the design is not what the model is: the pictures are written, to be looked at")
}

fn check<T: Copy + PartialEq + std::fmt::LowerHex>(name: &str, found: &[T], expected: &[T]) -> anyhow::Result<()> {
    let mut differences = found.iter().zip(expected).enumerate().filter(|(_, (found, expected))| found != expected);
    let Some((index, (found, expected))) = differences.next() else { return Ok(()) };
    let (x, y) = (index % WIDTH as usize, index / WIDTH as usize);
    let count = differences.count() + 1;
    bail!(
        "{name}: {count} pixels differ from the software model's; the first, ({x}, {y}), is {found:#x}, not {expected:#x}"
    )
}

/// A row for each frame, and the sum.
fn table(costs: &[FrameCost]) -> Table {
    let numbers = [
        "first clock",
        "clocks",
        "FIFO full",
        "words",
        "triangles",
        "pixels tested",
        "written",
        "tiles",
        "pixels/clock",
    ];
    let mut table = Table::new([Column::text("frame")].into_iter().chain(numbers.map(Column::number)));
    let mut row = |name: String, first_clock: String, cost: &FrameCost| {
        table.row([
            name,
            first_clock,
            thousands(cost.clocks),
            thousands(cost.held),
            thousands(cost.words),
            thousands(cost.triangles.into()),
            thousands(cost.pixels_tested.into()),
            thousands(cost.pixels_written.into()),
            thousands(cost.tiles),
            format!("{:.2}", f64::from(cost.pixels_tested) / cost.clocks.max(1) as f64),
        ]);
    };
    for (index, cost) in costs.iter().enumerate().take(LINES_MAX) {
        let name = if cost.swapped { index.to_string() } else { format!("{index}, no swap") };
        row(name, thousands(cost.first_clock), cost);
    }
    if costs.len() > LINES_MAX {
        row(format!("{} more", costs.len() - LINES_MAX), String::new(), &sum(&costs[LINES_MAX..]));
    }
    if costs.len() != 1 {
        row("all".into(), String::new(), &sum(costs));
    }
    table
}

fn sum(costs: &[FrameCost]) -> FrameCost {
    let long = |of: fn(&FrameCost) -> u64| costs.iter().map(of).sum();
    let short = |of: fn(&FrameCost) -> u32| costs.iter().map(of).fold(0, u32::saturating_add);
    FrameCost {
        first_clock: 0,
        clocks: long(|cost| cost.clocks),
        held: long(|cost| cost.held),
        words: long(|cost| cost.words),
        triangles: short(|cost| cost.triangles),
        pixels_tested: short(|cost| cost.pixels_tested),
        pixels_written: short(|cost| cost.pixels_written),
        tiles: long(|cost| cost.tiles),
        swapped: true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cost(first_clock: u64, swapped: bool) -> FrameCost {
        FrameCost {
            first_clock,
            clocks: 1000,
            held: 10,
            words: 200,
            triangles: 18,
            pixels_tested: 1500,
            pixels_written: 1200,
            tiles: 300,
            swapped,
        }
    }

    #[test]
    fn a_frame_is_a_line_and_long_streams_are_summed_up() {
        let text = table(&[cost(12, true), cost(1012, false)]).to_string();
        let lines: Vec<Vec<&str>> = text.lines().map(|line| line.split_whitespace().collect()).collect();
        assert_eq!(lines[2], ["0", "12", "1,000", "10", "200", "18", "1,500", "1,200", "300", "1.50"]);
        assert_eq!(lines[3][..4], ["1,", "no", "swap", "1,012"]);
        assert_eq!(lines[4], ["all", "2,000", "20", "400", "36", "3,000", "2,400", "600", "1.50"]);
        let text = table(&[cost(0, true); 25]).to_string();
        assert_eq!(text.lines().count(), 2 + LINES_MAX + 2);
        assert!(text.contains("\n5 more ") && text.contains(" 25,000 "), "{text}");
    }

    #[test]
    fn a_difference_is_told_with_its_place() {
        let (mut found, expected) = (vec![7u16; 1000], vec![7u16; 1000]);
        assert!(check("depth buffer", &found, &expected).is_ok());
        found[325] = 0xbeef;
        found[999] = 0;
        let message = check("depth buffer", &found, &expected).expect_err("two differ").to_string();
        assert_eq!(
            message,
            "depth buffer: 2 pixels differ from the software model's; the first, (5, 1), is 0xbeef, not 0x7"
        );
    }
}
