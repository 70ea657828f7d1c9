//! The driver against the mock device: every access in its order, flow control, time-outs,
//! recovery.

use fpga_regs::error::NotConfigured;
use fpga_regs::mock::{Access, Behaviour, Mock, Polled};
use fpga_regs::packet::{Fence, swap};
use fpga_regs::registers::{
    Capabilities, Control, Errors, ID_HALF, Interrupts, Register, Screen, VERSION_MAJOR, Version,
};
use fpga_regs::screen::{HEIGHT, Rgb332, WIDTH};
use fpga_regs::{RenderError, Renderer, Timeouts, Wait};
use host_tests::rng::Rng;

fn started(behaviour: Behaviour) -> (Mock, Renderer<Mock, Mock>) {
    let mock = Mock::new(behaviour);
    let renderer =
        Renderer::new(mock.clone(), mock.clone(), Timeouts::default()).expect("the device is as it should be");
    mock.take_journal();
    (mock, renderer)
}

fn polled(behaviour: Behaviour) -> (Mock, Renderer<Mock, Polled>) {
    let mock = Mock::new(behaviour);
    let wait = Polled(mock.clone());
    let renderer = Renderer::new(mock.clone(), wait, Timeouts::default()).expect("the device is as it should be");
    mock.take_journal();
    (mock, renderer)
}

fn refused(mock: &Mock) -> RenderError {
    Renderer::new(mock.clone(), mock.clone(), Timeouts::default()).expect_err("the device is not as it should be")
}

/// Fence packets with tags that tell their place in the stream.
fn fences(count: u32) -> Vec<u32> {
    (0..count).flat_map(|tag| Fence { tag }.encode()).collect()
}

fn status_reads(journal: &[Access]) -> usize {
    journal.iter().filter(|access| matches!(access, Access::Read(Register::Status, _))).count()
}

fn waited_us(journal: &[Access]) -> u32 {
    journal.iter().map(|access| if let Access::Wait(micros) = access { *micros } else { 0 }).sum()
}

#[test]
fn the_start_is_this_and_nothing_else() {
    let mock = Mock::new(Behaviour::default());
    let version = Version::default().with_major(VERSION_MAJOR).0;
    let screen = HEIGHT << 16 | WIDTH;
    let capabilities = 1 << 24 | 1 << 16 | 1024;
    Renderer::new(mock.clone(), mock.clone(), Timeouts::default()).expect("the device is as it should be");
    // Reset is bit 1; enable bit 0, low-water interrupt bit 8, fence interrupt bit 10.
    let expected = [
        Access::Configured,
        Access::Read(Register::Id, ID_HALF),
        Access::Read(Register::Version, version),
        Access::Read(Register::Screen, screen),
        Access::Read(Register::Capabilities, capabilities),
        Access::Write(Register::Control, 0x002),
        Access::Read(Register::Control, 0),
        Access::Write(Register::LowWater, 512),
        Access::Write(Register::Control, 0x501),
    ];
    assert_eq!(*mock.journal(), expected);
}

#[test]
fn interrupts_are_enabled_only_where_both_sides_have_them() {
    let last_control = |mock: &Mock| match mock.journal().last() {
        Some(Access::Write(Register::Control, value)) => Control(*value),
        other => panic!("the start ended with {other:?}"),
    };
    let expected = Control::default().with_enable(true);
    let mock = Mock::new(Behaviour { interrupt: false, ..Behaviour::default() });
    Renderer::new(mock.clone(), mock.clone(), Timeouts::default()).expect("it starts");
    assert_eq!(last_control(&mock), expected);
    let mock = Mock::new(Behaviour::default());
    Renderer::new(mock.clone(), Polled(mock.clone()), Timeouts::default()).expect("it starts");
    assert_eq!(last_control(&mock), expected);
}

#[test]
fn an_fpga_that_is_not_configured_is_not_touched() {
    for manager_mode in [0, 1, 2, 3, 5, 7] {
        let mock = Mock::new(Behaviour { manager_mode, ..Behaviour::default() });
        assert_eq!(refused(&mock), RenderError::NotConfigured(NotConfigured { mode: manager_mode }));
        assert_eq!(*mock.journal(), [Access::Configured], "mode {manager_mode}");
    }
}

