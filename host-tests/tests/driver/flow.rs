//! Flow control: when STATUS is read, and when the driver waits for space.

use fpga_regs::Wait;
use fpga_regs::registers::Interrupts;
use host_tests::rng::Rng;

use super::*;

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
    let clear = Access::Write(Register::Interrupts, EVERY_INTERRUPT);
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
            fifo_depth: rng.pick(&[34, 35, 43, 64, 100, 1024]),
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

    let mock = Mock::new(Behaviour { fifo_depth: 34, words_per_microsecond: 1, ..Behaviour::default() });
    let mut renderer = Renderer::new(Draining(mock.clone()), Interrupted(mock.clone()), Timeouts::default())
        .expect("the device starts");
    // From 34 words down to 18: one above the mark of 17.
    renderer.push(&fences(17)).expect("it fits");
    mock.clone().wait(16);
    mock.take_journal();
    renderer.push(&fences(9)).expect("it drains");
    let waited = waited_us(&mock.take_journal());
    assert!(waited <= 45, "waited {waited} µs for 18 words that leave at one a microsecond");
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
        let mock = Mock::new(Behaviour { fifo_depth: 34, words_per_microsecond: 0, ..Behaviour::default() });
        let wait = Trickling { mock: mock.clone(), period_us, waited_us: 0 };
        let mut renderer = Renderer::new(mock.clone(), wait, Timeouts::default()).expect("the device starts");
        let words = fences(24);
        let result = renderer.push(&words);
        assert_eq!(result.is_ok(), patient, "a word every {period_us} µs: {result:?}");
        assert_eq!(mock.stream() == words, patient);
    }
}
