//! Registers, errors and back-pressure of the device, one behaviour a test, at every width.

mod common;

use common::pair::Pair;
use common::shapes::triangle;
use fpga_regs::Port;
use fpga_regs::packet::{Clear, Fence, FlatTriangle, Header, Kind, Span, swap};
use fpga_regs::registers::{Capabilities, Control, Errors, Interrupts, Register, Status};
use fpga_regs::screen::Rgb332;
use rtl_sim::{Rtl, UNITS};

fn enable() -> u32 {
    Control::default().with_enable(true).0
}

fn small_triangle() -> FlatTriangle {
    triangle([[160, 160, 100], [960, 320, 200], [320, 960, 300]], 0xe3, false).expect("on the screen")
}

#[test]
fn registers_read_as_the_model_says_after_reset() {
    for units in UNITS {
        let mut rtl = Rtl::new(units);
        for register in Register::ALL.iter().copied() {
            if let Some(reset) = register.info().reset {
                assert_eq!(rtl.read(register), reset, "{register:?}");
            }
        }
        assert_eq!(rtl.read(Register::Screen), 240 << 16 | 320);
        let expected = Capabilities::default().with_fifo_depth(1024).with_pixel_units(units as u8).with_interrupt(true);
        assert_eq!(rtl.read(Register::Capabilities), expected.0);
        assert_eq!(rtl.read(Register::Status), Status::default().with_fifo_free(1024).0);
    }
}

#[test]
fn unknown_addresses_read_zero_and_read_only_registers_ignore_writes() {
    for units in UNITS {
        let mut pair = Pair::new(units);
        for offset in (0x44..0x1000).step_by(4) {
            pair.rtl.write_offset(offset, !0);
            assert_eq!(pair.rtl.read_offset(offset), 0, "offset {offset:#x}");
        }
        for register in Register::ALL.iter().copied() {
            let keeps = [Register::Control, Register::LowWater, Register::Interrupts, Register::Errors];
            if !keeps.contains(&register) {
                pair.write(register, !0);
            }
        }
        pair.compare("after writes to read-only registers");
        pair.write(Register::LowWater, 0xdead_beef);
        pair.write(Register::Control, !Control::default().with_reset(true).0);
        pair.compare_registers("after writes of ones");
    }
}

#[test]
fn a_read_of_the_aperture_gives_zero_at_once_and_takes_nothing() {
    for units in UNITS {
        let mut pair = Pair::new(units);
        // In the middle of a packet, and with the FIFO full.
        let words = small_triangle().encode();
        pair.push(&words[..5]);
        assert_eq!(pair.rtl.read_aperture(), Some(0));
        pair.push(&words[5..]);
        pair.compare("after a read inside a packet");
        pair.write(Register::Control, 0);
        for _ in 0..93 {
            pair.push(&words);
        }
        pair.push(&[Header::of(Kind::Swap).0]);
        assert_eq!(Status(pair.rtl.read(Register::Status)).fifo_free(), 0);
        assert_eq!(pair.rtl.read_aperture(), Some(0));
        pair.write(Register::Control, enable());
        assert_eq!(pair.rtl.read_aperture(), Some(0));
        pair.compare("after reads of a full FIFO");
        assert_eq!(pair.rtl.read(Register::Errors), 0);
    }
}

