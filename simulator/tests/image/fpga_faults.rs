//! A design in the FPGA that is another one, or stops working.

use crate::board::{Board, image};
use simulator::PowerOn;
use simulator::fpga::faulty::Faults;

fn set(board: &Board, faults: Faults) {
    board.machine.hardware(|hardware| hardware.fpga.faults = faults);
}

#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn another_design_is_named_and_the_key_looks_again() {
    let mut board = Board::start(PowerOn::new(image()));
    set(&board, Faults { id: Some(0x1234_5678), ..Faults::default() });
    board.says(100, "register ID reads 0x12345678, not 0x48414c46");
    board.says(100, "waiting: configure the FPGA anew, or press the HPS key to look again");
    assert_eq!(board.flashes(), 3);
    set(&board, Faults { version: Some(9 << 16), ..Faults::default() });
    board.press_hps_key();
    board.says(100, "FPGA has contract version 9.0, this software needs 1.x");
    set(&board, Faults::default());
    board.press_hps_key();
    board.connects();
}

#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn a_fifo_that_is_stuck_is_told_and_the_next_frames_come() {
    let mut board = Board::draws();
    set(&board, Faults { fifo_stuck: true, ..Faults::default() });
    board.says(1_000, "renderer: ");
    board.says(1_000, "renderer: ");
    set(&board, Faults::default());
    board.passes(300);
    board.frames(5);
    let lit = board.machine.hardware(|hardware| hardware.board_io.leds().lit());
    assert_eq!(lit >> 9 & 1, 1, "LEDR9 remembers the fault: {lit:#b}");
}

/// Low water, swap and fence alike: the line does not come.
#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn an_interrupt_that_does_not_come_costs_speed_and_is_told_once() {
    let mut board = Board::draws();
    set(&board, Faults { interrupt_lost: true, ..Faults::default() });
    board.says(2_500, "interrupt 72 of the FPGA does not come: frames wait for the millisecond tick");
    board.frames(10);
    assert!(!board.unread().contains("interrupt 72"));
    set(&board, Faults::default());
    board.frames(5);
}
