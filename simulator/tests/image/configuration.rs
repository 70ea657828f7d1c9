//! An FPGA that is not configured: told, waited for, configured.

use crate::board::{Board, image};
use simulator::PowerOn;

/// Where U-Boot's script loads an FPGA image.
const FPGA_IMAGE: u32 = 0x0800_0000;

/// A stand-in for an FPGA image: the board is told that it is the right one.
fn bitstream() -> Vec<u8> {
    (0..4_001_u32).map(|index| (index * 7) as u8).collect()
}

fn go(bitstream: &[u8]) -> PowerOn {
    let bytes = format!("{:x}", bitstream.len());
    PowerOn::new(image()).unconfigured().bitstream(&self::bitstream()).loaded(FPGA_IMAGE, bitstream).arguments(&[
        "rbf",
        "0x08000000",
        &bytes,
    ])
}

#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn it_is_waited_for_and_the_led_tells() {
    let mut board = Board::start(PowerOn::new(image()).unconfigured());
    board.says(100, "FPGA not configured (FPGA manager mode 0x2, waits for its image; MSEL 01010)");
    assert_eq!(board.flashes(), 2);
    assert_eq!(board.machine.frames_shown(), 0);
    // Over JTAG, say.
    board.machine.set_fpga_configured(true);
    board.connects();
}

#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn the_program_configures_it_with_what_u_boot_loaded() {
    let mut board = Board::start(go(&bitstream()));
    board.says(100, "configuring the FPGA with 4001 bytes at 0x08000000");
    board.connects();
}

#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn a_damaged_fpga_image_is_refused_and_said_to_be() {
    let mut damaged = bitstream();
    damaged[2_000] ^= 1;
    let mut board = Board::start(go(&damaged));
    board.says(300, "FPGA refused the image (nSTATUS is 0)");
    board.says(100, "FPGA not configured");
    assert_eq!(board.machine.frames_shown(), 0);
    let mut short = Board::start(go(&bitstream()[..2_000]));
    short.says(400, "FPGA waits for more than the image's 2000 bytes (CONF_DONE is 0)");
    short.says(100, "FPGA not configured");
}

#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn a_switch_that_keeps_the_processor_out_is_named() {
    let mut board = Board::start(go(&bitstream()).msel(0b10010));
    board.says(100, "set switch SW10 to MSEL 01010");
    board.says(100, "FPGA not configured");
}

#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn words_behind_go_that_mean_nothing_change_nothing() {
    let mut board = Board::start(PowerOn::new(image()).arguments(&["rfb", "8000000"]));
    board.says(100, "argument `rfb` means nothing");
    board.connects();
}