#[test]
fn every_way_to_be_bad_is_skipped_and_counted() {
    for units in UNITS {
        let mut pair = Pair::new(units);
        let good = small_triangle().encode();
        let with = |index: usize, word: u32| {
            let mut words = good;
            words[index] = word;
            words
        };
        let clear = Header::of(Kind::Clear).0;
        let gouraud = |index: usize, word: u32| {
            let mut words = [&[Header::of(Kind::GouraudTriangle).0, 0, 0, 0, 0, 0, 0], &good[1..]].concat();
            words[index] = word;
            words
        };
        let bad: [&[u32]; 25] = [
            &[0],
            &[0xff00_0000],
            &[0x03ff_0000],
            &with(0, good[0] | 0x800),
            &with(0, good[0] | 0x8000),
            &gouraud(0, Header::of(Kind::GouraudTriangle).0 | 1),
            &gouraud(2, 1 << 31),
            &gouraud(4, !0),
            &gouraud(6, 1 << 31),
            &gouraud(7, Span::new(0, 320).0),
            &with(1, Span::new(10, 9).0),
            &with(1, Span::new(0, 320).0),
            &with(1, Span::new(0, 0xffff).0),
            &with(2, Span::new(0, 240).0),
            &with(2, Span::new(240, 240).0),
            &with(2, Span::new(9, 8).0),
            &[clear, 0x1_0000],
            &[clear | 0x100, 0],
            &[clear | 0x200, 0],
            &[clear | 0x400, 0],
            &[Header::of(Kind::Swap).0 | 0x200],
            &[Header::of(Kind::Fence).0 | 0x100, 5],
            &[clear + 0x1_0000, 0, 0],
            &[Header::of(Kind::Swap).0 | 1],
            &[Header::of(Kind::Fence).0 | 1, 5],
        ];
        for &words in &bad {
            pair.push(words);
            // 255 words are skipped behind the longest.
            if words == [0x03ff_0000] {
                pair.push(&[clear; 255]);
            }
            pair.compare_registers(&format!("after {words:x?}"));
            pair.push(&good);
        }
        pair.compare("in the end");
        assert_eq!(pair.rtl.read(Register::BadPackets), bad.len() as u32);
        assert_eq!(pair.rtl.read(Register::Errors), Errors::default().with_bad_packet(true).0);
    }
}

#[test]
fn a_full_fifo_drops_words_while_disabled_and_holds_the_bus_while_enabled() {
    for units in UNITS {
        let mut pair = Pair::new(units);
        pair.write(Register::Control, 0);
        // A clear, so that the FIFO drains slowly, then triangles: 2 + 11 * 100 words, 1,024 kept.
        pair.push(&Clear { colour: Rgb332(3), depth: 0xffff }.encode());
        for _ in 0..100 {
            pair.push(&small_triangle().encode());
        }
        assert_eq!(pair.rtl.read(Register::Status) & 0xffff, 0);
        assert_eq!(pair.rtl.read(Register::Errors), Errors::default().with_fifo_overflow(true).0);
        pair.write(Register::Errors, !0);
        pair.write(Register::Control, enable());
        // 1,022 words end 10 words into a triangle.
        let rest = [0u32; 1];
        let held = pair.rtl.push_word(rest[0]);
        pair.model.push(&rest);
        assert!(held < 20, "a word was held for {held} clocks while the FIFO drained");
        let mut longest = 0;
        for _ in 0..200 {
            let words = small_triangle().encode();
            pair.model.push(&words);
            for word in words {
                longest = longest.max(pair.rtl.push_word(word));
            }
        }
        assert!(longest > 0, "the FIFO was never full");
        pair.compare("after the FIFO was full");
        assert_eq!(pair.rtl.read(Register::Errors), 0);
    }
}

#[test]
fn a_write_never_hangs_even_when_vga_stands_still() {
    let mut pair = Pair::new(8);
    pair.rtl.set_hurry(false);
    // A swap that never comes, and more words than fit behind it.
    pair.rtl.push(&swap());
    for _ in 0..1024 {
        assert_eq!(pair.rtl.push_word(Header::of(Kind::Fence).0), 0);
    }
    // The decoder has not taken one of them; the next word waits, and is given up.
    let held = pair.rtl.push_word(0);
    assert!((1_000_000..=2_000_000).contains(&held), "held for {held} clocks");
    assert_eq!(pair.rtl.read(Register::Errors), Errors::default().with_fifo_overflow(true).0);
    // From then on nothing waits, until there is space again.
    assert_eq!(pair.rtl.push_word(0), 0);
    assert!(pair.rtl.swap_pending());
    pair.rtl.write(Register::Control, Control::default().with_enable(true).with_reset(true).0);
    pair.model.write(Register::Control, Control::default().with_enable(true).with_reset(true).0);
    pair.push(&small_triangle().encode());
    pair.compare("after reset");
}

