//! What a triangle costs on this machine: nanoseconds a triangle and a covered pixel, by size.
//!
//! `cargo bench -p raster-model`

use std::hint::black_box;
use std::time::Instant;

use fpga_regs::packet::Clear;
use fpga_regs::registers::{Control, Register};
use fpga_regs::screen::{PIXELS, Rgb332};
use raster_model::{Device, Memory};

#[path = "../tests/model/rng.rs"]
mod rng;
#[path = "../tests/model/setup.rs"]
mod setup;

/// Triangles of one measurement.
const TRIANGLES: u32 = 1_000;
/// In place of a side: triangles that cover the whole screen.
const SCREEN: i32 = 1_023;
/// Runs of one measurement; the fastest counts, as nothing else disturbed it.
const RUNS: u32 = 20;

fn main() {
    let (mut first, mut second) = (vec![0; PIXELS], vec![0; PIXELS]);
    let (mut depth, mut fifo) = (vec![0; PIXELS], vec![0; 1024]);
    let memory = Memory::new([&mut first, &mut second], &mut depth).expect("sizes are right");
    let mut device = Device::new(memory, &mut fifo).expect("size is right");
    println!("{:>13} {:>12} {:>10} {:>10} {:>9}", "side (pixels)", "depth", "pixels", "ns/pixel", "ns each");
    for side in [2, 4, 8, 16, 32, 64, 128, 230, SCREEN] {
        for (name, falls) in [("all pass", true), ("random", false)] {
            let words = triangles(side, falls);
            let nanoseconds = (0..RUNS).map(|_| run(&mut device, &words)).fold(f64::INFINITY, f64::min);
            let counters = device.counters();
            assert_eq!((counters.triangles, counters.bad_packets), (TRIANGLES, 0));
            println!(
                "{side:>13} {name:>12} {:>10.1} {:>10.2} {:>9.1}",
                f64::from(counters.pixels_tested) / f64::from(TRIANGLES),
                nanoseconds / f64::from(counters.pixels_tested),
                nanoseconds / f64::from(TRIANGLES),
            );
        }
    }
}

/// Draws the packets on a cleared screen and returns how many nanoseconds that took.
fn run(device: &mut Device<'_>, words: &[u32]) -> f64 {
    device.write(Register::Control, Control::default().with_reset(true).with_enable(true).0);
    device.push(&Clear { colour: Rgb332(0), depth: u16::MAX }.encode());
    let start = Instant::now();
    device.push(black_box(words));
    start.elapsed().as_nanos() as f64
}

/// Returns packets of triangles with corners anywhere in a square of `side` pixels, or that cover
/// the screen when it is [`SCREEN`]; each is nearer than the one before it or at any depth.
fn triangles(side: i32, falls: bool) -> Vec<u32> {
    let mut rng = rng::Rng(side as u64);
    let mut words = Vec::new();
    for index in 0..TRIANGLES {
        let triangle = loop {
            let depth = if falls { 60_000 - 40 * index } else { rng.below(65_536) };
            if side == SCREEN {
                let corners = [(-16, -16), (SCREEN * 16, -16), (-16, SCREEN * 16)];
                let vertices = corners.map(|(x, y)| (x, y, f64::from(depth)));
                break setup::set_up(vertices, index as u8).expect("it is on the screen");
            }
            let (x, y) = (rng.within(0, (320 - side) * 16 - 1), rng.within(0, (240 - side) * 16 - 1));
            let mut corner = || (x + rng.within(0, side * 16), y + rng.within(0, side * 16), f64::from(depth));
            if let Some(triangle) = setup::set_up([corner(), corner(), corner()], index as u8) {
                break triangle;
            }
        };
        words.extend(triangle.encode());
    }
    words
}
