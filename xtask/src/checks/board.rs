//! Steps that run the firmware in QEMU.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::{Context, ensure};
use controls::DualShock3Report;
use controls::serial::{self, FRAME_SIZE_MAXIMUM, kind};
use firmware::link::Fault;

use super::State;
use crate::boot::Bootable;
use crate::cli::Board;
use crate::demo;
use crate::firmware_build::build_firmware;
use crate::found_mesh;
use crate::golden::{self, Golden};
use crate::machine::{Emulated, Link, with_host, with_host_and_mesh};
use crate::paths::{TemporaryFolder, workspace_root};
use crate::picture::{Picture, read_png};
use crate::recorded_game::{self, Record};
use crate::report::{INSTRUCTIONS_PER_TRIANGLE_MAX, verdict};
use crate::session;

/// Longest time until a fault's report; a loaded machine is slow.
const PATIENCE: Duration = Duration::from_secs(60);
/// How the firmware ends after a fault.
const FAILED: i32 = 101;

/// The demonstration session gives the same frames in QEMU, in this process, and in the golden file.
pub(super) fn demonstration(state: &State) -> anyhow::Result<()> {
    let parts = session::demo()?;
    let golden = golden(golden::DEMO)?;
    let remedy = "if the change is wanted, look at the pictures of `cargo xtask demo`, then run \
                  `cargo xtask generate --golden` and say why in the commit";
    let here = with_host(|machine| demo::play(machine, &parts, &state.progress))?;
    golden.check(&Golden::from(&here.report)).with_context(|| format!("on this computer; {remedy}"))?;
    let mut machine = state.bootable(Board::VexpressA9)?.start(&state.folder("demo"))?;
    let there = demo::play(&mut machine, &parts, &state.progress)?;
    machine.quit()?;
    golden.check(&Golden::from(&there.report)).context("on QEMU's Cortex-A9, but not on this computer")?;
    if let Some(found) = there.report.torus_instructions() {
        let verdict = verdict(found, INSTRUCTIONS_PER_TRIANGLE_MAX);
        println!("{found:.1} instructions per triangle, bar {INSTRUCTIONS_PER_TRIANGLE_MAX}: {verdict}");
        ensure!(found <= INSTRUCTIONS_PER_TRIANGLE_MAX, "the torus costs {found:.1} instructions per triangle");
    }
    Ok(())
}

/// The same on the Cortex-A7, with another display, timer and interrupt controller.
pub(super) fn demonstration_on_raspi2b(state: &State) -> anyhow::Result<()> {
    let golden = golden(golden::DEMO)?;
    let mut machine = state.bootable(Board::Raspi2b)?.start(&state.folder("demo-raspi2b"))?;
    let played = demo::play(&mut machine, &session::demo()?, &state.progress)?;
    machine.quit()?;
    golden.check(&Golden::from(&played.report)).context("on QEMU's raspi2b, but not on vexpress-a9")
}

/// The pictures of the five systems are the same on QEMU's Cortex-A9, in this process and in the golden file.
pub(super) fn seeds(state: &State) -> anyhow::Result<()> {
    let (golden, parts) = (golden(golden::SEEDS)?, session::seeds()?);
    let here = with_host(|machine| demo::play(machine, &parts, &state.progress))?;
    golden.check(&Golden::from(&here.report)).context("on this computer")?;
    for (path, picture) in golden::pictures(&here) {
        is_committed(&path, picture)?;
    }
    let mut machine = state.bootable(Board::VexpressA9)?.start(&state.folder("seeds"))?;
    let there = demo::play(&mut machine, &parts, &state.progress)?;
    machine.quit()?;
    golden.check(&Golden::from(&there.report)).context("on QEMU's Cortex-A9, but not on this computer")?;

    let (golden, parts, mesh) = (self::golden(golden::FOUND)?, found_mesh::parts(), found_mesh::file()?);
    let found = with_host_and_mesh(mesh.clone(), |machine| demo::play(machine, &parts, &state.progress))?;
    golden.check(&Golden::from(&found.report)).context("of the model in memory, on this computer")?;
    if let Some((.., picture)) = found.pictures.last() {
        is_committed(found_mesh::PICTURE, picture)?;
    }
    is_committed(golden::SHEET, &golden::sheet(&here, &found)?)?;
    let folder = state.folder("seeds-in-memory");
    let mut machine = start_with_mesh(state, Board::VexpressA9, &folder, &mesh)?;
    let there = demo::play(&mut machine, &parts, &state.progress)?;
    machine.quit()?;
    golden.check(&Golden::from(&there.report)).context("of the model in memory, on QEMU's Cortex-A9")
}

/// Starts a board with a mesh file in its memory.
pub(super) fn start_with_mesh(state: &State, board: Board, folder: &Path, mesh: &[u8]) -> anyhow::Result<Emulated> {
    let file = write_mesh(folder, mesh)?;
    state.bootable(board)?.start_with_mesh(folder, Some(file))
}

