//! The way to the FPGA.

use crate::board::{Board, image};
use controls::serial;
use firmware::link::{self, HostMessage};
use simulator::PowerOn;
use simulator::devices::ResetCause;

/// The watchdog's time, and some more, in milliseconds.
const WATCHDOG: u64 = 2_800;

#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn a_bridge_that_does_not_answer_is_told_at_the_next_start_and_not_tried_again() {
    let mut board = Board::start(PowerOn::new(image()));
    board.machine.hardware(|hardware| hardware.fpga.faults.hangs = true);
    board.resets(WATCHDOG, ResetCause::L4Watchdog(0));
    board.says(100, "the watchdog reset the board: the FPGA's bridge did not answer although the FPGA is configured");
    board.says(100, "waiting: press the HPS key, or configure the FPGA anew, to try again");
    assert_eq!(board.flashes(), 4);
    board.machine.hardware(|hardware| hardware.fpga.faults.hangs = false);
    board.press_hps_key();
    board.connects();
}

#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn a_design_that_goes_is_not_touched_and_one_that_comes_is_drawn_with() {
    let mut board = Board::draws();
    // Between two frames that a PC asks for, nothing is under way on the bridge.
    let mut buffer = [0; 256];
    let begin = link::encode(link::HOST_MESSAGE, &HostMessage::Begin { scene: 0 }, &mut buffer).unwrap().to_vec();
    board.machine.send(&begin);
    board.passes(103);
    board.machine.set_fpga_configured(false);
    board.says(100, "the FPGA's design is gone: bridges closed");
    board.says(100, "FPGA not configured");
    board.passes(200);
    board.machine.set_fpga_configured(true);
    board.says(100, "bridges open");
    let run = link::encode(link::HOST_MESSAGE, &HostMessage::Run, &mut buffer).unwrap().to_vec();
    board.machine.send(&run);
    board.passes(50);
    board.frames(3);
}

#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn a_design_that_goes_while_the_console_is_written_to_is_not_touched() {
    let mut board = Board::draws();
    // H, twice: the legend, which takes longer than the UART's FIFO holds.
    let mut buffer = [0; 256];
    for keys in [[0; 8], [0, 0, 0x0B, 0, 0, 0, 0, 0]] {
        let frame = serial::encode(serial::kind::KEYBOARD, &keys, &mut buffer).unwrap();
        board.machine.send(frame);
    }
    board.says(200, "keys             pad");
    board.machine.set_fpga_configured(false);
    board.says(300, "the FPGA's design is gone: bridges closed");
    board.machine.set_fpga_configured(true);
    board.says(100, "bridges open");
    board.frames(3);
}
