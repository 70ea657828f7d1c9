//! Sessions: what a controller said, frame by frame, and playing it on a machine.
//!
//! A session file is text. `scene NAME` starts a scene; every other line that is not empty and
//! no comment (`#`) is a frame: a DualShock 3's input report of 49 bytes in hexadecimal, or `-`
//! for a frame in which the controller says nothing new.

use std::path::Path;

use anyhow::{Context, bail};
use controls::DualShock3Report;
use firmware::link::FrameReport;
use firmware::scene::Scene;

use crate::machine::{Identity, Link, Machine};
use crate::picture::Picture;

/// Where the demonstration's session lies in the workspace.
pub const DEMO: &str = "assets/demo.session";

/// A frame's report, if the controller sent one.
pub type ReportBytes = Option<[u8; DualShock3Report::LENGTH]>;

/// A scene's part of a session.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ScenePart {
    /// The scene.
    pub scene: Scene,
    /// What the controller said, a frame an element.
    pub frames: Vec<ReportBytes>,
}

/// A frame that was played.
pub struct PlayedFrame {
    /// What the board reports.
    pub report: FrameReport,
    /// Checksum of what the screen shows.
    pub screen_checksum: u32,
    /// What the screen shows.
    pub picture: Picture,
}

/// Reads a session file.
///
/// # Errors
/// When the file cannot be read or a line is malformed; the error names the line.
pub fn read(path: &Path) -> anyhow::Result<Vec<ScenePart>> {
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read the session {}", path.display()))?;
    parse(&text).with_context(|| format!("in the session {}", path.display()))
}

/// Reads the demonstration's session.
///
/// # Errors
/// As [`read`].
pub fn demo() -> anyhow::Result<Vec<ScenePart>> {
    read(&crate::paths::workspace_root().join(DEMO)).context("write it again with `cargo xtask generate`")
}

/// Parses a session's text.
///
/// # Errors
/// When a line is malformed; the error names the line.
pub fn parse(text: &str) -> anyhow::Result<Vec<ScenePart>> {
    let mut parts: Vec<ScenePart> = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let (line, number) = (line.trim(), index + 1);
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        if let Some(name) = line.strip_prefix("scene ") {
            let scene = Scene::ALL.iter().find(|scene| scene.name() == name.trim());
            let names: Vec<&str> = Scene::ALL.iter().map(|scene| scene.name()).collect();
            let scene = scene.with_context(|| format!("line {number}: no scene `{name}`: use {}", names.join(", ")))?;
            parts.push(ScenePart { scene: *scene, frames: Vec::new() });
            continue;
        }
        let report = parse_report(line).with_context(|| format!("line {number}"))?;
        match parts.last_mut() {
            Some(part) => part.frames.push(report),
            None => bail!("line {number}: a frame before the first `scene` line"),
        }
    }
    anyhow::ensure!(parts.iter().any(|part| !part.frames.is_empty()), "there is no frame in it: get the file again");
    Ok(parts)
}

fn parse_report(line: &str) -> anyhow::Result<ReportBytes> {
    if line == "-" {
        return Ok(None);
    }
    let digits: Vec<u8> = line.bytes().collect();
    let length = DualShock3Report::LENGTH;
    if digits.len() != 2 * length {
        bail!("{} characters: a report of {length} bytes has {} hexadecimal digits", digits.len(), 2 * length);
    }
    let mut report = [0; DualShock3Report::LENGTH];
    for (byte, pair) in report.iter_mut().zip(digits.chunks_exact(2)) {
        let text = str::from_utf8(pair).unwrap_or("?");
        *byte = u8::from_str_radix(text, 16).with_context(|| format!("`{text}` is no hexadecimal byte"))?;
    }
    Ok(Some(report))
}

/// Writes a session's text.
pub fn format(parts: &[ScenePart]) -> String {
    let mut text = String::new();
    for part in parts {
        text.push_str(&format!("scene {}\n", part.scene.name()));
        for frame in &part.frames {
            match frame {
                Some(report) => text.extend(report.iter().map(|byte| format!("{byte:02x}"))),
                None => text.push('-'),
            }
            text.push('\n');
        }
    }
    text
}

/// Plays a scene's part on a machine, frame by frame; `each` gets every frame once it shows.
///
/// # Errors
/// When the machine fails, or the screen shows something else than the board says it drew.
pub fn play<M: Machine + ?Sized>(
    link: &mut Link<'_, M>,
    part: &ScenePart,
    mut each: impl FnMut(PlayedFrame) -> anyhow::Result<()>,
) -> anyhow::Result<()> {
    link.begin(part.scene.index() as u8)?;
    for (index, frame) in part.frames.iter().enumerate() {
        if let Some(report) = frame {
            link.dualshock3(report)?;
        }
        let report = link.step()?;
        let (screen_checksum, picture) = link.screen()?;
        if let Some(checksum) = report.checksum.filter(|checksum| *checksum != screen_checksum) {
            bail!(
                "frame {index} of scene {}: the screen's checksum is {screen_checksum:#010x}, the framebuffer's {checksum:#010x}",
                part.scene.name()
            );
        }
        each(PlayedFrame { report, screen_checksum, picture })?;
    }
    Ok(())
}

/// Returns the instructions that a duration stands for, on a machine where each takes the same time.
pub fn instructions(ticks: u64, identity: &Identity) -> f64 {
    let nanoseconds = ticks as f64 * 1e9 / f64::from(identity.ticks_per_second);
    nanoseconds / identity.nanoseconds_per_instruction
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_session_comes_back_as_it_was_written() {
        let report = DualShock3Report::default().to_bytes();
        let parts = vec![
            ScenePart { scene: Scene::Plate, frames: vec![Some(report), None] },
            ScenePart { scene: Scene::Tunnel, frames: vec![None] },
        ];
        assert_eq!(parse(&format(&parts)).expect("what was written is read"), parts);
    }

    #[test]
    fn malformed_lines_are_named() {
        for (text, expected) in [
            ("-", "line 1: a frame before"),
            ("# nothing\nscene plate\n", "there is no frame in it"),
            ("scene cube", "no scene `cube`: use plate, torus, tunnel"),
            ("scene plate\n\n0102", "line 3: 4 characters"),
            (&format!("scene plate\n{}", "0g".repeat(49)), "`0g` is no hexadecimal byte"),
        ] {
            let message = format!("{:#}", parse(text).expect_err(text));
            assert!(message.contains(expected), "{message}");
        }
    }
}
