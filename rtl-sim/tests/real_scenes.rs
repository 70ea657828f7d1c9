//! The demonstration's frames, as the firmware draws them, through the device and the model: clears,
//! triangles, swaps and fences as they come, and after every frame all equal.

mod common;

use std::sync::LazyLock;

use common::pair::Pair;
use rtl_sim::replay::frames;
use xtask::progress::Progress;
use xtask::{demo, session};

/// The words of every frame of every scene, drawn by the firmware's application in this process.
static WORDS: LazyLock<Vec<u32>> = LazyLock::new(|| {
    let parts = session::demo().expect("the session is committed");
    demo::words(&parts, &Progress::quiet()).expect("it plays")
});

fn scenes(units: u32) {
    let mut pair = Pair::new(units);
    let mut triangles = 0;
    let mut count = 0;
    for frame in frames(&WORDS) {
        pair.push(frame.words);
        pair.compare_registers(&format!("after frame {count} of the demonstration"));
        pair.compare_memories(&format!("after frame {count} of the demonstration"));
        triangles = pair.model.counters().triangles;
        count += 1;
    }
    println!("{units} pixel units: {count} frames, {triangles} triangles, {} clocks", pair.rtl.clocks());
    let expected = session::demo().expect("it was read").iter().map(|part| part.frames.len()).sum::<usize>();
    assert_eq!(count, expected, "every frame of the session ends with a swap");
    assert!(triangles > 100_000, "{triangles} triangles are not the demonstration");
}

#[test]
fn one_unit_shows_the_demonstration() {
    scenes(1);
}

#[test]
fn two_units_show_the_demonstration() {
    scenes(2);
}

#[test]
fn four_units_show_the_demonstration() {
    scenes(4);
}

#[test]
fn eight_units_show_the_demonstration() {
    scenes(8);
}