#[test]
fn reset_forgets_a_packet_under_way_and_what_waits() {
    for units in UNITS {
        let mut pair = Pair::new(units);
        for taken in 1..11 {
            pair.push(&small_triangle().encode()[..taken]);
            pair.rtl.drain(1000);
            pair.rtl.clock(1000);
            pair.compare_at_rest("inside a packet");
            pair.write(Register::LowWater, 7);
            pair.push(&[]);
            pair.write(Register::Control, enable() | Control::default().with_reset(true).0);
            pair.compare_registers("after reset");
            pair.push(&small_triangle().encode());
            pair.compare("after a triangle");
        }
        pair.write(Register::Control, 0);
        pair.push(&[0; 50]);
        pair.rtl.clock(100);
        pair.compare_at_rest("while disabled");
        pair.write(Register::Control, Control::default().with_reset(true).0);
        pair.compare_registers("after reset of a full FIFO");
    }
}

#[test]
fn each_interrupt_is_raised_enabled_and_cleared() {
    for units in UNITS {
        let mut pair = Pair::new(units);
        pair.write(Register::Interrupts, !0);
        let cases: [(&[u32], Interrupts, Control); 3] = [
            (&swap(), Interrupts::default().with_swap(true), Control::default().with_swap_interrupt(true)),
            (
                &Fence { tag: 9 }.encode(),
                Interrupts::default().with_fence(true),
                Control::default().with_fence_interrupt(true),
            ),
            (&[0], Interrupts::default().with_error(true), Control::default().with_error_interrupt(true)),
        ];
        let low_water = Interrupts::default().with_low_water(true).0;
        pair.write(Register::LowWater, 500);
        for (words, raised, enabled) in cases {
            pair.push(words);
            pair.compare_registers("after an interrupt");
            assert_eq!(pair.rtl.read(Register::Interrupts) & !low_water, raised.0);
            assert!(!pair.rtl.irq());
            pair.write(Register::Control, enable() | enabled.0);
            pair.rtl.clock(2);
            assert!(pair.rtl.irq(), "{raised:?}");
            pair.write(Register::Interrupts, !raised.0);
            pair.rtl.clock(2);
            assert!(pair.rtl.irq(), "a zero clears nothing");
            pair.write(Register::Interrupts, raised.0);
            pair.rtl.clock(2);
            assert!(!pair.rtl.irq());
            pair.write(Register::Control, enable());
        }
        assert_eq!(pair.rtl.read(Register::Interrupts), 0, "the level was never above 500");
        // Low water: fill above the mark while disabled, then let it drain.
        pair.write(Register::Control, Control::default().with_low_water_interrupt(true).0);
        for _ in 0..60 {
            pair.push(&small_triangle().encode());
        }
        pair.rtl.clock(5);
        assert!(!pair.rtl.irq());
        pair.write(Register::LowWater, 2000);
        pair.rtl.clock(5);
        assert!(!pair.rtl.irq(), "raising the mark is no fall");
        pair.write(Register::LowWater, 500);
        pair.write(Register::Control, enable() | Control::default().with_low_water_interrupt(true).0);
        pair.rtl.rest(100_000);
        assert_eq!(pair.rtl.read(Register::Interrupts), low_water);
        assert!(pair.rtl.irq());
        pair.compare("after draining");
    }
}

#[test]
fn one_swap_a_vertical_blank() {
    let mut pair = Pair::new(4);
    let before = pair.rtl.read(Register::FramesShown);
    pair.rtl.set_hurry(false);
    pair.rtl.set_vga_ratio(4 << 16);
    for _ in 0..3 {
        pair.push(&swap());
    }
    let frame = 800 * 525 / 4;
    let start = pair.rtl.clocks();
    pair.rtl.rest(4 * frame);
    let clocks = pair.rtl.clocks() - start;
    assert!(clocks > 2 * frame - frame / 5, "three swaps took {clocks} clocks");
    assert_eq!(pair.rtl.read(Register::FramesShown) - before, 3);
}
