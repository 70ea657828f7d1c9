//! A board for the driver: the model's core and memory, an interrupt line, a clock, and an executor that polls a
//! future only when it was woken.

use std::cell::Cell;
use std::future::Future;
use std::pin::Pin;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll, Wake, Waker};

use dwc2_host::{Clock, Config, DMA_BYTES, DmaMemory, Dwc2, Fault, Registers};
use usb_model::dwc2::{Build, Core};
use usb_model::memory::CachedMemory;
use usb_model::random::Random;
use usb_model::violation::{Log, Rule};
use usb_model::wire::Device;

/// The register that tells the (micro)frame.
const HFNUM: u32 = 0x408;
/// Where the DMA memory lies on the bus.
const BASE: u32 = 0x3000_0000;

/// Changes a register write on its way, or drops it (`None`), or does something else besides.
pub type WriteTamper = Box<dyn FnMut(&mut Machine, u32, u32) -> Option<u32> + Send>;
/// Changes what a register read says.
pub type ReadTamper = Box<dyn FnMut(&mut Machine, u32, u32) -> u32 + Send>;

/// Which calls of `invalidate` never reach the caches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Skip {
    #[default]
    None,
    /// All.
    All,
    /// Those after the core wrote.
    After,
}

/// What a broken driver would do, done between a right one and the model.
#[derive(Default)]
pub struct Tamper {
    write: Option<WriteTamper>,
    read: Option<ReadTamper>,
    pub skip_clean: bool,
    pub skip_invalidate: Skip,
    /// The driver's clock runs that many times too fast, less one: its waits are too short.
    pub haste: u64,
}

/// What the driver has cost so far.
#[derive(Debug, Default, Clone, Copy)]
pub struct Cost {
    /// Calls: interrupts and polls.
    pub services: u64,
    pub reads: u64,
    pub writes: u64,
    /// Reads of HFNUM, of all reads.
    pub frame_reads: u64,
    /// The most of them in one call.
    pub frame_reads_most: u64,
}

/// A processor that takes its time: microseconds pass between its accesses, and before it answers an interrupt.
struct Pace {
    random: Random,
    /// An interrupt is answered sooner than this, in microseconds.
    latency: usize,
}

/// The core, its memory, and what is done to the accesses.
pub struct Machine {
    pub core: Core,
    pub memory: CachedMemory,
    pub tamper: Tamper,
    pub cost: Cost,
    pace: Option<Pace>,
}

impl Machine {
    fn write(&mut self, offset: u32, value: u32) {
        self.core.write(offset, value);
        self.core.settle(&mut self.memory);
    }

    fn advance(&mut self, until: u64) {
        self.core.advance(until, &mut self.memory);
        self.memory.set_now(self.core.now());
    }

    /// What an access takes: a microsecond for two to four of them.
    fn take_time(&mut self) {
        let Some(pace) = &mut self.pace else { return };
        if pace.random.once_in(3) {
            let until = self.core.now() + 1;
            while self.core.now() < until {
                self.advance(until);
            }
        }
    }

    /// What an interrupt takes to be answered, if that is not the same every time.
    fn latency(&mut self) -> Option<u64> {
        self.pace.as_mut().map(|pace| pace.random.below(pace.latency) as u64)
    }
}

struct TestBoard(Arc<Mutex<Machine>>);

fn lock(machine: &Mutex<Machine>) -> MutexGuard<'_, Machine> {
    machine.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Registers for TestBoard {
    fn read_register(&mut self, offset: u32) -> u32 {
        let mut machine = lock(&self.0);
        machine.take_time();
        machine.cost.reads += 1;
        machine.cost.frame_reads += u64::from(offset == HFNUM);
        let value = machine.core.read(offset);
        let Some(mut tamper) = machine.tamper.read.take() else { return value };
        let value = tamper(&mut machine, offset, value);
        machine.tamper.read = Some(tamper);
        value
    }

    fn write_register(&mut self, offset: u32, value: u32) {
        let mut machine = lock(&self.0);
        machine.take_time();
        machine.cost.writes += 1;
        let Some(mut tamper) = machine.tamper.write.take() else { return machine.write(offset, value) };
        if let Some(value) = tamper(&mut machine, offset, value) {
            machine.write(offset, value);
        }
        machine.tamper.write = Some(tamper);
    }
}

impl DmaMemory for TestBoard {
    fn length(&self) -> usize {
        lock(&self.0).memory.length()
    }

    fn bus_address(&self) -> u32 {
        lock(&self.0).memory.base()
    }

    fn copy_in(&mut self, offset: usize, bytes: &[u8]) {
        lock(&self.0).memory.cpu_write(offset, bytes);
    }

    fn copy_out(&mut self, offset: usize, bytes: &mut [u8]) {
        lock(&self.0).memory.cpu_read(offset, bytes);
    }

    fn clean(&mut self, offset: usize, length: usize) {
        let mut machine = lock(&self.0);
        if !machine.tamper.skip_clean {
            machine.memory.clean(offset, length);
        }
    }

    fn invalidate(&mut self, offset: usize, length: usize) {
        let mut machine = lock(&self.0);
        let skip = match machine.tamper.skip_invalidate {
            Skip::None => false,
            Skip::All => true,
            Skip::After => machine.memory.is_stale(offset, length),
        };
        if !skip {
            machine.memory.invalidate(offset, length);
        }
    }
}

impl Clock for TestBoard {
    fn now_us(&self) -> u64 {
        let machine = lock(&self.0);
        machine.core.now() * (machine.tamper.haste + 1)
    }
}

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
        let core = Core::new(build, log.clone());
        let memory = CachedMemory::new(BASE, DMA_BYTES, log.clone());
        let machine = Arc::new(Mutex::new(Machine {
            core,
            memory,
            tamper: Tamper::default(),
            cost: Cost::default(),
            pace: None,
        }));
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
