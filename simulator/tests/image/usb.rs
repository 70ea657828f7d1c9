//! What is plugged into the board's connectors.

use crate::board::Board;
use simulator::time::milliseconds;
use simulator::{Event, Machine};

/// Changes the style.
const TAB: u8 = 0x2B;

#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn a_keyboard_pulled_out_in_a_transfer_holds_nothing_up_and_works_again_when_it_is_back() {
    let mut board = Board::draws();
    board.machine.hardware(|hardware| hardware.usb.plug_keyboard());
    board.says(1_500, "usb 1: keyboard");
    let press = |board: &Board| {
        board.machine.hardware(|hardware| hardware.usb.keyboard().lock().function.press(TAB));
    };
    press(&board);
    board.says(300, "style: ");
    board.machine.hardware(|hardware| hardware.usb.keyboard().lock().function.release(TAB));
    board.passes(50);
    // The hub has the next report, and the controller has yet to fetch it in a later microframe.
    press(&board);
    let taken = |machine: &Machine| machine.hardware(|hardware| hardware.usb.keyboard().lock().function.unread() == 0);
    assert!(!taken(&board.machine));
    assert_eq!(board.machine.run_until(milliseconds(20), taken), Ok(Event::Met));
    board.machine.hardware(|hardware| hardware.usb.unplug_keyboard());
    board.says(500, "usb 1: keyboard has gone");
    board.frames(10);
    board.machine.hardware(|hardware| hardware.usb.keyboard().lock().function.release(TAB));
    board.machine.hardware(|hardware| hardware.usb.plug_keyboard());
    board.says(1_500, "usb 1: keyboard");
    press(&board);
    board.says(300, "style: ");
}
