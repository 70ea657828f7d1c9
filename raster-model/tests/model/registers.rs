//! The device as the driver sees it.

use fpga_regs::packet::{Clear, Fence, Packet, swap};
use fpga_regs::registers::{Access, Capabilities, Control, Errors, Interrupts, Register, Status};
use fpga_regs::screen::{PIXELS, Rgb332};
use fpga_regs::{Renderer, Timeouts, Wait};
use raster_model::{Device, Memory, SizeError};

use crate::lent::{FIFO_WORDS, Lent};

const ENABLE: u32 = 1;

fn status(device: &Device<'_>) -> Status {
    Status(device.read(Register::Status))
}

fn interrupts(device: &Device<'_>) -> Interrupts {
    Interrupts(device.read(Register::Interrupts))
}

#[test]
fn registers_start_as_the_table_says() {
    let mut lent = Lent::new();
    let device = lent.device();
    for register in Register::ALL {
        if let Some(reset) = register.info().reset {
            assert_eq!(device.read(*register), reset, "{}", register.info().name);
        }
    }
    assert_eq!(device.read(Register::Capabilities), 40 | 1 << 16);
    assert_eq!(device.read(Register::Screen), 320 | 240 << 16);
    assert_eq!(device.read(Register::Status), 40 | 1 << 18);
    let device = device.with_interrupt(true);
    assert!(Capabilities(device.read(Register::Capabilities)).interrupt());
}

#[test]
fn a_write_to_a_read_only_register_is_ignored() {
    let mut lent = Lent::new();
    let mut device = lent.enabled();
    device.push(&Fence { tag: 5 }.encode());
    device.push(&swap());
    let read_all = |device: &Device<'_>| Register::ALL.iter().map(|r| device.read(*r)).collect::<Vec<_>>();
    let before = read_all(&device);
    for register in Register::ALL.iter().filter(|register| register.info().access == Access::ReadOnly) {
        for value in [0, u32::MAX, 0x5555_5555] {
            device.write(*register, value);
        }
    }
    assert_eq!(read_all(&device), before);
}

#[test]
fn a_one_clears_a_flag_and_a_zero_leaves_it() {
    let mut lent = Lent::new();
    let mut device = lent.device();
    device.push(&[0; FIFO_WORDS + 1]);
    device.write(Register::Control, ENABLE);
    device.push(&swap());
    device.push(&Fence { tag: 1 }.encode());
    assert_eq!(device.read(Register::Errors), 0b11);
    assert_eq!(device.read(Register::Interrupts), 0b1111);

    for (register, bits) in [(Register::Errors, 2), (Register::Interrupts, 4)] {
        for bit in 0..bits {
            let before = device.read(register);
            device.write(register, 0);
            assert_eq!(device.read(register), before);
            device.write(register, 1 << bit);
            assert_eq!(device.read(register), before & !(1 << bit));
        }
    }
    assert!(!status(&device).error());
    // What cleared comes back when it happens again.
    device.push(&[0]);
    assert_eq!(Errors(device.read(Register::Errors)), Errors::default().with_bad_packet(true));
    assert!(interrupts(&device).error() && status(&device).error());
}

#[test]
fn an_interrupt_is_pending_when_it_happened_and_is_enabled() {
    let enables: [fn(Control, bool) -> Control; 4] = [
        Control::with_low_water_interrupt,
        Control::with_swap_interrupt,
        Control::with_fence_interrupt,
        Control::with_error_interrupt,
    ];
    for (bit, enable) in enables.into_iter().enumerate() {
        let mut lent = Lent::new();
        let mut device = lent.enabled();
        let enabled = enable(Control::default().with_enable(true), true).0;
        device.write(Register::Control, enabled);
        assert_eq!(device.read(Register::Control), enabled);
        assert!(!device.interrupt_pending());
        device.push(&[swap()[0], 0]);
        device.push(&Fence { tag: 1 }.encode());
        assert_eq!(device.read(Register::Interrupts), 0b1111, "set whatever is enabled");
        assert!(device.interrupt_pending());
        device.write(Register::Interrupts, !(1 << bit));
        assert!(device.interrupt_pending());
        device.write(Register::Control, !enabled & 0xf00 | ENABLE);
        assert!(!device.interrupt_pending(), "only bit {bit} is left");
        device.write(Register::Control, enabled);
        device.write(Register::Interrupts, 1 << bit);
        assert!(!device.interrupt_pending());
    }
}

#[test]
fn a_disabled_device_keeps_words_and_drops_those_that_do_not_fit() {
    let mut lent = Lent::new();
    let mut device = lent.device();
    let clear = Clear { colour: Rgb332(9), depth: 1 }.encode();
    device.push(&clear);
    assert_eq!(device.back()[0], 0, "nothing is drawn");
    assert_eq!((status(&device).fifo_free(), status(&device).busy(), status(&device).mid_packet()), (38, true, false));
    device.push(&[swap()[0]; 37]);
    assert_eq!(device.read(Register::Errors), 0);
    // One fits, two do not; what comes later does not fit either.
    device.push(&[swap()[0], swap()[0], 0]);
    device.push(&[0]);
    assert_eq!(Errors(device.read(Register::Errors)), Errors::default().with_fifo_overflow(true));
    assert!(interrupts(&device).error());
    assert_eq!(status(&device).fifo_free(), 0);

    device.write(Register::Control, ENABLE);
    let counters = device.counters();
    assert_eq!((counters.frames_shown, counters.bad_packets), (38, 0));
    assert_eq!(device.back()[0], 9);
    assert_eq!((status(&device).fifo_free(), status(&device).busy()), (40, false));
}