#[test]
fn a_device_that_is_not_ours_is_read_up_to_where_it_differs_and_never_written() {
    let version = |major: u16, minor: u16| Version::default().with_major(major).with_minor(minor).0;
    let screen = |width: u16, height: u16| Screen::default().with_width(width).with_height(height).0;
    let capabilities = |depth: u16, units: u8| Capabilities::default().with_fifo_depth(depth).with_pixel_units(units).0;
    let cases = [
        (Register::Id, 0, RenderError::WrongId { found: 0 }, 1),
        (Register::Id, u32::MAX, RenderError::WrongId { found: u32::MAX }, 1),
        (Register::Id, ID_HALF.swap_bytes(), RenderError::WrongId { found: ID_HALF.swap_bytes() }, 1),
        (Register::Version, version(2, 0), RenderError::WrongVersion { major: 2, minor: 0 }, 2),
        (Register::Version, version(0, 9), RenderError::WrongVersion { major: 0, minor: 9 }, 2),
        (Register::Screen, screen(640, 480), RenderError::WrongScreen { width: 640, height: 480 }, 3),
        (Register::Screen, screen(240, 320), RenderError::WrongScreen { width: 240, height: 320 }, 3),
        (
            Register::Capabilities,
            capabilities(21, 1),
            RenderError::WrongCapabilities { fifo_depth: 21, pixel_units: 1 },
            4,
        ),
        (
            Register::Capabilities,
            capabilities(1024, 0),
            RenderError::WrongCapabilities { fifo_depth: 1024, pixel_units: 0 },
            4,
        ),
    ];
    for (register, answer, expected, reads) in cases {
        let mock = Mock::new(Behaviour::default());
        mock.answer(register, answer);
        assert_eq!(refused(&mock), expected);
        let journal = mock.take_journal();
        assert!(journal[1..].iter().all(|access| matches!(access, Access::Read(..))), "{expected:?}: {journal:?}");
        assert_eq!(journal.len(), 1 + reads, "{expected:?}: {journal:?}");
    }
}

#[test]
fn a_newer_minor_version_and_the_smallest_fifo_will_do() {
    let mock = Mock::new(Behaviour { fifo_depth: 22, ..Behaviour::default() });
    mock.answer(Register::Version, Version::default().with_major(VERSION_MAJOR).with_minor(999).0);
    assert!(Renderer::new(mock.clone(), mock.clone(), Timeouts::default()).is_ok());
}

#[test]
fn a_reset_that_sticks_is_given_up_after_its_time_and_not_before() {
    let mock = Mock::new(Behaviour { reset_sticks: true, ..Behaviour::default() });
    let error = Renderer::new(mock.clone(), Polled(mock.clone()), Timeouts::default()).expect_err("it sticks");
    assert_eq!(error, RenderError::ResetStuck { waited_us: 1_000 });
    assert_eq!(waited_us(&mock.journal()), 1_000);
}

/// A FIFO that takes all: one STATUS read finds the space, and no other follows until it is used up.
#[test]
fn status_is_read_once_a_refill() {
    let (mock, mut renderer) = started(Behaviour::default());
    for tag in 0..512 {
        renderer.push(&Fence { tag }.encode()).expect("there is room");
    }
    let journal = mock.take_journal();
    assert_eq!(status_reads(&journal), 1, "1,024 words in 512 pushes");
    assert!(matches!(journal[1], Access::Read(Register::Status, 1024)), "{:?}", journal[1]);
    // The FIFO is full: the next word finds none free, waits, and finds what has drained.
    renderer.push(&[7]).expect("it drains");
    let clear = Access::Write(Register::Interrupts, Interrupts::default().with_low_water(true).0);
    let expected = [
        clear.clone(),
        Access::Read(Register::Status, 0),
        Access::Wait(1_000),
        clear,
        Access::Read(Register::Status, 1024),
        Access::Push(vec![7]),
    ];
    assert_eq!(*mock.journal(), expected);
}

