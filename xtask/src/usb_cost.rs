//! What the USB driver costs while a pad and a keyboard are there: calls and register accesses a second.

use anyhow::{Context, ensure};

use crate::cargo_build;
use crate::measure::Measurement;

/// The test that counts on the strict model, and prints what it holds against its bars.
const TEST: [&str; 8] = ["test", "--quiet", "--package", "host-tests", "--test", "usb_driver", "whole::cost", "--"];
/// Begins a line with a figure: its name, itself, its bar.
const FIGURE: &str = "bench: ";

/// Counts.
///
/// # Errors
/// When the test does not build or fails.
pub fn measurements() -> anyhow::Result<Vec<Measurement>> {
    let mut cargo = cargo_build::cargo();
    let output = cargo.args(TEST).arg("--nocapture").output();
    let output = output.context("cannot start cargo: is Rust installed?")?;
    let text = String::from_utf8_lossy(&output.stdout);
    ensure!(
        output.status.success(),
        "the USB driver costs more than it may:\n{text}{}",
        String::from_utf8_lossy(&output.stderr)
    );
    parse(&text)
}

fn parse(text: &str) -> anyhow::Result<Vec<Measurement>> {
    let figures = text.lines().filter_map(|line| line.split_once(FIGURE));
    let measurements: Vec<Measurement> = figures
        .map(|(_, figure)| {
            let [name, value, bar] = figure.split_whitespace().collect::<Vec<_>>()[..] else {
                anyhow::bail!("{figure:?} is not a name, a figure and its bar");
            };
            let value: f64 = value.parse().with_context(|| format!("{name} is {value:?}, no number"))?;
            let bar = bar.parse().with_context(|| format!("{name}'s bar is {bar:?}, no number"))?;
            Ok(Measurement { bar: Some(bar), ..Measurement::new(name, value, "1/s") })
        })
        .collect::<anyhow::Result<_>>()?;
    ensure!(!measurements.is_empty(), "the test `whole::cost` printed no figure:\n{text}");
    Ok(measurements)
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn figures_are_read_wherever_a_line_has_them() {
        let found = parse("running 1 test\ntest a ... bench: usb.a 12 15\nbench: usb.b 3 2\n.\n").unwrap();
        let of = |index: usize| (found[index].name.as_str(), found[index].value, found[index].bar);
        assert_eq!((of(0), of(1)), (("usb.a", 12.0, Some(15.0)), ("usb.b", 3.0, Some(2.0))));
        assert_eq!(found.len(), 2);
    }

    #[test]
    fn what_is_no_figure_is_told() {
        assert!(parse("bench: usb.a\n").unwrap_err().to_string().contains("usb.a"));
        assert!(parse("bench: usb.a many 2\n").unwrap_err().to_string().contains("many"));
        assert!(parse("").unwrap_err().to_string().contains("no figure"));
    }
}
