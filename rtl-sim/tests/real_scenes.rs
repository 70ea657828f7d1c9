//! The frames of the demonstration, of the five systems and of a model in memory, as the firmware draws them, through the device and the
//! model: clears, triangles, lines, swaps and fences as they come, and after every frame all equal.

mod common;

use std::sync::LazyLock;

use common::pair::Pair;
use rtl_sim::replay::frames;
use xtask::progress::Progress;
use xtask::{demo, found_mesh, session};

/// The words of every frame of every scene, drawn by the firmware's application in this process.
static WORDS: LazyLock<Vec<u32>> = LazyLock::new(|| {
    let parts = session::demo().expect("the session is committed");
    demo::words(&parts, None, &Progress::quiet()).expect("it plays")
});

/// The same of the session of the five systems: flat and Gouraud triangles, lines, depth alone, depth as grey.
static SEEDS: LazyLock<Vec<u32>> = LazyLock::new(|| {
    let parts = session::seeds().expect("the session is committed");
    demo::words(&parts, None, &Progress::quiet()).expect("it plays")
});

/// The same of a model that lies in memory, drawn a block at a time.
static FOUND: LazyLock<Vec<u32>> = LazyLock::new(|| {
    let mesh = found_mesh::file().expect("it is committed");
    demo::words(&found_mesh::parts(), Some(mesh), &Progress::quiet()).expect("it plays")
});

fn scenes(units: u32, session: &str, words: &[u32]) -> (usize, u32) {
    let mut pair = Pair::new(units);
    let mut triangles = 0;
    let mut count = 0;
    for frame in frames(words) {
        pair.push(frame.words);
        pair.compare_registers(&format!("after frame {count} of {session}"));
        pair.compare_memories(&format!("after frame {count} of {session}"));
        triangles = pair.model.counters().triangles;
        count += 1;
    }
    println!("{units} pixel units: {count} frames, {triangles} triangles, {} clocks", pair.rtl.clocks());
    (count, triangles)
}

fn demonstration(units: u32) {
    let (count, triangles) = scenes(units, "the demonstration", &WORDS);
    let expected = session::demo().expect("it was read").iter().map(|part| part.frames.len()).sum::<usize>();
    assert_eq!(count, expected, "every frame of the session ends with a swap");
    assert!(triangles > 100_000, "{triangles} triangles are not the demonstration");
}

#[test]
fn one_unit_shows_the_demonstration() {
    demonstration(1);
}

#[test]
fn two_units_show_the_demonstration() {
    demonstration(2);
}

#[test]
fn four_units_show_the_demonstration() {
    demonstration(4);
}

#[test]
fn eight_units_show_the_demonstration() {
    demonstration(8);
}

fn seeds(units: u32) {
    let (count, triangles) = scenes(units, "the five systems", &SEEDS);
    let expected = session::seeds().expect("it was read").iter().map(|part| part.frames.len()).sum::<usize>();
    assert_eq!(count, expected, "every frame of the session ends with a swap");
    assert!(triangles > 40_000, "{triangles} triangles are not the five systems'");
}

#[test]
fn one_unit_shows_the_five_systems() {
    seeds(1);
}

#[test]
fn eight_units_show_the_five_systems() {
    seeds(8);
}

#[test]
fn eight_units_show_the_model_in_memory() {
    let (count, triangles) = scenes(8, "the model in memory", &FOUND);
    assert_eq!(count, found_mesh::parts()[0].frames.len(), "every frame ends with a swap");
    assert!(triangles > 8_000, "{triangles} triangles are not the knot's");
}
