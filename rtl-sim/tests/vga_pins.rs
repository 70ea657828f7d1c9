//! The picture that comes out of the VGA pins.

mod common;

use common::pair::Pair;
use common::random::Random;
use common::shapes::any_triangle;
use fpga_regs::Port;
use fpga_regs::packet::{Clear, swap};
use fpga_regs::registers::Register;
use fpga_regs::screen::Rgb332;
use rtl_sim::{Frame, Rtl, UNITS};

#[test]
fn the_pins_show_the_models_front_buffer_with_the_timing_of_640_by_480() {
    for units in UNITS {
        let mut pair = Pair::new(units);
        let mut random = Random::new(5);
        for _ in 0..400 {
            let triangle = any_triangle(&mut random);
            pair.push(&triangle.encode());
        }
        pair.push(&swap());
        pair.compare("before the frame");
        let frame = Frame::take(&mut pair.rtl, |_| ()).expect("the timing is right");
        for y in 0..480 {
            for x in 0..640 {
                let expected = Rgb332(pair.model.front()[y / 2 * 320 + x / 2]).to_rgb888();
                assert_eq!(frame.pixel(x, y), expected, "pixel ({x}, {y}) at {units} units");
            }
        }
    }
}

#[test]
fn no_frame_tears_while_the_stream_swaps_as_fast_as_it_can() {
    let mut pair = Pair::new(8);
    pair.rtl.set_hurry(false);
    for colour in 0..250 {
        pair.push(&Clear { colour: Rgb332(colour), depth: 0xffff }.encode());
        pair.push(&swap());
    }
    let mut colours = Vec::new();
    for _ in 0..4 {
        // The bus runs at twice VGA's rate.
        let frame = Frame::take(&mut pair.rtl, |rtl| rtl.clock(2)).expect("the timing is right");
        let colour = frame.pixel(0, 0);
        for y in 0..480 {
            for x in 0..640 {
                assert_eq!(frame.pixel(x, y), colour, "({x}, {y}) is of another frame");
            }
        }
        colours.push(colour);
    }
    colours.dedup();
    assert_eq!(colours.len(), 4, "every frame has a colour of its own: {colours:?}");
}

#[test]
fn the_test_pattern_needs_no_software() {
    for units in UNITS {
        let mut rtl = Rtl::new(units);
        rtl.set_test_pattern(true);
        let frame = Frame::take(&mut rtl, |_| ()).expect("the timing is right");
        for (x, y) in [(0, 0), (639, 0), (0, 479), (639, 479), (320, 1), (638, 200)] {
            assert_eq!(frame.pixel(x, y), [255; 3], "the frame around at ({x}, {y})");
        }
        assert_eq!(frame.pixel(32, 100), [0; 3], "the first bar is black");
        assert_eq!(frame.pixel(64 + 32, 100), [0, 0, 255]);
        assert_eq!(frame.pixel(256 + 32, 100), [255, 0, 0]);
        assert_eq!(rtl.read(Register::Triangles), 0);
    }
}
