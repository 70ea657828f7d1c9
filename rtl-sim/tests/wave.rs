//! What a recorded wave shows: the clocks that were asked for, and the words in them.

use std::path::{Path, PathBuf};

use fpga_regs::Port;
use fpga_regs::packet::{Clear, Fence};
use fpga_regs::registers::{Control, Register};
use fpga_regs::screen::Rgb332;
use rtl_sim::Rtl;
use rtl_sim::rtl::WaveError;
use rtl_sim::wave::changes;

/// Picoseconds of a bus clock.
const CLOCK: u64 = 20_000;

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(name)
}

/// Returns the clocks in which the bus clock rises.
fn rises(path: &Path) -> Vec<u64> {
    let changes = changes(path, "clk_i").expect("a wave");
    changes.into_iter().filter(|change| change.value == "1").map(|change| change.time / CLOCK).collect()
}

fn enabled(units: u32) -> Rtl {
    let mut rtl = Rtl::new(units);
    rtl.write(Register::Control, Control::default().with_enable(true).0);
    rtl
}

#[test]
fn a_wave_shows_the_clocks_that_were_asked_for_and_their_words() {
    let path = file("words.fst");
    let mut rtl = enabled(8);
    let start = rtl.clocks();
    // Word n goes in at clock start + n; of 200, the wave has 100.
    rtl.record_wave(&path, start + 50..start + 150).expect("waves are built in");
    let words: Vec<u32> = (0..100).flat_map(|tag| Fence { tag: 0x1234_0000 + 77 * tag }.encode()).collect();
    for word in &words {
        assert_eq!(rtl.push_word(*word), 0, "the FIFO has room for all");
    }
    rtl.clock(100);
    drop(rtl);

    assert_eq!(rises(&path), (start + 50..start + 150).collect::<Vec<_>>());
    let values = changes(&path, "fifo_writedata_i").expect("a wave");
    for (clock, word) in (start..).zip(&words).skip(50).take(100) {
        let last = values.iter().rev().find(|change| change.time <= clock * CLOCK).expect("a value from the start on");
        assert_eq!(u32::from_str_radix(&last.value, 2), Ok(*word), "at clock {clock}");
    }
}

#[test]
fn a_wave_that_is_ended_early_is_whole_and_a_second_one_follows() {
    let mut rtl = enabled(1);
    let paths = [file("first.fst"), file("second.fst")];
    for path in &paths {
        let start = rtl.clocks();
        rtl.record_wave(path, 0..u64::MAX).expect("waves are built in");
        rtl.push(&Clear { colour: Rgb332(7), depth: 9 }.encode());
        rtl.clock(20);
        rtl.end_wave();
        rtl.clock(10);
        assert_eq!(rises(path), (start..start + 22).collect::<Vec<_>>());
        assert_eq!(changes(path, "no_such"), Err(format!("{} has no signal no_such", path.display())));
    }
}

#[test]
fn a_file_that_cannot_be_written_is_named() {
    let error = enabled(2).record_wave(Path::new("no/such/folder.fst"), 0..9).expect_err("there is no such folder");
    assert!(matches!(error, WaveError::File { .. }));
    assert!(error.to_string().starts_with("cannot write no/such/folder.fst: "), "{error}");
}