#[test]
fn disabling_inside_a_packet_holds_its_words_back() {
    let mut lent = Lent::new();
    let mut device = lent.enabled();
    let fence = Fence { tag: 77 }.encode();
    device.push(&fence[..1]);
    device.write(Register::Control, 0);
    device.push(&fence[1..]);
    assert_eq!(device.read(Register::Fence), 0);
    assert!(status(&device).mid_packet());
    device.write(Register::Control, ENABLE);
    assert_eq!(device.read(Register::Fence), 77);
}

#[test]
fn the_low_water_interrupt_comes_when_the_level_falls_from_above_the_mark() {
    let mut lent = Lent::new();
    let mut device = lent.device();
    let clear_flag = |device: &mut Device<'_>| {
        let happened = interrupts(device).low_water();
        device.write(Register::Interrupts, 1);
        happened
    };
    device.write(Register::LowWater, 4);
    assert_eq!(device.read(Register::LowWater), 4);
    for (waiting, raises) in [(4, false), (5, true)] {
        device.write(Register::Control, 0);
        device.push(&vec![swap()[0]; waiting]);
        assert!(!clear_flag(&mut device), "rising does not raise it");
        device.write(Register::Control, ENABLE);
        assert_eq!(clear_flag(&mut device), raises, "{waiting} waiting");
        device.push(&vec![swap()[0]; waiting]);
        assert_eq!(clear_flag(&mut device), raises, "{waiting} pushed");
    }
    device.write(Register::LowWater, 0);
    device.push(&[]);
    assert!(!clear_flag(&mut device));
    device.push(&swap());
    assert!(clear_flag(&mut device));
}

#[test]
fn a_reset_forgets_all_but_the_buffers() {
    let mut lent = Lent::new();
    let mut device = lent.enabled();
    device.push(&Clear { colour: Rgb332(3), depth: 8 }.encode());
    device.push(&swap());
    device.push(&Clear { colour: Rgb332(4), depth: 8 }.encode());
    device.push(&[0, Fence { tag: 0 }.encode()[0]]);
    device.write(Register::LowWater, 7);
    device.write(Register::Control, 0xf00);
    device.push(&[0; FIFO_WORDS + 1]);
    device.write(Register::Control, !ENABLE);
    assert_eq!(device.read(Register::Control), 0xf00, "reset reads 0, what has no meaning too");
    assert_eq!(device.mid_packet(), None);
    assert_eq!(device.read(Register::Status), 40 | 1 << 17 | 1 << 18, "buffer 1 still shows");
    for register in Register::ALL.iter().filter(|register| **register != Register::Control) {
        if let Some(reset) = register.info().reset {
            assert_eq!(device.read(*register), reset, "{}", register.info().name);
        }
    }
    assert_eq!((device.front()[0], device.back()[0], device.depth()[0]), (3, 4, 8));
    device.write(Register::Control, ENABLE);
    assert_eq!(device.read(Register::BadPackets), 0, "the FIFO is empty");
}

struct NoWait;

impl Wait for NoWait {
    const INTERRUPT: bool = false;
    fn wait(&mut self, micros: u32) -> u32 {
        micros
    }
}

#[test]
fn the_driver_accepts_the_model_and_draws_through_it() {
    let mut lent = Lent::new();
    let mut device = lent.device();
    let mut renderer = Renderer::new(&mut device, NoWait, Timeouts::default()).unwrap();
    renderer.clear(Rgb332(0x1c), 3).unwrap();
    renderer.push(&[swap()[0]; 101]).unwrap();
    let tag = renderer.fence().unwrap();
    renderer.wait_fence(tag).unwrap();
    let counters = renderer.counters();
    assert_eq!(counters.frames_shown, 101);
    assert_eq!(device.counters(), counters);
    assert_eq!(device.front()[PIXELS - 1], 0x1c);
}

#[test]
fn buffers_of_a_wrong_size_are_refused_by_name() {
    let (mut right, mut short) = (vec![0u8; PIXELS], vec![0u8; PIXELS - 1]);
    let (mut depth, mut long) = (vec![0u16; PIXELS], vec![0u16; PIXELS + 1]);
    let error = Memory::new([&mut right, &mut short], &mut depth).unwrap_err();
    assert_eq!(error, SizeError::Colour { buffer: 1, found: PIXELS - 1 });
    assert_eq!(error.to_string(), "colour buffer 1 has 76799 bytes: lend one of 76800");
    let mut other = right.clone();
    let error = Memory::new([&mut right, &mut other], &mut long).unwrap_err();
    assert_eq!(error, SizeError::Depth { found: PIXELS + 1 });
    for found in [0, 2 * Packet::MAX_WORDS - 1, 65_536] {
        let memory = Memory::new([&mut right, &mut other], &mut depth).unwrap();
        assert_eq!(Device::new(memory, &mut vec![0; found]).unwrap_err(), SizeError::Fifo { found });
    }
}
