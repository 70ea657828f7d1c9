//! A board for the driver: the model's core and memory, an interrupt line, a clock, and an executor that polls a
//! future only when it was woken.

mod machine;

use std::cell::Cell;
use std::future::Future;
use std::pin::Pin;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll, Wake, Waker};

use dwc2_host::{Config, Dwc2, Fault};
use usb_model::dwc2::{Build, Core};
use usb_model::random::Random;
use usb_model::violation::{Log, Rule};
use usb_model::wire::Device;

pub use machine::{Cost, Machine, Skip};
use machine::{Pace, TestBoard, lock};

struct Flag(AtomicBool);

impl Wake for Flag {
    fn wake(self: Arc<Self>) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Who sleeps, and until when.
type Sleepers = Arc<Mutex<Vec<(u64, Waker)>>>;

/// A driver on its board. Fails the test, when it goes, for every rule that was broken and not asked for.
pub struct Rig {
    pub driver: &'static Dwc2<'static>,
    machine: Arc<Mutex<Machine>>,
    log: Log,
    sleepers: Sleepers,
    next_poll: Cell<u64>,
    /// The interrupt line is connected.
    pub interrupts: Cell<bool>,
    /// Microseconds from an interrupt to its handler.
    pub latency: Cell<u64>,
}

impl Rig {
    /// The DE1-SoC's core.
    pub fn new(config: Config) -> Self {
        Self::on(Build::cyclone_v(), config)
    }

    pub fn on(build: Build, config: Config) -> Self {
        let log = Log::default();
        let machine = Arc::new(Mutex::new(Machine::new(build, &log)));
        let board = Box::leak(Box::new(TestBoard(Arc::clone(&machine))));
        let driver = Box::leak(Box::new(Dwc2::new(board, config)));
        let sleepers = Sleepers::default();
        let (interrupts, latency) = (Cell::new(true), Cell::new(2));
        Self { driver, machine, log, sleepers, next_poll: Cell::new(0), interrupts, latency }
    }

    /// The core and its memory; do not hold them over an `await` or a step.
    pub fn machine(&self) -> MutexGuard<'_, Machine> {
        lock(&self.machine)
    }

    /// The board resets the core; time goes on.
    pub fn replace_core(&self, build: Build) {
        let now = self.now();
        let mut machine = self.machine();
        machine.core = Core::new(build, self.log.clone());
        machine.advance(now);
    }

    pub fn plug(&self, device: impl Device + Send + 'static) {
        self.machine().core.plug(Box::new(device));
    }

    pub fn unplug(&self) {
        drop(self.machine().core.unplug());
    }

    pub fn now(&self) -> u64 {
        self.machine().core.now()
    }

    /// Changes every write that the driver makes from now on.
    pub fn tamper_writes(&self, write: impl FnMut(&mut Machine, u32, u32) -> Option<u32> + Send + 'static) {
        self.machine().tamper.write = Some(Box::new(write));
    }

    /// Changes every read that the driver makes from now on.
    pub fn tamper_reads(&self, read: impl FnMut(&mut Machine, u32, u32) -> u32 + Send + 'static) {
        self.machine().tamper.read = Some(Box::new(read));
    }

    /// Rules broken so far, each once; they are forgiven.
    pub fn take_rules(&self) -> Vec<Rule> {
        let mut rules: Vec<Rule> = self.log.take().into_iter().map(|violation| violation.rule).collect();
        rules.sort_unstable();
        rules.dedup();
        rules
    }

    /// What was broken so far, in words, or the first of it; it is forgiven.
    pub fn take_violations(&self) -> Vec<String> {
        self.log.take().iter().take(12).map(ToString::to_string).collect()
    }

    /// Time until the next interrupt or poll, and the driver's answer to it.
    pub fn step(&self) {
        let next = self.next_poll.get();
        let line = |machine: &Machine| self.interrupts.get() && machine.core.irq();
        let up = {
            let mut machine = self.machine();
            if !line(&machine) {
                machine.advance(next);
            }
            let up = line(&machine);
            if up {
                let latency = machine.latency().unwrap_or(self.latency.get());
                let handled = machine.core.now() + latency;
                machine.advance(handled);
            }
            up
        };
        if up {
            self.call(Dwc2::on_interrupt);
        }
        if self.now() >= next {
            self.call(Dwc2::poll);
            self.next_poll.set(next + (self.now() - next) / 1_000 * 1_000 + 1_000);
            let now = self.now();
            let mut sleepers = self.sleepers.lock().unwrap_or_else(PoisonError::into_inner);
            sleepers.retain(|(until, waker)| {
                if *until <= now {
                    waker.wake_by_ref();
                }
                *until > now
            });
        }
    }