#[test]
fn the_stream_arrives_word_for_word_and_never_overflows() {
    let mut rng = Rng(61);
    for round in 0..150 {
        let behaviour = Behaviour {
            fifo_depth: rng.pick(&[22, 23, 31, 64, 100, 1024]),
            words_per_microsecond: rng.pick(&[1, 2, 3, 25]),
            interrupt: rng.once_in(2),
            ..Behaviour::default()
        };
        let words = fences(rng.within(1, 700) as u32);
        let chunk_size = rng.pick(&[1, 2, 3, 11, 100, 5_000]);
        let push_all = |push: &mut dyn FnMut(&[u32]) -> Result<(), RenderError>, rng: &mut Rng| {
            let mut rest = &words[..];
            while !rest.is_empty() {
                let (now, later) = rest.split_at(rest.len().min(rng.within(1, chunk_size) as usize));
                push(now).expect("it drains");
                rest = later;
            }
        };
        let (mock, pushed) = if rng.once_in(2) {
            let (mock, mut renderer) = started(behaviour);
            push_all(&mut |words| renderer.push(words), &mut rng);
            (mock, renderer.words_pushed())
        } else {
            let (mock, mut renderer) = polled(behaviour);
            push_all(&mut |words| renderer.push(words), &mut rng);
            (mock, renderer.words_pushed())
        };
        assert_eq!(mock.stream(), words, "round {round}: {behaviour:?}");
        assert_eq!(pushed, words.len() as u64);
        let mut mock = mock;
        assert_eq!(fpga_regs::Port::read(&mut mock, Register::Errors), 0, "round {round}: {behaviour:?}");
    }
}

/// Two reads for every half FIFO: one that finds too little, one after the wait.
#[test]
fn status_reads_are_few() {
    for (fifo_depth, words_per_microsecond) in [(1024, 25), (1024, 600), (256, 25), (64, 10)] {
        let behaviour = Behaviour { fifo_depth, words_per_microsecond, ..Behaviour::default() };
        let words = fences(3_000);
        let (mock, mut renderer) = started(behaviour);
        words.chunks(11).for_each(|packet| renderer.push(packet).expect("it drains"));
        let reads = status_reads(&mock.take_journal());
        let bound = 2 * words.len() / (usize::from(fifo_depth) / 2) + 2;
        println!("{behaviour:?}: {reads} STATUS reads for {} words, bound {bound}", words.len());
        assert!(reads <= bound, "{reads} STATUS reads for {} words, {behaviour:?}", words.len());
    }
    // Polling a FIFO that drains slowly: a look that finds too little, and one after each wait.
    let (mock, mut renderer) = polled(Behaviour { words_per_microsecond: 1, ..Behaviour::default() });
    let words = fences(3_000);
    words.chunks(11).for_each(|packet| renderer.push(packet).expect("it drains"));
    let journal = mock.take_journal();
    let bound = 2 * waited_us(&journal) as usize / 20 + 2;
    assert!(status_reads(&journal) <= bound, "{} reads, bound {bound}", status_reads(&journal));
}

/// Ends a wait as the low-water interrupt does; the microseconds that it took are told.
struct Interrupted(Mock);

impl Wait for Interrupted {
    const INTERRUPT: bool = true;

    fn wait(&mut self, micros: u32) -> u32 {
        for waited in 1..=micros {
            self.0.wait(1);
            if Interrupts(fpga_regs::Port::read(&mut self.0, Register::Interrupts)).low_water() {
                return waited;
            }
        }
        micros
    }
}

#[test]
fn a_wait_that_the_interrupt_ends_goes_on_at_half_a_fifo() {
    let mock = Mock::new(Behaviour { words_per_microsecond: 4, ..Behaviour::default() });
    let mut renderer =
        Renderer::new(mock.clone(), Interrupted(mock.clone()), Timeouts::default()).expect("the device starts");
    mock.take_journal();
    let words = fences(4_096);
    renderer.push(&words).expect("it drains");
    assert_eq!(mock.stream(), words);
    let journal = mock.take_journal();
    // 7,168 words beyond the first FIFO, 512 a wait of 128 µs.
    assert_eq!(waited_us(&journal), 14 * 128);
    assert_eq!(status_reads(&journal), 1 + 2 * 14);
}

/// The FIFO falls to its mark between the driver's look at STATUS and its wait: the interrupt has
/// come already, and must not be lost.
#[test]
fn an_interrupt_that_comes_before_the_wait_is_not_lost() {
    /// Drains one word when STATUS has been read, as a device that does not stand still.
    struct Draining(Mock);

    impl fpga_regs::Port for Draining {
        fn read(&mut self, register: Register) -> u32 {
            let value = self.0.read(register);
            if register == Register::Status {
                self.0.wait(1);
            }
            value
        }
        fn write(&mut self, register: Register, value: u32) {
            self.0.write(register, value);
        }
        fn push(&mut self, words: &[u32]) {
            self.0.push(words);
        }
    }

    let mock = Mock::new(Behaviour { fifo_depth: 22, words_per_microsecond: 1, ..Behaviour::default() });
    let mut renderer = Renderer::new(Draining(mock.clone()), Interrupted(mock.clone()), Timeouts::default())
        .expect("the device starts");
    // From 22 words down to 12: one above the mark of 11.
    renderer.push(&fences(11)).expect("it fits");
    mock.clone().wait(10);
    mock.take_journal();
    renderer.push(&fences(6)).expect("it drains");
    let waited = waited_us(&mock.take_journal());
    assert!(waited <= 30, "waited {waited} µs for 12 words that leave at one a microsecond");
}

