//! `rtl-replay`, started as `cargo xtask replay --rtl` starts it.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use fpga_regs::packet::{Packet, swap};
use fpga_regs::registers::{Control, Register};
use rtl_sim::UNITS;
use xtask::progress::Progress;
use xtask::software_fpga::{picture, with_model};
use xtask::stream::{WordFile, to_bytes};
use xtask::verilated::{Job, Verilated, Wave};
use xtask::{demo, session};

/// Two frames of every scene, a bad packet, and a frame without a swap.
static WORDS: LazyLock<Vec<u32>> = LazyLock::new(|| {
    let mut parts = session::demo().expect("the session is committed");
    parts.iter_mut().for_each(|part| part.frames.truncate(2));
    let words = demo::words(&parts, None, &Progress::quiet()).expect("it plays");
    let unfinished = &words[..words.len() / 2 / 11 * 11];
    let file = WordFile { words: unfinished.to_vec(), spare_bytes: 0 };
    let whole = file.entries().last().map_or(0, |entry| entry.word + entry.length);
    [&words, &[0x7f02_0000, swap()[0], swap()[0]][..], &words[..whole]].concat()
});

fn verilated() -> Verilated {
    let program = Path::new(env!("CARGO_BIN_EXE_rtl-replay"));
    Verilated::at(program.parent().expect("it lies in a folder"))
}

fn words_file(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::write(&path, to_bytes(&WORDS)).expect("the target folder can be written");
    path
}

#[test]
fn a_replayed_stream_gives_the_models_memories_and_adds_up() {
    let words = words_file("stream.words");
    let swaps = WordFile { words: WORDS.clone(), spare_bytes: 0 }
        .entries()
        .filter(|entry| entry.packet == Ok(Packet::Swap))
        .count();
    for units in UNITS {
        let mut costs = Vec::new();
        let job = Job { words: words.clone(), units, pins: units == 8, wave: None };
        let drawn = verilated().replay(&job, |cost| costs.push(cost)).expect("it draws");
        with_model(|model| {
            model.write(Register::Control, Control::default().with_enable(true).0);
            model.push(&WORDS);
            assert!(drawn.front == model.front() && drawn.back == model.back() && drawn.depth == model.depth());
            let counters = model.counters();
            assert_eq!(counters.triangles, costs.iter().map(|cost| cost.triangles).sum::<u32>());
            assert_eq!(counters.pixels_tested, costs.iter().map(|cost| cost.pixels_tested).sum::<u32>());
            assert_eq!(counters.pixels_written, costs.iter().map(|cost| cost.pixels_written).sum::<u32>());
            if let Some(pins) = &drawn.pins {
                assert!(*pins == picture(model.front()).doubled(), "the pins show another picture");
            }
        });
        assert_eq!(drawn.pins.is_some(), units == 8);
        assert_eq!(costs.iter().filter(|cost| cost.swapped).count(), swaps);
        assert_eq!(costs.last().map(|cost| cost.swapped), Some(false));
        assert_eq!(costs.iter().map(|cost| cost.words).sum::<u64>(), WORDS.len() as u64);
        for pair in costs.windows(2) {
            assert!(pair[0].first_clock + pair[0].clocks <= pair[1].first_clock, "{pair:?}");
        }
        for cost in &costs {
            // A tile is drawn in a clock, a word comes in one; a clear visits every tile.
            assert!(cost.clocks >= cost.tiles.max(cost.words + cost.held), "{cost:?}");
            assert!(cost.tiles >= u64::from(320 * 240 / units), "{cost:?}");
            assert!(u64::from(cost.pixels_tested) <= cost.tiles * u64::from(units), "{cost:?}");
            // Waiting for the blank is no cost of the frame: it would be 1,500 clocks at least.
            assert!(cost.clocks < cost.tiles + cost.words + u64::from(cost.triangles) * 40 + 200, "{cost:?}");
        }
    }
}

#[test]
fn what_cannot_be_done_is_an_error_that_says_why() {
    let replay = |job: &Job| verilated().replay(job, |_| ()).expect_err("it cannot be done").to_string();
    let job = Job { words: "no/such.words".into(), units: 8, pins: false, wave: None };
    assert!(replay(&job).contains("cannot read no/such.words: "), "{}", replay(&job));
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("none.fst");
    let wave = Some(Wave { file: file.clone(), from: u64::MAX, clocks: 10 });
    let job = Job { words: words_file("short.words"), wave, ..job };
    let expected = if cfg!(feature = "waves") { "before the wave's first clock" } else { "this build writes no waves" };
    assert!(replay(&job).contains(expected), "{}", replay(&job));
    assert!(!cfg!(feature = "waves") || !file.exists(), "an empty wave stays");
}
