//! What ends a run, is told at the next start, and is not repeated for ever.

use crate::board::{Board, image};
use simulator::PowerOn;
use simulator::devices::ResetCause;

/// The watchdog's time, and some more, in milliseconds.
const WATCHDOG: u64 = 2_800;
/// Nothing is mapped there.
const HOLE: u32 = 0x5000_0000;

#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn a_main_loop_that_stops_is_ended_by_the_watchdog_and_told_at_the_next_start() {
    let mut board = Board::connected();
    board.machine.hang();
    board.resets(WATCHDOG, ResetCause::L4Watchdog(0));
    board.says(100, "reset: watchdog 0");
    board.says(100, "the watchdog reset the board: the main loop stopped (1 in a row)");
    board.connects();
}

#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn a_fault_is_reported_and_the_third_in_a_row_ends_it() {
    let mut board = Board::connected();
    for count in 1..3 {
        board.machine.jump(HOLE);
        board.says(200, "prefetch abort: fetch from 0x50000000");
        board.says(200, "the board is reset");
        board.resets(100, ResetCause::SoftwareWarm);
        board.says(200, "reset: warm reset by software");
        board.says(200, &format!("the last run ended with a fault ({count} in a row)"));
        board.connects();
    }
    board.machine.jump(HOLE);
    board.says(200, "it happened too often: reset the board by hand");
    // Ten a second.
    assert!((2..=3).contains(&board.flashes_in(250)));
}

#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn the_third_bite_in_a_row_waits_for_a_person_or_a_new_design() {
    let mut board = Board::connected();
    for count in 1..=3 {
        board.machine.hang();
        board.resets(WATCHDOG, ResetCause::L4Watchdog(0));
        board.says(100, &format!("the main loop stopped ({count} in a row)"));
        if count < 3 {
            board.connects();
        }
    }
    board.says(100, "waiting: press the HPS key, or configure the FPGA anew");
    board.machine.set_fpga_configured(false);
    board.says(100, "FPGA not configured");
    board.machine.set_fpga_configured(true);
    board.first_frame();
}

#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn an_fpga_that_is_configured_while_the_program_waits_for_a_person_is_used() {
    let mut board = Board::start(PowerOn::new(image()));
    board.machine.hardware(|hardware| hardware.fpga.faults.hangs = true);
    board.passes(200);
    board.machine.set_fpga_configured(false);
    board.machine.hardware(|hardware| hardware.fpga.faults.hangs = false);
    board.resets(WATCHDOG, ResetCause::L4Watchdog(0));
    board.says(100, "waiting: press the HPS key, or configure the FPGA anew");
    board.passes(300);
    board.machine.set_fpga_configured(true);
    board.first_frame();
}