#[test]
fn a_fifo_that_takes_nothing_is_given_up_after_its_time_and_not_before() {
    let timeouts = Timeouts::default();
    let (mock, mut renderer) = polled(Behaviour { words_per_microsecond: 0, ..Behaviour::default() });
    renderer.push(&fences(512)).expect("1,024 words fit");
    mock.take_journal();
    let error = renderer.push(&fences(50)).expect_err("nothing leaves");
    assert_eq!(error, RenderError::FifoStuck { waited_us: timeouts.fifo_us, free: 0, pending: 100 });
    assert_eq!(waited_us(&mock.journal()), timeouts.fifo_us);
    assert_eq!(mock.stream(), fences(512), "what came before is whole");
    // By interrupt it looks every fiftieth time; the time is the same.
    let (mock, mut renderer) = started(Behaviour { words_per_microsecond: 0, ..Behaviour::default() });
    renderer.push(&fences(512)).expect("1,024 words fit");
    mock.take_journal();
    assert_eq!(renderer.push(&[0]), Err(RenderError::FifoStuck { waited_us: timeouts.fifo_us, free: 0, pending: 1 }));
    assert_eq!(waited_us(&mock.journal()), timeouts.fifo_us);
}

/// Takes one word every `period_us`.
struct Trickling {
    mock: Mock,
    period_us: u32,
    waited_us: u32,
}

impl Wait for Trickling {
    const INTERRUPT: bool = false;

    fn wait(&mut self, micros: u32) -> u32 {
        self.waited_us += micros;
        if self.waited_us >= self.period_us {
            self.waited_us = 0;
            self.mock.behave(|behaviour| behaviour.words_per_microsecond = 1);
            self.mock.wait(1);
            self.mock.behave(|behaviour| behaviour.words_per_microsecond = 0);
        }
        micros
    }
}

#[test]
fn a_fifo_that_takes_a_word_in_time_is_waited_for() {
    for (period_us, patient) in [(99_000, true), (101_000, false)] {
        let mock = Mock::new(Behaviour { fifo_depth: 22, words_per_microsecond: 0, ..Behaviour::default() });
        let wait = Trickling { mock: mock.clone(), period_us, waited_us: 0 };
        let mut renderer = Renderer::new(mock.clone(), wait, Timeouts::default()).expect("the device starts");
        let words = fences(16);
        let result = renderer.push(&words);
        assert_eq!(result.is_ok(), patient, "a word every {period_us} µs: {result:?}");
        assert_eq!(mock.stream() == words, patient);
    }
}

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
    let control = Control::default().with_enable(true).with_low_water_interrupt(true).with_fence_interrupt(true);
    let expected = [
        Access::Write(Register::Control, Control::default().with_reset(true).0),
        Access::Read(Register::Control, 0),
        Access::Write(Register::LowWater, 512),
        Access::Write(Register::Control, control.0),
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

#[test]
fn after_a_reset_the_space_is_looked_up_again() {
    let (mock, mut renderer) = started(Behaviour::default());
    renderer.push(&[1, 2]).expect("there is room");
    renderer.reset().expect("it resets");
    mock.take_journal();
    renderer.push(&[3]).expect("there is room");
    let clear = Access::Write(Register::Interrupts, Interrupts::default().with_low_water(true).0);
    assert_eq!(mock.take_journal(), [clear, Access::Read(Register::Status, 1024), Access::Push(vec![3])]);
}

#[test]
fn stopping_idles_the_device() {
    let (mock, mut renderer) = started(Behaviour::default());
    renderer.stop();
    assert_eq!(mock.take_journal(), [Access::Write(Register::Control, 0)]);
}

#[test]
fn a_fence_is_waited_for_and_its_interrupt_cleared_before_each_look() {
    let (mock, mut renderer) = started(Behaviour { words_per_microsecond: 1, ..Behaviour::default() });
    let first = renderer.fence().expect("there is room");
    let second = renderer.fence().expect("there is room");
    assert_ne!(first, second);
    mock.take_journal();
    renderer.wait_fence(second).expect("it drains");
    let status = 1024 - 4;
    let clear = Access::Write(Register::Interrupts, Interrupts::default().with_fence(true).0);
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
