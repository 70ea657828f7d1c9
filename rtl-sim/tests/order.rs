//! What waits for what: a swap and a fence for all that was drawn before them, nothing for a reset.

mod common;

use common::pair::Pair;
use common::shapes::{Vertex, triangle};
use fpga_regs::Port;
use fpga_regs::packet::{Clear, Fence, FlatTriangle, swap};
use fpga_regs::registers::{Control, Register, Status};
use fpga_regs::screen::{DEPTH_FAR, Rgb332};
use rtl_sim::{Rtl, UNITS};

fn of(vertices: [Vertex; 3], colour: u8) -> [u32; FlatTriangle::WORDS] {
    triangle(vertices, colour, false).expect("on the screen").encode()
}

/// Half the screen.
fn large(colour: u8) -> [u32; FlatTriangle::WORDS] {
    of([[0, 0, 9000], [5120, 0, 9000], [0, 3840, 9000]], colour)
}

/// A few pixels at a place of their own.
fn small(number: i32) -> [u32; FlatTriangle::WORDS] {
    let (x, y) = (200 + 37 * number, 300 + 53 * number);
    of([[x, y, 50], [x + 70, y, 50], [x, y + 70, 50]], number as u8 | 1)
}

/// Runs VGA to the beginning of the next vertical blank, and lets it stand there.
fn to_vertical_blank(rtl: &mut Rtl) {
    rtl.set_vga_ratio(64 << 16);
    for blank in [false, true] {
        while Status(rtl.read(Register::Status)).vertical_blank() != blank {}
    }
    rtl.set_vga_ratio(0);
}

#[test]
fn a_swap_waits_until_all_before_it_is_drawn() {
    for units in UNITS {
        let mut pair = Pair::new(units);
        pair.rtl.set_hurry(false);
        for round in 0..4u8 {
            // The blank is there all the time: only the drawing is left to wait for.
            to_vertical_blank(&mut pair.rtl);
            pair.push(&Clear { colour: Rgb332(round), depth: DEPTH_FAR }.encode());
            pair.push(&large(0x40 | round));
            pair.push(&small(round.into()));
            pair.push(&swap());
            // What follows a swap is drawn to the other buffer.
            pair.push(&small(i32::from(round) + 20));
            pair.compare_registers("after a swap behind a drawing");
            pair.compare_memories("after a swap behind a drawing");
        }
    }
}

/// Waits for a fence, looking every clock, and then compares at once: nothing may still be on its way.
fn pass_fence(pair: &mut Pair, tag: u32) {
    pair.push(&Fence { tag }.encode());
    let patience = pair.rtl.clocks() + 1_000_000;
    while pair.rtl.read(Register::Fence) != tag {
        assert!(pair.rtl.clocks() < patience, "fence {tag} does not come");
    }
    pair.compare_memories("when a fence has passed");
    for register in [Register::Triangles, Register::PixelsTested, Register::PixelsWritten, Register::FramesShown] {
        assert_eq!(pair.rtl.read(register), pair.model.read(register), "{register:?} when fence {tag} has passed");
    }
}

#[test]
fn a_fence_waits_until_all_before_it_is_drawn() {
    for units in UNITS {
        let mut pair = Pair::new(units);
        for number in 0..20 {
            pair.push(&small(number));
            pass_fence(&mut pair, 1 + number as u32);
        }
        pair.push(&large(0x55));
        pass_fence(&mut pair, 100);
        pair.push(&Clear { colour: Rgb332(9), depth: 7 }.encode());
        pass_fence(&mut pair, 101);
        pair.push(&swap());
        pass_fence(&mut pair, 102);
    }
}

#[test]
fn a_reset_ends_the_drawing_at_once_and_leaves_nothing_behind() {
    for units in UNITS {
        let mut pair = Pair::new(units);
        // From the first words on to the middle of the triangle.
        for wait in (0..24).step_by(2).chain([100, 1000]) {
            pair.push(&large(0x77));
            pair.push(&large(0x78));
            pair.rtl.clock(wait);
            pair.write(Register::Control, Control::default().with_enable(true).with_reset(true).0);
            pair.rtl.clock(1);
            assert!(!pair.rtl.busy(), "busy after a reset, {units} units, {wait} clocks");
            let before = pixels(&mut pair.rtl);
            pair.rtl.clock(200);
            assert!(before == pixels(&mut pair.rtl), "pixels change after a reset, {units} units, {wait} clocks");
            assert_eq!(pair.rtl.read(Register::Triangles), 0);
            pair.push(&Clear { colour: Rgb332(1), depth: DEPTH_FAR }.encode());
            pair.push(&small(3));
            pair.compare(&format!("after a reset {wait} clocks into the drawing"));
        }
    }
}

fn pixels(rtl: &mut Rtl) -> ([Vec<u8>; 2], Vec<u16>) {
    let memories = rtl.memories();
    (memories.colours, memories.depths)
}
