//! What the driver has under it: the model's core and memory, with what is done to the accesses on their way.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use dwc2_host::{Clock, DMA_BYTES, DmaMemory, Registers};
use usb_model::dwc2::{Build, Core};
use usb_model::memory::CachedMemory;
use usb_model::random::Random;
use usb_model::violation::Log;

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
    pub(super) write: Option<WriteTamper>,
    pub(super) read: Option<ReadTamper>,
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
pub(super) struct Pace {
    pub(super) random: Random,
    /// An interrupt is answered sooner than this, in microseconds.
    pub(super) latency: usize,
}

/// The core, its memory, and what is done to the accesses.
pub struct Machine {
    pub core: Core,
    pub memory: CachedMemory,
    pub tamper: Tamper,
    pub cost: Cost,
    pub(super) pace: Option<Pace>,
}

impl Machine {
    pub(super) fn new(build: Build, log: &Log) -> Self {
        let core = Core::new(build, log.clone());
        let memory = CachedMemory::new(BASE, DMA_BYTES, log.clone());
        Self { core, memory, tamper: Tamper::default(), cost: Cost::default(), pace: None }
    }

    pub(super) fn write(&mut self, offset: u32, value: u32) {
        self.core.write(offset, value);
        self.core.settle(&mut self.memory);
    }

    pub(super) fn advance(&mut self, until: u64) {
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
    pub(super) fn latency(&mut self) -> Option<u64> {
        self.pace.as_mut().map(|pace| pace.random.below(pace.latency) as u64)
    }
}

pub(super) struct TestBoard(pub(super) Arc<Mutex<Machine>>);

pub(super) fn lock(machine: &Mutex<Machine>) -> MutexGuard<'_, Machine> {
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