/// Writes a mesh file into a folder, which is made if need be.
pub(super) fn write_mesh(folder: &Path, mesh: &[u8]) -> anyhow::Result<PathBuf> {
    fs::create_dir_all(folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
    let file = folder.join("in-memory.mesh");
    fs::write(&file, mesh).with_context(|| format!("cannot write {}", file.display()))?;
    Ok(file)
}

fn is_committed(path: &str, picture: &Picture) -> anyhow::Result<()> {
    let committed = read_png(&workspace_root().join(path))?;
    ensure!(committed == *picture, "{path} shows something else: write it with `cargo xtask generate --golden`");
    Ok(())
}

/// The recorded game gives the same points, and its first seconds the same pictures, on QEMU's boards, in this process
/// and in the golden file.
pub(super) fn game(state: &State) -> anyhow::Result<()> {
    let (golden, parts) = (Record::read()?, session::game()?);
    let here = Record::of(&parts)?;
    golden.check(&here).context("on this computer")?;
    for board in [Board::VexpressA9, Board::Raspi2b] {
        let mut machine = state.bootable(board)?.start(&state.folder(&format!("game-{board}")))?;
        let there = recorded_game::play(&mut machine, &parts)?;
        machine.quit()?;
        there.check_against(&golden).with_context(|| format!("on {board}, but not on this computer"))?;
        println!(
            "score {} in the whole round, {} after {} frames on {board}",
            here.score(),
            there.score(),
            there.frames
        );
    }
    Ok(())
}

fn golden(file: &str) -> anyhow::Result<Golden> {
    Golden::read(file)?.with_context(|| format!("{file} is missing: write it with `cargo xtask generate --golden`"))
}

/// Every byte of a report is lost once; the firmware drops what it spoils and goes on.
pub(super) fn lossy_line(state: &State) -> anyhow::Result<()> {
    let mut machine = state.bootable(Board::VexpressA9)?.start(&state.folder("lossy-line"))?;
    let mut buffer = [0; FRAME_SIZE_MAXIMUM];
    let report = DualShock3Report::default().to_bytes();
    let frame = serial::encode(kind::DUALSHOCK3, &report, &mut buffer).map_err(|error| anyhow::anyhow!("{error}"))?;
    let mut link = Link::new(&mut machine);
    link.begin(0)?;
    let level = link.step()?;
    for lost in 0..frame.len() {
        link.send_raw(&[&frame[..lost], &frame[lost + 1..]].concat())?;
        // The next message is whole, and must be understood.
        let drawn = link.step().with_context(|| format!("after a report without its byte {lost}"))?;
        let expected = lost as u32 + 1;
        ensure!(drawn.index == expected, "frame {} came instead of frame {expected}", drawn.index);
        ensure!(drawn.checksum == level.checksum, "a report without its byte {lost} moved the plate");
    }
    // Noise, and a frame that never ends.
    link.send_raw(&(0..=255).cycle().take(1_000).collect::<Vec<u8>>())?;
    link.step().context("after 1,000 bytes of noise")?;
    link.send_raw(&[0xff; 1_000])?;
    link.step().context("after a frame of 1,000 bytes")?;
    // One a second is told at once, the others as a count.
    link.run_freely()?;
    let last = " more complaints of the link";
    machine.qemu().wait_for_line("how many more frames were damaged", PATIENCE, |line| line.contains(last))?;
    let kept_back = |line: &str| -> Option<usize> {
        let (before, _) = line.split_once(" more before)").or_else(|| line.split_once(last))?;
        before.rsplit(['(', ' ']).next()?.parse().ok()
    };
    let lines = machine.qemu().console().lines();
    let told = lines.iter().filter(|line| line.starts_with("link: ")).count();
    let damaged = told + lines.iter().filter_map(|line| kept_back(line)).sum::<usize>();
    println!("{damaged} damaged frames in {told} complaints");
    ensure!(damaged >= frame.len() / 2, "only {damaged} damaged frames were told on the console");
    machine.quit()
}

/// Every kind of fault is reported on the console and ends QEMU with the status of a failure.
pub(super) fn faults(state: &State) -> anyhow::Result<()> {
    let elf = build_firmware(Board::VexpressA9, &["fault-injection"], state.toolchain()?, &state.progress)?;
    // A copy, as the next build of the board overwrites the file.
    let folder = TemporaryFolder::new().context("cannot make a temporary folder")?;
    let copy = folder.path().join("fault-injection.elf");
    fs::copy(&elf, &copy).with_context(|| format!("cannot copy {}", elf.display()))?;
    let bootable = Bootable { elf: copy, ..state.bootable(Board::VexpressA9)? };
    for (fault, report) in [
        (Fault::DataAbort, "data abort: write to 0x50000000"),
        (Fault::PrefetchAbort, "prefetch abort: fetch from 0x50000000"),
        (Fault::WriteToCode, "data abort: write to 0x6"),
        (Fault::UndefinedInstruction, "undefined instruction at 0x6"),
        (Fault::StackOverflow, "data abort: "),
        (Fault::Panic, "panic at "),
    ] {
        let mut machine = bootable.start(&state.folder("faults"))?;
        Link::new(&mut machine).fault(fault)?;
        let qemu = machine.qemu();
        let line =
            qemu.wait_for_line(&format!("the report of {fault:?}"), PATIENCE, |line| line.starts_with(report))?;
        let status = qemu.wait_for_exit(PATIENCE)?;
        ensure!(status.code() == Some(FAILED), "after {fault:?} QEMU ended with {status} instead of status {FAILED}");
        println!("{line}");
    }
    Ok(())
}
