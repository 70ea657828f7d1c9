//! `cargo xtask demo`: boots the firmware in QEMU, or in the DE1-SoC's simulator, and saves the frames of a recorded
//! session.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::Context;
use firmware::scene::Scene;

use crate::boot;
use crate::cli::{Board, DemoArguments};
use crate::demo::{self, Played};
use crate::golden::{self, Golden};
use crate::paths::{for_display, target_folder};
use crate::picture::{Picture, write_animated_png, write_png};
use crate::progress::Progress;
use crate::report::{INSTRUCTIONS_PER_TRIANGLE_MAX, Report, verdict};
use crate::session::{self, ScenePart};
use crate::simulated::Design;
use crate::stream::to_bytes;

/// How long the animation shows a frame.
const FRAME_TIME: Duration = Duration::from_millis(50);
/// Frames of the recorded game that are shown: all pictures are held until the animation is written.
const GAME_FRAMES: usize = 600;

/// Runs the demonstration.
///
/// # Errors
///
/// When something is missing that cannot be installed, the firmware does not build or run, its
/// screen shows something else than it drew, or the results cannot be written.
pub fn run(arguments: &DemoArguments) -> anyhow::Result<()> {
    let started = Instant::now();
    let progress = Progress::new();
    let parts = parts(arguments)?;
    let folder = target_folder().join("demo");
    empty(&folder)?;
    let mut machine = boot::start(arguments.board, Design::Model, None, &folder, &progress)?;
    let played = demo::play(machine.as_mut(), &parts, &progress)?;
    machine.end()?;
    let report = save(played, &folder, &progress)?;
    if let Some(path) = &arguments.dump {
        let step = progress.step(format!("writing the packet words to {}", path.display()));
        // Those of this computer: the golden file says that they are the same.
        let words = demo::words(&parts, None, &Progress::quiet())?;
        fs::write(path, to_bytes(&words))
            .with_context(|| format!("cannot write {}: check its folder", path.display()))?;
        step.done();
    }

    println!("{}", report.table());
    // Only vexpress-a9's clock ticks finely enough to count a frame's instructions.
    if let Some(found) = report.torus_instructions().filter(|_| arguments.board == Board::VexpressA9) {
        println!(
            "bar: at most {INSTRUCTIONS_PER_TRIANGLE_MAX} instructions per triangle on the torus: {found:.1}, {}",
            verdict(found, INSTRUCTIONS_PER_TRIANGLE_MAX)
        );
    }
    println!("{}", golden_line(&report)?);
    let shown = for_display(&folder).display();
    let log = if folder.join("log.txt").exists() { " and log.txt" } else { "" };
    println!("open {shown}/demo.png in a browser, which plays it as an animation;");
    println!("single frames are {shown}/<scene>-NNN.png, numbers report.json, messages console.txt{log}");
    println!("done in {:.1} s", started.elapsed().as_secs_f64());
    Ok(())
}

/// Returns what is played.
fn parts(arguments: &DemoArguments) -> anyhow::Result<Vec<ScenePart>> {
    match arguments.scene {
        Some(scene) => {
            let mut parts = session::all()?;
            parts.retain(|part| part.scene == scene);
            if scene == Scene::Game {
                parts.iter_mut().for_each(|part| part.frames.truncate(GAME_FRAMES));
            }
            Ok(parts)
        }
        None if arguments.seeds => session::seeds(),
        None => session::demo(),
    }
}

/// Writes pictures and report.
fn save(played: Played, folder: &Path, progress: &Progress) -> anyhow::Result<Report> {
    let step = progress.step(format!("writing {} pictures", played.pictures.len()));
    for (scene, index, picture) in &played.pictures {
        step.update(&format!("{scene} {index}"));
        write_png(&folder.join(format!("{scene}-{index:03}.png")), picture)?;
    }
    step.update("the animation");
    let pictures: Vec<Picture> = played.pictures.into_iter().map(|(_, _, picture)| picture).collect();
    write_animated_png(&folder.join("demo.png"), &pictures, FRAME_TIME)?;
    played.report.write(&folder.join("report.json"))?;
    step.done();
    Ok(played.report)
}

/// Compares a run with the golden ones.
fn golden_line(report: &Report) -> anyhow::Result<String> {
    let mut golden = Golden { scenes: Vec::new() };
    for file in [golden::DEMO, golden::SEEDS] {
        let Some(more) = Golden::read(file)? else {
            return Ok(format!("nothing to compare the frames with: there is no {file}"));
        };
        golden.scenes.extend(more.scenes);
    }
    let run = Golden::from(report);
    let golden = golden.played_in(&run);
    if golden.scenes.is_empty() {
        return Ok("no golden run has these scenes frame by frame".to_string());
    }
    Ok(match golden.check(&run) {
        Ok(()) => "every frame is equal to the golden run".to_string(),
        Err(difference) => format!("WARNING: the frames differ from the golden run: {difference}"),
    })
}

/// Makes a folder empty: frames of an earlier, longer run must not stay.
pub(super) fn empty(folder: &Path) -> anyhow::Result<()> {
    if folder.exists() {
        fs::remove_dir_all(folder).with_context(|| format!("cannot empty the folder {}", folder.display()))?;
    }
    fs::create_dir_all(folder).with_context(|| format!("cannot make the folder {}", folder.display()))
}
