//! Steps about mesh files that lie in a board's memory.

use std::f64::consts::TAU;
use std::time::Duration;

use anyhow::ensure;
use firmware::link::FrameReport;
use firmware::scene::Scene;
use models::Model;
use models::compile::{Options, compile};

use super::State;
use super::board::{start_with_mesh, write_mesh};
use crate::cli::Board;
use crate::machine::{Link, Machine, Simulated, with_host_and_mesh};
use crate::simulated::{Build, Design, Simulator};

/// Rings and sides of a torus of 70,000 triangles.
const RINGS: u32 = 250;
const SIDES: u32 = 140;
/// Longest time until the firmware has said what it found; a loaded machine is slow.
const PATIENCE: Duration = Duration::from_secs(60);

/// A board that has a large mesh file in its memory draws the same as this computer; of a broken file it says what is
/// wrong, and shows what is built in.
pub(super) fn in_memory(state: &State) -> anyhow::Result<()> {
    let bytes = compile(&torus(), &Options::default())?.bytes;
    let here = with_host_and_mesh(bytes.clone(), |machine| first_frame(machine))?;
    ensure!(here.triangles_submitted == 2 * RINGS * SIDES, "{} triangles submitted here", here.triangles_submitted);
    ensure!(here.triangles_drawn > RINGS * SIDES / 2, "only {} triangles drawn here", here.triangles_drawn);
    let there = on_board(state, Board::VexpressA9, &bytes, "mesh in memory: 70000 triangles, ")?;
    ensure!(there.checksum == here.checksum, "QEMU's Cortex-A9 draws another picture than this computer");

    let built_in = with_host_and_mesh(Vec::from(firmware::scene::found::BUILT_IN), |machine| first_frame(machine))?;
    let mut broken = bytes;
    broken[5_000] ^= 0x10;
    for board in [Board::VexpressA9, Board::Raspi2b] {
        let there = on_board(state, board, &broken, "mesh in memory: checksum 0x")?;
        ensure!(there.checksum == built_in.checksum, "{board} does not show the mesh that is built in");
    }
    Ok(())
}

/// The DE1-SoC's image draws it in the simulator, and shows what this computer draws.
pub(super) fn in_the_simulator(state: &State) -> anyhow::Result<()> {
    let bytes = compile(&torus(), &Options::default())?.bytes;
    let here = with_host_and_mesh(bytes.clone(), |machine| first_frame(machine))?;
    let elf = state.elf(Board::De1Soc)?;
    let folder = state.folder("mesh-simulator");
    let file = write_mesh(&folder, &bytes)?;
    let simulator = Simulator::prepare(Design::Model, false, Build::Checked, &state.progress)?.with_mesh(Some(file));
    let mut machine = Simulated::start(&simulator, &elf, &folder)?;
    let there = first_frame(&mut machine)?;
    ensure!(
        (there.triangles_submitted, there.triangles_drawn) == (here.triangles_submitted, here.triangles_drawn),
        "the board submits {} triangles and draws {}, this computer {} and {}",
        there.triangles_submitted,
        there.triangles_drawn,
        here.triangles_submitted,
        here.triangles_drawn
    );
    ensure!(Some(machine.screen()?.0) == here.checksum, "the board shows another picture than this computer");
    Ok(())
}

/// Starts a board with a file in its memory, waits for the line that tells of it, and draws a frame of the model.
fn on_board(state: &State, board: Board, mesh: &[u8], line: &str) -> anyhow::Result<FrameReport> {
    let mut machine = start_with_mesh(state, board, &state.folder("mesh"), mesh)?;
    let told =
        machine.qemu().wait_for_line("what the firmware says of the mesh", PATIENCE, |text| text.starts_with(line))?;
    println!("{board}: {told}");
    let report = first_frame(&mut machine)?;
    machine.quit()?;
    Ok(report)
}

fn first_frame<M: Machine + ?Sized>(machine: &mut M) -> anyhow::Result<FrameReport> {
    let mut link = Link::new(machine);
    link.begin(Scene::Model.index() as u8)?;
    link.step()
}

/// A torus, each vertex once.
fn torus() -> Model {
    let mut model = Model { face_offsets: vec![0], ..Model::default() };
    for ring in 0..RINGS {
        for side in 0..SIDES {
            let [around, across] = [(ring, RINGS), (side, SIDES)].map(|(at, of)| f64::from(at) / f64::from(of) * TAU);
            let away = 1.0 + 0.4 * across.cos();
            model.positions.push([away * around.sin(), 0.4 * across.sin(), away * around.cos()]);
            let at = |ring: u32, side: u32| ring % RINGS * SIDES + side % SIDES;
            let corners = [at(ring, side), at(ring + 1, side), at(ring + 1, side + 1), at(ring, side + 1)];
            model.corners.extend(corners);
            model.face_offsets.push(model.corners.len() as u32);
        }
    }
    model
}
