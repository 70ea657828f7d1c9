//! A clock or a reset that is turned the wrong way under the program: the run stops, and the report names the
//! address, the instruction and what it needed.

use crate::board::Board;
use simulator::Violation;
use simulator::image::LOAD_ADDRESS;
use simulator::time::milliseconds;

const PERMODRST: u32 = 0x14;
const USB1: u32 = 1 << 3;
/// The clock manager's gates of the peripheral PLL, and the one of the USB controllers.
const PERIPHERAL_GATES: u32 = 0xA0;
const USB_MP: u32 = 1 << 2;

#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn a_block_that_is_put_into_reset_stops_the_run() {
    let mut board = Board::connected();
    board.machine.hardware(|hardware| {
        let held = hardware.resets.read(PERMODRST).unwrap();
        hardware.resets.write(PERMODRST, held | USB1).unwrap();
    });
    let violation = board.machine.run(milliseconds(10)).expect_err("the program polls USB1 each millisecond");
    assert_eq!(violation.block, "USB1");
    report(&violation, 0xFFB4_0000..0xFFB8_0000, "clear bit 3 of PERMODRST");
}

#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn a_clock_that_is_turned_off_stops_the_run() {
    let mut board = Board::connected();
    board.machine.hardware(|hardware| hardware.clocks.write(PERIPHERAL_GATES, 0xFFF & !USB_MP).unwrap());
    let violation = board.machine.run(milliseconds(10)).expect_err("the program polls USB1 each millisecond");
    report(&violation, 0xFFB4_0000..0xFFB8_0000, "its clock: Peripheral(2)");
}

#[track_caller]
fn report(violation: &Violation, block: std::ops::Range<u32>, needed: &str) {
    let text = violation.to_string();
    println!("{text}");
    assert!(block.contains(&violation.address), "{text}");
    assert!(text.contains(needed), "{text}");
    assert!((LOAD_ADDRESS..LOAD_ADDRESS + (1 << 18)).contains(&violation.instruction), "{text}");
    assert!(violation.disassembly.contains("LDR") || violation.disassembly.contains("STR"), "{text}");
}