    /// Lets time pass until the driver was polled.
    pub fn tick(&self) {
        let next = self.next_poll.get();
        while self.next_poll.get() == next {
            self.step();
        }
    }

    /// Lets time pass up to a moment before the driver's next poll.
    pub fn pass_until(&self, moment: u64) {
        while self.now() < moment {
            let mut machine = self.machine();
            machine.advance(moment);
            let up = self.interrupts.get() && machine.core.irq();
            drop(machine);
            if up {
                self.call(Dwc2::on_interrupt);
            }
        }
    }

    fn call(&self, service: fn(&Dwc2<'static>)) {
        let before = self.machine().cost.frame_reads;
        service(self.driver);
        let cost = &mut self.machine().cost;
        cost.services += 1;
        cost.frame_reads_most = cost.frame_reads_most.max(cost.frame_reads - before);
    }

    /// Lets time pass between two accesses, and up to `latency` microseconds before an interrupt is answered.
    pub fn take_time(&self, seed: u64, latency: usize) {
        self.machine().pace = Some(Pace { random: Random(seed), latency });
    }

    /// Lets the polls come so much later from now on.
    pub fn delay_polls(&self, us: u64) {
        self.next_poll.set(self.next_poll.get() + us);
    }

    /// Lets this many microseconds pass.
    pub fn pass(&self, us: u64) {
        let end = self.now() + us;
        while self.now() < end {
            self.step();
        }
    }

    /// Runs a future to its end, at most `limit_us` microseconds.
    pub fn run_for<F: Future>(&self, limit_us: u64, future: F) -> Option<F::Output> {
        let mut future = Box::pin(future);
        let flag = Arc::new(Flag(AtomicBool::new(true)));
        let waker = Waker::from(Arc::clone(&flag));
        let end = self.now() + limit_us;
        loop {
            if flag.0.swap(false, Ordering::Relaxed)
                && let Poll::Ready(output) = future.as_mut().poll(&mut Context::from_waker(&waker))
            {
                return Some(output);
            }
            if self.now() >= end {
                return None;
            }
            self.step();
        }
    }

    /// Runs a future to its end; ten seconds without one fail the test.
    pub fn run<F: Future>(&self, future: F) -> F::Output {
        self.run_for(10_000_000, future).unwrap_or_else(|| {
            let fault = self.driver.take_fault();
            panic!("no end after 10 s; fault {fault:?}; broken: {:?}", self.log.take())
        })
    }

    pub async fn sleep(&self, us: u64) {
        let until = self.now() + us;
        std::future::poll_fn(|context| {
            if self.now() >= until {
                return Poll::Ready(());
            }
            self.sleepers.lock().unwrap_or_else(PoisonError::into_inner).push((until, context.waker().clone()));
            Poll::Pending
        })
        .await;
    }

    /// The fault that the driver names within this time.
    pub fn fault_within(&self, us: u64) -> Option<Fault> {
        let end = self.now() + us;
        loop {
            if let Some(fault) = self.driver.take_fault() {
                return Some(fault);
            }
            if self.now() >= end {
                return None;
            }
            self.step();
        }
    }
}

impl Drop for Rig {
    fn drop(&mut self) {
        let broken = self.log.take();
        if !std::thread::panicking() && !broken.is_empty() {
            let lines: Vec<String> = broken.iter().take(12).map(ToString::to_string).collect();
            panic!("{} rules broken:\n{}", broken.len(), lines.join("\n"));
        }
    }
}

/// Runs two futures side by side.
pub async fn both<A: Future, B: Future>(a: A, b: B) -> (A::Output, B::Output) {
    let (mut a, mut b) = (Box::pin(a), Box::pin(b));
    let (mut done_a, mut done_b) = (None, None);
    std::future::poll_fn(move |context| {
        advance(&mut done_a, &mut a, context);
        advance(&mut done_b, &mut b, context);
        match (done_a.take(), done_b.take()) {
            (Some(a), Some(b)) => Poll::Ready((a, b)),
            (a, b) => {
                (done_a, done_b) = (a, b);
                Poll::Pending
            }
        }
    })
    .await
}

fn advance<F: Future>(done: &mut Option<F::Output>, future: &mut Pin<Box<F>>, context: &mut Context<'_>) {
    if done.is_none()
        && let Poll::Ready(output) = future.as_mut().poll(context)
    {
        *done = Some(output);
    }
}
