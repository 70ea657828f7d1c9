//! The demonstration session, played on a machine.

use anyhow::ensure;

use crate::machine::{Link, Machine};
use crate::picture::Picture;
use crate::progress::Progress;
use crate::report::{Report, SceneReport};
use crate::session::{self, ScenePart};

/// What came of it.
pub struct Played {
    /// The sums.
    pub report: Report,
    /// Every frame: its scene's name, its number in the scene, what the screen showed.
    pub pictures: Vec<(String, usize, Picture)>,
}

/// Plays a session's parts on a machine.
///
/// # Errors
/// When the machine fails, or shows something else than the board says it drew.
pub fn play(machine: &mut (impl Machine + ?Sized), parts: &[ScenePart], progress: &Progress) -> anyhow::Result<Played> {
    let mut link = Link::new(machine);
    let identity = link.identify()?;
    let mut played = Played { report: Report { scenes: Vec::new() }, pictures: Vec::new() };
    for part in parts {
        let (name, count) = (part.scene.name(), part.frames.len());
        ensure!(part.scene.index() < usize::from(identity.scenes), "the firmware has no scene {name}: build it again");
        let step = progress.step(format!("drawing scene {name}, {count} frames"));
        let mut frames = Vec::with_capacity(count);
        session::play(&mut link, part, |frame| {
            frames.push(frame);
            step.update(&format!("frame {} of {count}", frames.len()));
            Ok(())
        })?;
        step.done();
        played.report.scenes.push(SceneReport::new(name, &identity, &frames));
        let pictures = frames.into_iter().enumerate().map(|(index, frame)| (name.to_string(), index, frame.picture));
        played.pictures.extend(pictures);
    }
    Ok(played)
}
