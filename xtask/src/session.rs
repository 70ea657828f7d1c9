//! Sessions: what a controller said, frame by frame, and playing it on a machine.
//!
//! A session file is text. `scene NAME` starts a scene in its own style, `scene NAME STYLE` in another; every other line that is not empty and
//! no comment (`#`) is a frame: a DualShock 3's input report of 49 bytes in hexadecimal, or `-`
//! for a frame in which the controller says nothing new.

use std::path::Path;

use anyhow::{Context, bail};
use controls::DualShock3Report;
use firmware::link::FrameReport;
use firmware::scene::Scene;
use firmware::style::Style;

use crate::machine::{Identity, Link, Machine};
use crate::picture::Picture;

/// Where the demonstration's session lies in the workspace.
pub const DEMO: &str = "assets/demo.session";
/// Where the session of the five systems lies in the workspace.
pub const SEEDS: &str = "assets/seeds.session";

/// Where the recorded game lies in the workspace.
pub const GAME: &str = "assets/game.session";

/// A frame's report, if the controller sent one.
pub type ReportBytes = Option<[u8; DualShock3Report::LENGTH]>;

/// A scene's part of a session.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ScenePart {
    /// The scene.
    pub scene: Scene,
    /// The style, if not the scene's own.
    pub style: Option<Style>,
    /// What the controller said, a frame an element.
    pub frames: Vec<ReportBytes>,
}

impl ScenePart {
    /// Returns the scene's name and, where it is not its own, the style's, with no space in them.
    pub fn title(&self) -> String {
        match self.style {
            None => self.scene.name().to_string(),
            Some(style) => format!("{}-{}", self.scene.name(), style.name().replace(' ', "-")),
        }
    }
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

/// Reads the session of the five systems.
///
/// # Errors
/// As [`read`].
pub fn seeds() -> anyhow::Result<Vec<ScenePart>> {
    read(&crate::paths::workspace_root().join(SEEDS)).context("write it again with `cargo xtask generate`")
}

/// Reads the recorded game.
///
/// # Errors
/// As [`read`].
pub fn game() -> anyhow::Result<Vec<ScenePart>> {
    read(&crate::paths::workspace_root().join(GAME)).context("write it again with `cargo xtask generate`")
}

/// Reads all of them, the recorded game first.
///
/// # Errors
/// As [`read`].
pub fn all() -> anyhow::Result<Vec<ScenePart>> {
    Ok([game()?, seeds()?, demo()?].concat())
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
        if let Some(words) = line.strip_prefix("scene ") {
            let (name, style) = words.trim().split_once(' ').unwrap_or((words.trim(), ""));
            let scene = scene_named(name).with_context(|| format!("line {number}"))?;
            let style = match style.trim() {
                "" => None,
                style => Some(style_named(style).with_context(|| format!("line {number}"))?),
            };
            parts.push(ScenePart { scene, style, frames: Vec::new() });
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

/// Returns the scene of a name.
///
/// # Errors
/// When there is none, with those that there are.
pub fn scene_named(name: &str) -> anyhow::Result<Scene> {
    let names: Vec<&str> = Scene::ALL.iter().map(|scene| scene.name()).collect();
    let scene = Scene::ALL.iter().find(|scene| scene.name() == name);
    scene.copied().with_context(|| format!("no scene `{name}`: use {}", names.join(", ")))
}

/// Returns the style of a name; a hyphen may stand for a space.
///
/// # Errors
/// When there is none, with those that there are.
pub fn style_named(name: &str) -> anyhow::Result<Style> {
    let names: Vec<String> = Style::ALL.iter().map(|style| style.name().replace(' ', "-")).collect();
    let index = names.iter().position(|known| *known == name.replace(' ', "-"));
    let style = index.and_then(Style::from_index);
    style.with_context(|| format!("no style `{name}`: use {}", names.join(", ")))
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
        let style = part.style.map(|style| format!(" {}", style.name())).unwrap_or_default();
        text.push_str(&format!("scene {}{style}\n", part.scene.name()));
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
    if let Some(style) = part.style {
        link.show(None, Some(style))?;
    }
    for (index, frame) in part.frames.iter().enumerate() {
        if let Some(report) = frame {
            link.dualshock3(report)?;
        }
        let report = link.step()?;
        let (screen_checksum, picture) = link.screen()?;
        if let Some(checksum) = report.checksum.filter(|checksum| *checksum != screen_checksum) {
            bail!(
                "frame {index} of scene {}: the screen's checksum is {screen_checksum:#010x}, the framebuffer's {checksum:#010x}",
                part.title()
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
            ScenePart { scene: Scene::Plate, style: None, frames: vec![Some(report), None] },
            ScenePart { scene: Scene::Tunnel, style: Some(Style::HiddenLines), frames: vec![None] },
        ];
        assert_eq!(parse(&format(&parts)).expect("what was written is read"), parts);
    }

    #[test]
    fn malformed_lines_are_named() {
        for (text, expected) in [
            ("-", "line 1: a frame before"),
            ("# nothing\nscene plate\n", "there is no frame in it"),
            ("scene cube", "no scene `cube`: use plate, torus, tunnel"),
            ("scene plate pink", "no style `pink`: use flat, smooth, wireframe, hidden-lines, depth-as-grey"),
            ("scene plate\n\n0102", "line 3: 4 characters"),
            (&format!("scene plate\n{}", "0g".repeat(49)), "`0g` is no hexadecimal byte"),
        ] {
            let message = format!("{:#}", parse(text).expect_err(text));
            assert!(message.contains(expected), "{message}");
        }
    }
}
