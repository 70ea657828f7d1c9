//! What more pixel units bring on real scenes: clocks of a frame in the FPGA's design, with 1, 2, 4 and 8 of them.

use std::fs;

use anyhow::{Context, ensure};

use crate::machine::{Link, with_recording_host};
use crate::measure::{Better, Measurement};
use crate::paths::TemporaryFolder;
use crate::plot::{Line, Plot};
use crate::session::{self, ScenePart};
use crate::stream::to_bytes;
use crate::table::{Column, Table, thousands};
use crate::verilated::{FrameCost, Job, UNITS, Verilated};

/// A frame, drawn with each number of units.
#[derive(Debug, Clone, PartialEq)]
pub struct Fill {
    /// The scene, and the style if it is not its own.
    pub title: String,
    /// What it cost, in the order of [`UNITS`].
    pub costs: Vec<FrameCost>,
}

impl Fill {
    /// Returns how many times as fast as with one unit the frame is drawn, in the order of [`UNITS`].
    pub fn gains(&self) -> impl Iterator<Item = f64> {
        let one = self.costs.first().map_or(0.0, |cost| cost.clocks as f64);
        self.costs.iter().map(move |cost| one / cost.clocks.max(1) as f64)
    }
}

/// Draws the last frame of each of the five systems' pictures with each number of units.
///
/// # Errors
/// When the session cannot be played, or the simulation fails.
pub fn measure(verilated: &Verilated) -> anyhow::Result<Vec<Fill>> {
    session::seeds()?.iter().map(|part| measure_part(verilated, part)).collect()
}

fn measure_part(verilated: &Verilated, part: &ScenePart) -> anyhow::Result<Fill> {
    let folder = TemporaryFolder::new().context("cannot make a temporary folder")?;
    let file = folder.path().join("words");
    fs::write(&file, to_bytes(&last_frame(part)?)).with_context(|| format!("cannot write {}", file.display()))?;
    let costs = UNITS.into_iter().map(|units| {
        let mut costs = Vec::new();
        verilated.replay(&Job { words: file.clone(), units, pins: false, wave: None }, |cost| costs.push(cost))?;
        ensure!(costs.iter().filter(|cost| cost.swapped).count() == 1, "{} is not one frame", part.title());
        Ok(costs[0])
    });
    Ok(Fill { title: part.title(), costs: costs.collect::<anyhow::Result<_>>()? })
}

/// The words of a part's last frame, from its clear to its fence.
fn last_frame(part: &ScenePart) -> anyhow::Result<Vec<u32>> {
    let (last, mut words) = with_recording_host(None, |machine| {
        let mut last = 0;
        session::play(&mut Link::new(machine), part, |frame| {
            last = frame.report.words as usize;
            Ok(())
        })?;
        Ok(last)
    })?;
    Ok(words.split_off(words.len() - last))
}

/// Returns the gains as figures.
pub fn measurements(fills: &[Fill]) -> Vec<Measurement> {
    let figure = |title: &str, units: u32, gain: f64| Measurement {
        better: Better::Higher,
        ..Measurement::new(&format!("fill.{title}.n{units}_gain"), gain, "times")
    };
    fills
        .iter()
        .flat_map(|fill| {
            UNITS.into_iter().zip(fill.gains()).skip(1).map(|(units, gain)| figure(&fill.title, units, gain))
        })
        .collect()
}

/// Returns a row for each frame.
pub fn table(fills: &[Fill]) -> Table {
    let clocks = UNITS.map(|units| Column::number(format!("clocks, {units}")));
    let gains = UNITS.map(|units| Column::number(format!("gain, {units}")));
    let first = [Column::text("frame"), Column::number("pixels tested")];
    let mut table = Table::new(first.into_iter().chain(clocks).chain(gains.into_iter().skip(1)));
    for fill in fills {
        let pixels = fill.costs.first().map_or(0, |cost| cost.pixels_tested);
        let clocks = fill.costs.iter().map(|cost| thousands(cost.clocks));
        let gains = fill.gains().skip(1).map(|gain| format!("{gain:.2}"));
        table.row([fill.title.clone(), thousands(pixels.into())].into_iter().chain(clocks).chain(gains));
    }
    table
}

/// Returns the gains as a plot.
pub fn plot(fills: &[Fill]) -> Plot {
    let points =
        |fill: &Fill| UNITS.into_iter().zip(fill.gains()).map(|(units, gain)| (f64::from(units), gain)).collect();
    Plot {
        title: "What more pixel units bring: clocks of a frame with one unit over clocks with N".into(),
        x: "pixel units".into(),
        y: "times as fast".into(),
        ticks: UNITS.map(f64::from).to_vec(),
        lines: fills.iter().map(|fill| Line { name: fill.title.clone(), points: points(fill) }).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stream::WordFile;
    use fpga_regs::packet::Packet;

    #[test]
    fn a_parts_last_frame_is_one_whole_frame() {
        let mut part = session::seeds().expect("it is committed").remove(5);
        part.frames.truncate(3);
        let file = WordFile { words: last_frame(&part).expect("it plays"), spare_bytes: 0 };
        file.check_end().expect("whole packets");
        let kinds: Vec<_> = file.entries().map(|entry| entry.packet.expect("a good packet")).collect();
        assert!(matches!(kinds[0], Packet::Clear(_)));
        assert_eq!(kinds.iter().filter(|packet| **packet == Packet::Swap).count(), 1);
        assert!(kinds.len() > 20);
    }

    #[test]
    fn a_gain_is_against_one_unit() {
        let cost = |clocks| FrameCost {
            first_clock: 0,
            clocks,
            held: 0,
            words: 0,
            triangles: 0,
            pixels_tested: 7,
            pixels_written: 0,
            tiles: 0,
            swapped: true,
        };
        let fill = Fill { title: "it".into(), costs: [800, 400, 250, 200].map(cost).to_vec() };
        assert_eq!(fill.gains().collect::<Vec<_>>(), [1.0, 2.0, 3.2, 4.0]);
        let figures = measurements(&[fill]);
        assert_eq!((figures[2].name.as_str(), figures[2].value), ("fill.it.n8_gain", 4.0));
    }
}
