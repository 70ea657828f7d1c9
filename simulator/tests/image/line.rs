//! Noise on the console's line.

use crate::board::Board;

/// Ends of frames that are none: two bytes, a complaint.
const NOISE: [u8; 2] = [0x01, 0x00];

#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn noise_on_the_line_holds_nothing_up_and_is_told_once_a_second() {
    let mut board = Board::draws();
    // Longer than the watchdog waits: 3.1 s.
    board.machine.send(&NOISE.repeat(18_000));
    board.says(200, "link: ");
    board.frames(180);
    board.says(1_200, " more complaints of the link");
    let said = board.machine.console_text();
    assert!(said.matches("link: ").count() <= 5 && said.contains(" more before)"), "{said}");
    board.passes(1_000);
    board.frames(3);
}
