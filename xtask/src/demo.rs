//! The demonstration session, played on a machine.

use anyhow::ensure;

use crate::machine::{Link, Machine, with_recording_host};
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
        let (name, count) = (part.title(), part.frames.len());
        ensure!(part.scene.index() < usize::from(identity.scenes), "the firmware has no scene {name}: build it again");
        let step = progress.step(format!("drawing scene {name}, {count} frames"));
        let mut frames = Vec::with_capacity(count);
        session::play(&mut link, part, |frame| {
            frames.push(frame);
            step.update(&format!("frame {} of {count}", frames.len()));
            Ok(())
        })?;
        step.done();
        played.report.scenes.push(SceneReport::new(&name, &identity, &frames));
        let pictures = frames.into_iter().enumerate().map(|(index, frame)| (name.clone(), index, frame.picture));
        played.pictures.extend(pictures);
    }
    Ok(played)
}

/// Plays a session on this computer, with a mesh file in memory or without one, and returns the packet words of all
/// its frames.
///
/// # Errors
/// As [`play`].
pub fn words(parts: &[ScenePart], mesh: Option<Vec<u8>>, progress: &Progress) -> anyhow::Result<Vec<u32>> {
    let (played, mut words) = with_recording_host(mesh, |machine| play(machine, parts, progress))?;
    // Until it is told to step, the application draws frames of its own.
    let count: u64 = played.report.scenes.iter().map(|scene| scene.words).sum();
    Ok(words.split_off(words.len() - count as usize))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::with_host;
    use crate::software_fpga::{picture, with_model};
    use crate::stream::WordFile;
    use fpga_regs::packet::Packet;
    use fpga_regs::registers::{Control, Register};

    /// The words alone show what the session showed.
    #[test]
    fn the_words_draw_the_last_frame_again() {
        let mut parts = session::demo().expect("it is committed");
        parts.iter_mut().for_each(|part| part.frames.truncate(2));
        let quiet = Progress::quiet();
        let played = with_host(|machine| play(machine, &parts, &quiet)).expect("it plays");
        let file = WordFile { words: words(&parts, None, &quiet).expect("it plays again"), spare_bytes: 0 };
        file.check_end().expect("whole packets");
        let swaps = file.entries().filter(|entry| entry.packet == Ok(Packet::Swap)).count();
        assert_eq!(swaps, played.pictures.len());
        let (_, _, last) = played.pictures.last().expect("six frames");
        let again = with_model(|device| {
            device.write(Register::Control, Control::default().with_enable(true).0);
            device.push(&file.words);
            picture(device.front()).doubled()
        });
        assert_eq!(*last, again);
    }
}
