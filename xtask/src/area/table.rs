//! The area table in `rtl/README.md`.

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, ensure};

use super::{Area, LIMITS, sources};
use crate::paths::workspace_root;
use crate::verilated::UNITS;

const README: &str = "rtl/README.md";
const BEGIN: &str = "<!-- area: written by `cargo xtask area` -->";
const END: &str = "<!-- end of area -->";
/// What stands before and behind the sources' checksum, beside the table.
const CHECKSUM: [&str; 2] = ["<!-- of sources ", " -->"];

/// Returns the block of the README for these areas, of sources with this checksum.
fn block(areas: &[Area], checksum: &str) -> String {
    let [begin, end] = CHECKSUM;
    let mut text = format!(
        "{BEGIN}\n{begin}{checksum}{end}\n\n| pixel units | ALUTs | ALMs, at least | flip-flops | M10K | DSP | longest path, cells |\n\
         | --- | --- | --- | --- | --- | --- | --- |\n"
    );
    for area in areas {
        let Area { units, aluts, flip_flops, m10k, dsp, longest_path } = area;
        let alms = area.alms_at_least();
        text.push_str(&format!("| {units} | {aluts} | {alms} | {flip_flops} | {m10k} | {dsp} | {longest_path} |\n"));
    }
    let [alms, flip_flops, m10k, dsp] = LIMITS;
    text.push_str(&format!("| 5CSEMA5 has | | {alms} | {flip_flops} | {m10k} | {dsp} | |\n{END}"));
    text
}

/// Returns the README's path and its text before, in and behind the block.
fn readme() -> anyhow::Result<(PathBuf, [String; 3])> {
    let path = workspace_root().join(README);
    let text = fs::read_to_string(&path).with_context(|| format!("cannot read {README}"))?;
    let parts = text.split_once(BEGIN).and_then(|(before, rest)| Some((before, rest.split_once(END)?)));
    let (before, (inside, behind)) =
        parts.with_context(|| format!("{README} has lost its area table: put the lines `{BEGIN}` and `{END}` back"))?;
    let parts = [before, inside, behind].map(str::to_string);
    Ok((path, parts))
}

/// Writes the block, and returns whether it was another before.
///
/// # Errors
/// When the README cannot be read or written, or has lost the lines around the block.
pub fn write(areas: &[Area]) -> anyhow::Result<bool> {
    let (path, [before, inside, behind]) = readme()?;
    let block = block(areas, &sources::checksum()?);
    let changed = format!("{BEGIN}{inside}{END}") != block;
    fs::write(&path, format!("{before}{block}{behind}")).with_context(|| format!("cannot write {README}"))?;
    Ok(changed)
}

/// Returns the areas that the README holds.
///
/// # Errors
/// When it has no such table.
pub fn committed() -> anyhow::Result<Vec<Area>> {
    let (_, [_, inside, _]) = readme()?;
    let areas: Vec<Area> = inside.lines().filter_map(parse_row).collect();
    let units: Vec<u32> = areas.iter().map(|area| area.units).collect();
    ensure!(units == UNITS, "the area table in {README} has rows for {units:?}: run `cargo xtask area`");
    Ok(areas)
}

/// Makes sure that the README's table is of the sources as they are.
///
/// # Errors
/// When it is of others, or the sources cannot be read.
pub fn ensure_fresh() -> anyhow::Result<()> {
    let (_, [_, inside, _]) = readme()?;
    let found = checksum_of(&inside).unwrap_or("none");
    let checksum = sources::checksum()?;
    ensure!(
        found == checksum,
        "the area table in {README} is of other sources (checksum {found}, now {checksum}): run `cargo xtask area`, \
         which takes some five minutes, and commit the table"
    );
    Ok(())
}

fn checksum_of(text: &str) -> Option<&str> {
    let [begin, end] = CHECKSUM;
    text.lines().find_map(|line| line.strip_prefix(begin)?.strip_suffix(end))
}

fn parse_row(line: &str) -> Option<Area> {
    let numbers: Vec<u32> = line.trim_matches('|').split('|').filter_map(|cell| cell.trim().parse().ok()).collect();
    let [units, aluts, _, flip_flops, m10k, dsp, longest_path] = *numbers.as_slice() else { return None };
    Some(Area { units, aluts, flip_flops, m10k, dsp, longest_path })
}

#[cfg(test)]
mod tests {
    use super::*;

    const AREA: Area = Area { units: 8, aluts: 8067, flip_flops: 4291, m10k: 316, dsp: 0, longest_path: 71 };

    #[test]
    fn rows_come_back_from_the_table() {
        let block = block(&[AREA], "0123456789abcdef");
        assert_eq!(block.lines().filter_map(parse_row).collect::<Vec<_>>(), [AREA], "{block}");
        assert_eq!(checksum_of(&block), Some("0123456789abcdef"), "{block}");
    }

    #[test]
    fn the_committed_table_is_of_the_design_as_it_is() {
        ensure_fresh().expect("fresh");
    }
}
