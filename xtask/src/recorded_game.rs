//! The recorded game, replayed: its points on the whole way, and pictures of its beginning.
//!
//! The round takes some 3,700 frames. Their points come from the application's viewer, without a picture; the first
//! [`PLAYED_FRAMES`] are drawn, on this computer and on a board, points and pictures.

use anyhow::{Context, ensure};
use controls::Report;
use firmware::intake::Intake;
use firmware::viewer::Viewer;
use serde::{Deserialize, Serialize};

use crate::machine::{Link, Machine, with_host};
use crate::paths::workspace_root;
use crate::session::ScenePart;

/// Where the golden record lies in the workspace.
pub const GOLDEN: &str = "host-tests/golden/game.json";
/// Frames that are drawn: with a pause and several targets.
pub const PLAYED_FRAMES: usize = 420;
/// Frames from one picture that is looked at to the next.
const PICTURE_FRAMES: usize = 60;

/// What a game came to.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Record {
    /// Frames that were played.
    pub frames: usize,
    /// A frame and the points after it, wherever they changed.
    pub points: Vec<(usize, u32)>,
    /// A frame and the checksum of its picture.
    pub pictures: Vec<(usize, String)>,
}

impl Record {
    /// Plays a game on this computer: whole for its points, its beginning for its pictures.
    ///
    /// # Errors
    /// When the session has not one part, or the application does not start.
    pub fn of(parts: &[ScenePart]) -> anyhow::Result<Self> {
        let part = only(parts)?;
        let drawn = with_host(|machine| play(machine, parts))?;
        let points = changes(points_of(part)?);
        Ok(Self { frames: part.frames.len(), points, pictures: drawn.pictures })
    }

    /// Returns the points at the end.
    pub fn score(&self) -> u32 {
        self.points.last().map_or(0, |(_, points)| *points)
    }

    /// Reads the golden record.
    ///
    /// # Errors
    /// When it is missing or malformed.
    pub fn read() -> anyhow::Result<Self> {
        let text = std::fs::read_to_string(workspace_root().join(GOLDEN))
            .with_context(|| format!("cannot read {GOLDEN}: write it with `cargo xtask generate --golden`"))?;
        serde_json::from_str(&text).with_context(|| format!("{GOLDEN} is malformed"))
    }

    /// Makes this the golden record.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn write(&self) -> anyhow::Result<()> {
        let text = serde_json::to_string(self).context("cannot put the game's record into JSON")? + "\n";
        std::fs::write(workspace_root().join(GOLDEN), text).with_context(|| format!("cannot write {GOLDEN}"))
    }

    /// Checks that another run of the same length came to the same.
    ///
    /// # Errors
    /// The first difference.
    pub fn check(&self, run: &Self) -> anyhow::Result<()> {
        ensure!(run.frames == self.frames, "{} frames were played, the golden game has {}", run.frames, self.frames);
        run.check_against(self)
    }

    /// Checks that this run, which may be shorter, went as the golden one.
    ///
    /// # Errors
    /// The first difference.
    pub fn check_against(&self, golden: &Self) -> anyhow::Result<()> {
        let expected: Vec<_> = golden.points.iter().filter(|(frame, _)| *frame < self.frames).collect();
        for (found, expected) in self.points.iter().zip(&expected) {
            ensure!(found == *expected, "(frame, points) {found:?}, the golden game has {expected:?}");
        }
        let (found, expected) = (self.points.len(), expected.len());
        ensure!(found == expected, "the points change {found} times, in the golden game {expected} times");
        ensure!(self.pictures == golden.pictures, "pictures {:?}, golden {:?}", self.pictures, golden.pictures);
        Ok(())
    }
}

/// Plays a game's beginning on a machine, and draws it.
///
/// # Errors
/// When the session has not one part, or the machine fails.
pub fn play(machine: &mut (impl Machine + ?Sized), parts: &[ScenePart]) -> anyhow::Result<Record> {
    let part = only(parts)?;
    let mut link = Link::new(machine);
    link.begin(part.scene.index() as u8)?;
    let (mut points, mut pictures) = (Vec::new(), Vec::new());
    let frames = part.frames.len().min(PLAYED_FRAMES);
    for (frame, report) in part.frames[..frames].iter().enumerate() {
        if let Some(report) = report {
            link.dualshock3(report)?;
        }
        let drawn = link.step()?;
        points.push(drawn.score.context("the board plays no game: build its firmware again")?);
        if frame % PICTURE_FRAMES == 0 {
            let (checksum, _) = link.screen()?;
            pictures.push((frame, format!("{checksum:#010x}")));
        }
    }
    Ok(Record { frames, points: changes(points), pictures })
}

/// The points after every frame, without a picture.
fn points_of(part: &ScenePart) -> anyhow::Result<Vec<u32>> {
    let (mut intake, mut viewer) = (Intake::new(), Viewer::new(part.scene));
    let mut points = Vec::with_capacity(part.frames.len());
    for report in &part.frames {
        if let Some(report) = report {
            intake.accept(Report::DualShock3(report)).map_err(|error| anyhow::anyhow!("{error}"))?;
        }
        viewer.update(&intake.state());
        intake.end_frame();
        points.push(viewer.score().context("the recorded game's scene is no game")?);
    }
    Ok(points)
}

/// Where the points change, and to what.
fn changes(points: Vec<u32>) -> Vec<(usize, u32)> {
    let before = std::iter::once(&0).chain(&points);
    points
        .iter()
        .zip(before)
        .enumerate()
        .filter(|(_, (now, before))| now != before)
        .map(|(at, (now, _))| (at, *now))
        .collect()
}

fn only(parts: &[ScenePart]) -> anyhow::Result<&ScenePart> {
    match parts {
        [part] => Ok(part),
        _ => anyhow::bail!("the recorded game has {} scenes, not one", parts.len()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(frames: usize, points: &[(usize, u32)]) -> Record {
        Record { frames, points: points.to_vec(), pictures: vec![(0, "0x1".to_string())] }
    }

    #[test]
    fn a_run_may_be_shorter_but_not_different() {
        let golden = record(100, &[(10, 79), (20, 225), (90, 300)]);
        assert_eq!(changes(vec![0, 0, 79, 79, 225]), [(2, 79), (4, 225)]);
        assert_eq!(golden.score(), 300);
        let check = |run: &Record| run.check_against(&golden).map_err(|error| error.to_string());
        assert_eq!(check(&record(50, &[(10, 79), (20, 225)])), Ok(()));
        for (run, expected) in [
            (record(50, &[(10, 79), (21, 225)]), "(frame, points) (21, 225), the golden game has (20, 225)"),
            (record(50, &[(10, 79)]), "the points change 1 times, in the golden game 2 times"),
            (record(100, &[(10, 79), (20, 225)]), "the points change 2 times, in the golden game 3 times"),
            (Record { pictures: vec![], ..record(5, &[]) }, "pictures [], golden"),
        ] {
            let message = check(&run).expect_err("a difference");
            assert!(message.starts_with(expected), "{message}");
        }
        assert!(golden.check(&record(50, &[(10, 79), (20, 225)])).is_err(), "too short");
    }
}
