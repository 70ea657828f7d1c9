//! A DualShock 3 behind the board's hub.

use crate::board::Board;

/// The styles' key.
const TAB: u8 = 0x2B;
/// Where a report has the accelerometer's x axis, 16 bits, big endian, and what it reads level and tilted by half of a g.
const ACCELERATION_X: usize = 41;
const LEVEL: u16 = 511;
const TILTED: u16 = LEVEL + 56;
/// Frames after which the plate has followed the pad.
const FOLLOWS: u64 = 20;

fn tilt(board: &Board, reading: u16) {
    board.machine.hardware(|hardware| {
        let mut pad = hardware.usb.pad().lock();
        pad.function.set(|report| report[ACCELERATION_X..][..2].copy_from_slice(&reading.to_be_bytes()));
    });
}

/// Returns what shows once the plate has come to rest.
fn shown(board: &mut Board) -> Vec<[u8; 3]> {
    board.frames(FOLLOWS);
    match board.machine.screen() {
        Ok(Some(screen)) => screen.pixels().to_vec(),
        other => board.fail(&format!("no screen: {other:?}")),
    }
}

#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn it_tilts_the_plate_is_pulled_out_and_put_back_beside_a_keyboard() {
    let mut board = Board::draws();
    let level = shown(&mut board);
    board.machine.hardware(|hardware| hardware.usb.plug_keyboard());
    board.machine.hardware(|hardware| hardware.usb.plug_pad());
    board.says(2_000, "usb 2: DualShock 3 (054c:0268");
    assert!(shown(&mut board) == level, "a pad that lies level tilts nothing");
    tilt(&board, TILTED);
    let tilted = shown(&mut board);
    assert!(tilted != level, "the tilted pad does not tilt the plate");
    tilt(&board, LEVEL);
    assert!(shown(&mut board) == level, "the pad lies level again, and the plate does not");

    tilt(&board, TILTED);
    board.frames(FOLLOWS);
    board.machine.hardware(|hardware| hardware.usb.unplug_pad());
    board.says(500, "usb 2: DualShock 3 has gone");
    // The keyboard goes on beside it: all five styles, and the first again.
    for _ in 0..5 {
        board.machine.hardware(|hardware| hardware.usb.keyboard().lock().function.press(TAB));
        board.says(300, "style: ");
        board.machine.hardware(|hardware| hardware.usb.keyboard().lock().function.release(TAB));
        board.frames(5);
    }
    tilt(&board, LEVEL);
    board.machine.hardware(|hardware| hardware.usb.plug_pad());
    board.says(2_000, "usb 2: DualShock 3 (054c:0268");
    assert!(shown(&mut board) == level, "the pad that is back lies level");
    tilt(&board, TILTED);
    assert!(shown(&mut board) == tilted, "the pad that is back does not tilt the plate as before");
}
