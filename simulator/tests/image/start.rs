//! The start, from whatever U-Boot leaves.

use crate::board::{Board, binary, image};
use simulator::PowerOn;
use simulator::time::in_milliseconds;

/// Longest time from the entry to the first frame, in milliseconds: the bar.
const FIRST_FRAME: f64 = 300.0;

/// U-Boot's script on the card loads the raw binary and turns the caches off; a person who types `go` does not, and a
/// debugger loads the ELF file.
#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn elf_file_and_raw_binary_start_in_time_with_caches_on_and_off_and_show_the_same() {
    let screen = |power_on: PowerOn| {
        let mut board = Board::start(power_on);
        board.connects();
        assert!(board.machine.console_text().contains("on the DE1-SoC, reset: power-on"));
        board.first_frame();
        let time = in_milliseconds(board.machine.now());
        assert!(time < FIRST_FRAME, "the first frame came after {time:.1} ms");
        board.frames(2);
        board.machine.screen().expect("nothing stops it").expect("a frame was shown")
    };
    let script = screen(PowerOn::new(binary()).caches_off());
    assert!(script == screen(PowerOn::new(image())), "the screens differ");
}

#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn two_runs_are_the_same() {
    let run = || {
        let mut board = Board::connected();
        board.passes(2);
        (board.machine.now(), board.machine.instructions(), board.machine.registers(), board.machine.console().to_vec())
    };
    assert_eq!(run(), run());
}

/// What a person types at the console, with no program at the other end.
#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn keys_typed_at_the_console_choose_what_is_shown() {
    let mut board = Board::draws();
    for (typed, answer) in [(&b"\t"[..], "style: smooth"), (b"v", "projection: orthographic"), (b"\r", "scene: torus")]
    {
        board.machine.send(typed);
        board.says(200, answer);
    }
}
