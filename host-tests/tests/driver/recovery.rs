//! Errors, the way back from them, and fences.

use fpga_regs::packet::swap;
use fpga_regs::registers::{Control, Errors, ID_HALF};
use fpga_regs::screen::Rgb332;

use super::*;

#[test]
fn an_error_flag_stops_the_push_and_says_which() {
    for errors in [
        Errors::default().with_bad_packet(true),
        Errors::default().with_fifo_overflow(true),
        Errors::default().with_bad_packet(true).with_fifo_overflow(true),
    ] {
        let (mock, mut renderer) = started(Behaviour::default());
        renderer.push(&fences(512)).expect("1,024 words fit");
        mock.raise(errors);
        mock.answer(Register::BadPackets, 3);
        let expected = RenderError::Device { errors, bad_packets: 3 };
        assert_eq!(renderer.push(&[0]), Err(expected));
        assert_eq!(renderer.check_device(), Err(expected));
        assert_eq!(mock.stream(), fences(512), "nothing went to a device in error");
    }
}

#[test]
fn a_reset_is_the_way_back_from_every_error() {
    let (mock, mut renderer) = started(Behaviour { words_per_microsecond: 0, ..Behaviour::default() });
    renderer.push(&fences(512)).expect("1,024 words fit");
    assert!(matches!(renderer.push(&[0]), Err(RenderError::FifoStuck { .. })));
    mock.raise(Errors::default().with_bad_packet(true));
    mock.take_journal();
    renderer.reset().expect("it resets");
    let expected = [
        Access::Write(Register::Control, Control::default().with_reset(true).0),
        Access::Read(Register::Control, 0),
        Access::Write(Register::LowWater, 512),
        Access::Write(Register::Control, 0xF01),
    ];
    assert_eq!(mock.take_journal(), expected);
    mock.behave(|behaviour| behaviour.words_per_microsecond = 25);
    renderer.clear(Rgb332(3), 0xffff).expect("there is room");
    renderer.swap().expect("there is room");
    let tag = renderer.fence().expect("there is room");
    renderer.wait_fence(tag).expect("it drains");
    let expected = [&[0x0101_0003, 0xffff][..], &swap(), &Fence { tag }.encode()].concat();
    assert_eq!(mock.stream(), expected, "the stream begins anew");
}

/// An FPGA that was configured again is not believed to be the one that it was.
#[test]
fn a_restart_looks_at_the_device_as_the_start_did() {
    let (mock, mut renderer) = started(Behaviour::default());
    mock.behave(|behaviour| behaviour.manager_mode = 2);
    mock.take_journal();
    assert!(matches!(renderer.restart(), Err(RenderError::NotConfigured(_))));
    assert_eq!(mock.take_journal(), [Access::Configured]);
    mock.behave(|behaviour| behaviour.manager_mode = 4);
    mock.answer(Register::Id, 7);
    assert_eq!(renderer.restart(), Err(RenderError::WrongId { found: 7 }));
    mock.answer(Register::Id, ID_HALF);
    mock.answer(Register::Capabilities, 1 << 24 | 4 << 16 | 512);
    renderer.restart().expect("it is ours");
    assert_eq!((renderer.capabilities().pixel_units(), renderer.capabilities().fifo_depth()), (4, 512));
    assert!(mock.take_journal().contains(&Access::Write(Register::LowWater, 256)));
}

#[test]
fn after_a_reset_the_space_is_looked_up_again() {
    let (mock, mut renderer) = started(Behaviour::default());
    renderer.push(&[1, 2]).expect("there is room");
    renderer.reset().expect("it resets");
    mock.take_journal();
    renderer.push(&[3]).expect("there is room");
    let clear = Access::Write(Register::Interrupts, EVERY_INTERRUPT);
    assert_eq!(mock.take_journal(), [clear, Access::Read(Register::Status, 1024), Access::Push(vec![3])]);
}

