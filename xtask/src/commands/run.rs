//! `cargo xtask run`: the firmware live, in a window or headless.

use std::fs;
use std::os::unix::fs::FileTypeExt;
use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::{Context, bail, ensure};
use firmware::scene::Scene;

use crate::boot::{self, Bootable, start_with_log};
use crate::cli::{Board, RunArguments};
use crate::machine::{Emulated, Link};
use crate::model;
use crate::paths::{for_display, target_folder};
use crate::picture::write_png;
use crate::progress::Progress;
use crate::qemu::{QemuOptions, UsbDevice};
use crate::session::{self, ScenePart};
use crate::setup::ensure_qemu_window;
use crate::simulated::Design;

/// Longest time that a window stays open: as good as for ever.
const WINDOW_LIMIT: Duration = Duration::from_secs(365 * 24 * 3_600);

/// Runs the firmware.
///
/// # Errors
///
/// When the board cannot run here, something is missing that cannot be installed, the firmware
/// does not build or run, or a frame cannot be written.
pub fn run(arguments: &RunArguments) -> anyhow::Result<()> {
    let design = design(arguments)?;
    match (arguments.headless, arguments.frames, &arguments.output) {
        (true, Some(frames), Some(output)) => headless(arguments, design, frames, output),
        _ if arguments.board.runs_in_qemu() => in_a_window(arguments),
        _ => in_the_simulator(arguments, design),
    }
}

/// Returns what shall be in the FPGA; a board in QEMU has none.
fn design(arguments: &RunArguments) -> anyhow::Result<Design> {
    let board = arguments.board;
    if !arguments.rtl {
        return Ok(Design::Model);
    }
    ensure!(!board.runs_in_qemu(), "{board} has no FPGA: use `--board {}` with --rtl", Board::De1Soc);
    Ok(Design::Rtl)
}

/// Plays the recorded session, from its beginning and again if need be, and saves each frame.
fn headless(arguments: &RunArguments, design: Design, count: u32, output: &Path) -> anyhow::Result<()> {
    let progress = Progress::new();
    let parts = parts(arguments)?;
    fs::create_dir_all(output).with_context(|| format!("cannot make the folder {}", output.display()))?;
    let folder = target_folder().join("run");
    let mesh = mesh_file(arguments, &folder)?;
    let mut machine = boot::start(arguments.board, design, mesh, &folder, &progress)?;
    let step = progress.step(format!("drawing {count} frames"));
    let mut drawn = 0;
    let mut link = Link::new(machine.as_mut());
    link.identify()?;
    for part in first_frames(&parts, count as usize) {
        session::play(&mut link, &part, |frame| {
            write_png(&output.join(format!("frame-{drawn:03}.png")), &frame.picture)?;
            drawn += 1;
            step.update(&format!("{drawn}"));
            Ok(())
        })?;
    }
    step.done();
    machine.end()?;
    println!("wrote {drawn} frames to {}", for_display(output).display());
    Ok(())
}

/// Returns what is played: the demonstration's session or, of a scene or in a style that is named, the recorded game or
/// the pictures of the five systems; a scene that has none there holds still.
fn parts(arguments: &RunArguments) -> anyhow::Result<Vec<ScenePart>> {
    if arguments.scene.is_none() && arguments.style.is_none() && arguments.model.is_none() {
        return session::demo();
    }
    let first = if arguments.model.is_some() { Scene::Model } else { Scene::ALL[0] };
    let scene = arguments.scene.unwrap_or(first);
    let named = session::all()?.into_iter().find(|part| part.scene == scene);
    let part = named.unwrap_or(ScenePart { scene, style: None, frames: vec![None] });
    Ok(vec![ScenePart { style: arguments.style.or(part.style), ..part }])
}

/// Returns the model that is named as a `.mesh` file.
fn mesh_file(arguments: &RunArguments, folder: &Path) -> anyhow::Result<Option<PathBuf>> {
    arguments.model.as_deref().map(|path| model::mesh_file(path, folder)).transpose()
}

/// Returns a session that is repeated and cut to `count` frames.
fn first_frames(parts: &[ScenePart], count: usize) -> Vec<ScenePart> {
    let mut left = count;
    let mut taken = Vec::new();
    for part in parts.iter().filter(|part| !part.frames.is_empty()).cycle() {
        if left == 0 {
            break;
        }
        let frames = part.frames[..part.frames.len().min(left)].to_vec();
        left -= frames.len();
        taken.push(ScenePart { frames, ..part.clone() });
    }
    taken
}

/// Returns what is plugged into the board: a keyboard, and behind a hub with it what the flags name.
fn plugged_in(arguments: &RunArguments) -> anyhow::Result<Vec<UsbDevice>> {
    let named = arguments.pad.is_some() || arguments.usb_host.is_some();
    let board = arguments.board;
    match board {
        Board::Raspi2b => {}
        _ if !named => return Ok(Vec::new()),
        Board::De1Soc => bail!(
            "{board}'s simulator has a keyboard of its own: use --pad and --usb-host with `--board {}`",
            Board::Raspi2b
        ),
        Board::VexpressA9 => bail!("{board} has no USB: use `--board {}` with --pad and --usb-host", Board::Raspi2b),
    }
    if !named {
        return Ok(vec![UsbDevice::keyboard("1")]);
    }
    let mut devices = vec![UsbDevice::hub("1"), UsbDevice::keyboard("1.1")];
    if let Some(socket) = &arguments.pad {
        match fs::metadata(socket) {
            Ok(found) => ensure!(
                found.file_type().is_socket(),
                "--pad {} is no socket: name one that `cargo xtask pad` listens at, or a file that is not there yet",
                socket.display()
            ),
            Err(_) => {
                println!("nobody is at {} yet: start `cargo xtask pad {0}` in another terminal", socket.display())
            }
        }
        devices.push(UsbDevice::served(socket, "1.2"));
    }
    devices.extend(arguments.usb_host.map(|ids| UsbDevice::of_this_computer(ids, "1.3")));
    Ok(devices)
}