#[test]
fn stopping_idles_the_device() {
    let (mock, mut renderer) = started(Behaviour::default());
    renderer.stop();
    assert_eq!(mock.take_journal(), [Access::Write(Register::Control, 0)]);
}

#[test]
fn a_fence_is_waited_for_and_every_interrupt_cleared_before_each_look() {
    let (mock, mut renderer) = started(Behaviour { words_per_microsecond: 1, ..Behaviour::default() });
    let first = renderer.fence().expect("there is room");
    let second = renderer.fence().expect("there is room");
    assert_ne!(first, second);
    mock.take_journal();
    renderer.wait_fence(second).expect("it drains");
    let status = 1024 - 4;
    let clear = Access::Write(Register::Interrupts, EVERY_INTERRUPT);
    let expected = [
        clear.clone(),
        Access::Read(Register::Fence, 0),
        Access::Read(Register::Status, status),
        Access::Wait(1_000),
        clear,
        Access::Read(Register::Fence, second),
    ];
    assert_eq!(mock.take_journal(), expected);
    renderer.wait_fence(first).expect("a later fence has passed this one too");
}

#[test]
fn a_fence_that_does_not_pass_is_given_up_after_its_time() {
    let (mock, mut renderer) = polled(Behaviour { words_per_microsecond: 0, ..Behaviour::default() });
    let tag = renderer.fence().expect("there is room");
    mock.take_journal();
    let expected = RenderError::FenceTimeout { waited_us: 100_000, expected: tag, found: 0 };
    assert_eq!(renderer.wait_fence(tag), Err(expected));
    assert_eq!(waited_us(&mock.take_journal()), 100_000);
    mock.raise(Errors::default().with_bad_packet(true));
    assert!(matches!(renderer.wait_fence(tag), Err(RenderError::Device { .. })), "an error is told at once");
    assert_eq!(waited_us(&mock.journal()), 0);
}

#[test]
fn tags_wrap() {
    let (mock, mut renderer) = polled(Behaviour { words_per_microsecond: 0, ..Behaviour::default() });
    for (found, tag, passed) in [
        (u32::MAX, u32::MAX, true),
        (0, u32::MAX, true),
        (3, u32::MAX - 3, true),
        (u32::MAX, 0, false),
        (u32::MAX - 1, 3, false),
        (0x8000_0000, 0x7fff_ffff, true),
        (0x7fff_ffff, 0x8000_0000, false),
    ] {
        mock.answer(Register::Fence, found);
        assert_eq!(renderer.wait_fence(tag).is_ok(), passed, "FENCE {found:#x}, tag {tag:#x}");
    }
}

#[test]
fn an_interrupt_is_waited_for_longer_than_a_poll() {
    let longest = |journal: &[Access]| {
        journal.iter().map(|access| if let Access::Wait(micros) = access { *micros } else { 0 }).max()
    };
    let (mock, mut renderer) = started(Behaviour::default());
    renderer.push(&fences(1_000)).expect("it drains");
    assert_eq!(longest(&mock.journal()), Some(1_000));
    let (mock, mut renderer) = polled(Behaviour::default());
    renderer.push(&fences(1_000)).expect("it drains");
    assert_eq!(longest(&mock.journal()), Some(20));
}

#[test]
fn every_error_names_its_value_and_a_remedy() {
    let (mock, mut renderer) = polled(Behaviour { words_per_microsecond: 0, ..Behaviour::default() });
    renderer.push(&fences(512)).expect("1,024 words fit");
    let stuck = renderer.push(&[0]).expect_err("nothing leaves").to_string();
    assert!(stuck.contains("100000 µs") && stuck.contains("reset"), "{stuck}");
    mock.answer(Register::Id, 0xdead_beef);
    let wrong = refused(&mock).to_string();
    assert!(wrong.contains("0xdeadbeef") && wrong.contains("load"), "{wrong}");
}