/// Runs the DE1-SoC's image in its simulator's window.
fn in_the_simulator(arguments: &RunArguments, design: Design) -> anyhow::Result<()> {
    plugged_in(arguments)?;
    ensure!(
        arguments.scene.is_none() && arguments.style.is_none(),
        "--scene and --style do not reach the simulator's window: press Enter and Tab there, or add --headless"
    );
    let progress = Progress::new();
    let folder = target_folder().join("run");
    fs::create_dir_all(&folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
    let mesh = mesh_file(arguments, &folder)?;
    let (simulator, elf) = boot::simulator(arguments.board, design, true, &progress)?;
    let simulator = simulator.with_mesh(mesh);
    println!(
        "click into the window, then use the keyboard: it is the board's USB keyboard; F1 to F4 are its keys KEY0 to"
    );
    println!("KEY3, F5 the HPS key, F6 to F12 its switches SW0 to SW6; close the window to end");
    simulator.live(&elf, &folder.join("console.txt"))
}

fn in_a_window(arguments: &RunArguments) -> anyhow::Result<()> {
    let progress = Progress::new();
    let (qemu, display) = ensure_qemu_window(&progress)?;
    let bootable = Bootable::prepare(arguments.board, &progress)?;
    let folder = target_folder().join("run");
    fs::create_dir_all(&folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
    let mut options = QemuOptions::new(qemu, bootable.board, &bootable.elf);
    options.display = display;
    options.usb = plugged_in(arguments)?;
    options.mesh = mesh_file(arguments, &folder)?;
    options.console_file = Some(folder.join("console.txt"));
    options.console_on_stdout = true;
    let (mut qemu, log) = start_with_log(&options, &folder)?;
    qemu.resume()?;
    let mut machine = Emulated::new(qemu, log)?;
    if arguments.scene.is_some() || arguments.style.is_some() {
        Link::new(&mut machine).show(arguments.scene, arguments.style)?;
    }
    println!("click into the window, then use the keyboard; close the window to end");
    let status = machine.wait_for_exit(WINDOW_LIMIT)?;
    ensure!(status.success(), "the firmware ended with {status}; its last words stand above");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::{Cli, Task};
    use clap::Parser;
    use firmware::style::Style;

    fn arguments(line: &str) -> RunArguments {
        let words = ["xtask", "run"].into_iter().chain(line.split_whitespace());
        match Cli::try_parse_from(words).expect("a valid line").command {
            Task::Run(arguments) => arguments,
            _ => panic!("run is run"),
        }
    }

    /// Returns what is plugged in, and the message when that is refused.
    fn plugged(line: &str) -> Result<usize, String> {
        plugged_in(&arguments(line)).map(|devices| devices.len()).map_err(|error| error.to_string())
    }

    #[test]
    fn a_board_without_usb_takes_no_device() {
        assert_eq!(plugged(""), Ok(0));
        assert_eq!(plugged("--board raspi2b"), Ok(1));
        assert_eq!(plugged("--board raspi2b --pad /no/socket --usb-host 054c:0268"), Ok(4));
        let message = plugged("--usb-host 054c:0268").expect_err("vexpress-a9 has none");
        assert!(message.starts_with("vexpress-a9 has no USB: use `--board raspi2b`"), "{message}");
    }

    #[test]
    fn a_pads_socket_is_a_socket() {
        let message = plugged("--board raspi2b --pad Cargo.toml").expect_err("a file");
        assert!(message.starts_with("--pad Cargo.toml is no socket: "), "{message}");
    }

    #[test]
    fn a_scene_that_is_named_is_played_and_the_game_is_the_recorded_one() {
        let played = |line: &str| parts(&arguments(line)).expect("the sessions are committed");
        assert_eq!(played("--scene game"), session::game().expect("it is committed"));
        let solids = played("--scene solids --style flat");
        assert_eq!((solids.len(), solids[0].scene, solids[0].style), (1, Scene::Solids, Some(Style::Flat)));
        assert_eq!(played("--board vexpress-a9"), session::demo().expect("it is committed"));
    }

    #[test]
    fn a_session_is_repeated_and_cut() {
        let part = |scene, count| ScenePart { scene, style: None, frames: vec![None; count] };
        let parts = [part(Scene::Plate, 3), part(Scene::Torus, 0), part(Scene::Tunnel, 2)];
        let lengths = |count| {
            let taken = first_frames(&parts, count);
            taken.iter().map(|part| (part.scene.name(), part.frames.len())).collect::<Vec<_>>()
        };
        assert_eq!(lengths(2), [("plate", 2)]);
        assert_eq!(lengths(7), [("plate", 3), ("tunnel", 2), ("plate", 2)]);
        assert_eq!(first_frames(&[], 7), []);
    }
}
