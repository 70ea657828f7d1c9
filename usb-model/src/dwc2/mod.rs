//! The DWC2 core in host mode with buffer DMA, as strict as the documents let it be.
//!
//! It has the interface that software and a simulator see: 32-bit registers at offsets, an interrupt line, DMA.
//! Time is microseconds since power-on and passes only in [`Core::advance`]; DMA and traffic happen there and nowhere else.
//! What software does against a [`Rule`](crate::violation::Rule) is written down in the [`Log`], and the core goes on as the hardware might.
//!
//! Not modelled: device mode, slave mode, descriptor DMA, isochronous endpoints, suspend, and what does not matter to a
//! driver's rules: exact bit timing, bit stuffing, CRCs.

mod access;
mod build;
mod bus;
mod channel;
mod checks;
mod control;
mod port;
mod registers;
mod snoop;
mod splits;
mod start_checks;

pub use build::{Build, Defects};
pub(crate) use bus::{SPILL_BYTES, duration as slow_duration};

use crate::memory::DmaBus;
use crate::violation::{Log, Rule};
use crate::wire::Device;
use channel::Channel;
use port::Port;
use snoop::Snoop;
use splits::SplitWatch;

/// A device that a core can hold.
pub type Plug = Box<dyn Device + Send>;

/// What a soft reset leaves.
#[derive(Debug, Clone, Copy, Default)]
struct Registers {
    otg: u32,
    master: u32,
    phy: u32,
    mask: u32,
    fifos: [u32; 3],
    host: u32,
    interval: u32,
    channel_mask: u32,
    power: u32,
}

/// Things that take time.
#[derive(Debug, Clone, Copy, Default)]
struct Timers {
    /// The soft reset ends.
    reset_end: Option<u64>,
    /// The bus master is idle again.
    idle_from: u64,
    /// The core is a host.
    host_from: Option<u64>,
    /// A flush ends; its bits.
    flush_end: Option<(u64, u32)>,
    /// Since when the interrupt line is up, and whether that was written down.
    line_since: Option<(u64, bool)>,
}

/// The core.
pub struct Core {
    build: Build,
    log: Log,
    now: u64,
    /// What is wrong with it; may change at any moment.
    pub defects: Defects,
    registers: Registers,
    timers: Timers,
    /// All FIFOs were flushed since their sizes changed: transmit, receive.
    flushed: (bool, bool),
    /// The PHY's choice when the core was last reset.
    phy_at_reset: Option<u32>,
    /// Start of frame that software has acknowledged.
    frame_seen: u64,
    /// The frame that HFNUM showed last.
    frame_read: u64,
    disconnected: bool,
    port: Port,
    device: Option<Plug>,
    channels: Vec<Channel>,
    /// Channels have started or ended since the memory was told.
    unsettled: bool,
    starts: u64,
    /// The wire is free from then on.
    wire_free: u64,
    snoop: Snoop,
    splits: SplitWatch,
    transactions: u64,
}

impl Core {
    /// A core after power-on, nothing plugged in.
    pub fn new(build: Build, log: Log) -> Self {
        let mut core = Self {
            build,
            log,
            now: 0,
            defects: Defects::default(),
            registers: Registers { phy: build.phy, fifos: build.fifos, ..Registers::default() },
            timers: Timers::default(),
            flushed: (false, false),
            phy_at_reset: None,
            frame_seen: 0,
            frame_read: 0,
            disconnected: false,
            port: Port::default(),
            device: None,
            channels: vec![Channel::default(); build.channels()],
            unsettled: false,
            starts: 0,
            wire_free: 0,
            snoop: Snoop::default(),
            splits: SplitWatch::default(),
            transactions: 0,
        };
        core.choose_role();
        core
    }

    /// Microseconds since power-on.
    pub fn now(&self) -> u64 {
        self.now
    }

    /// Transactions that went over the wire so far.
    pub fn transactions(&self) -> u64 {
        self.transactions
    }

    /// The interrupt line.
    pub fn irq(&self) -> bool {
        self.registers.master & registers::GAHBCFG_GLOBAL != 0 && self.unmasked_interrupt()
    }

    /// Lets time pass until `until`, with all that happens in it. Stops early, and returns false, when the interrupt
    /// line rises.
    pub fn advance(&mut self, until: u64, memory: &mut dyn DmaBus) -> bool {
        let was_up = self.watch_line();
        self.settle(memory);
        while let Some(event) = self.next_event().filter(|event| *event <= until) {
            self.now = self.now.max(event);
            self.happen(memory);
            self.settle(memory);
            if self.watch_line() && !was_up {
                return false;
            }
        }
        self.now = self.now.max(until);
        self.watch_line();
        true
    }

    /// Tells the memory which buffers the core owns now. [`Core::advance`] does so too; whoever wants ownership to begin with
    /// the very write that starts a channel calls this after each write.
    pub fn settle(&mut self, memory: &mut dyn DmaBus) {
        if !std::mem::take(&mut self.unsettled) {
            return;
        }
        for (index, channel) in self.channels.iter_mut().enumerate() {
            match (channel.run.is_some(), channel.lent) {
                (true, false) => {
                    let program = channel.program();
                    memory.lend(index, program.address, program.bytes, program.input);
                }
                (false, true) => memory.give_back(index),
                _ => continue,
            }
            channel.lent = !channel.lent;
        }
    }

    /// When something happens next; nothing does before.
    pub fn next_event(&self) -> Option<u64> {
        let timers = [
            self.timers.reset_end,
            self.timers.host_from.filter(|at| *at > self.now),
            self.timers.flush_end.map(|(at, _)| at),
            self.port.next_event(),
            self.next_frame_interrupt(),
        ];
        let channels = self.channels.iter().filter_map(|channel| channel.run?.at);
        timers.into_iter().flatten().chain(channels).min()
    }

    fn happen(&mut self, memory: &mut dyn DmaBus) {
        if self.timers.reset_end.is_some_and(|at| at <= self.now) {
            self.timers.reset_end = None;
            self.timers.idle_from = self.now + 2;
        }
        if self.timers.flush_end.is_some_and(|(at, _)| at <= self.now) {
            self.timers.flush_end = None;
        }
        self.port_events();
        self.traffic(memory);
    }

    fn is_host(&self) -> bool {
        !self.defects.never_host && self.timers.host_from.is_some_and(|from| from <= self.now)
    }

    /// When the core becomes a host, by force or by its ID pin.
    fn choose_role(&mut self) {
        let forced = self.registers.phy & registers::GUSBCFG_FORCE_HOST != 0;
        let (by_force, by_pin) = (forced.then_some(FORCE_US), self.build.id_debounce_us);
        if !self.is_host() || !(forced || by_pin.is_some()) {
            self.timers.host_from = by_force.or(by_pin).map(|wait| self.now + wait);
        }
    }

    fn blame(&self, rule: Rule, detail: impl Into<String>) {
        self.log.add(self.now, rule, detail);
    }

    /// Says whether the interrupt line is up, and writes down an interrupt that nobody answers.
    fn watch_line(&mut self) -> bool {
        if !self.irq() {
            self.timers.line_since = None;
            return false;
        }
        let (since, told) = self.timers.line_since.unwrap_or((self.now, false));
        let late = self.now - since > ANSWER_US;
        if late && !told {
            self.blame(
                Rule::InterruptIgnored,
                format!("GINTSTS {:#010x} for {} us", self.interrupts(), self.now - since),
            );
        }
        self.timers.line_since = Some((since, told || late));
        true
    }
}

/// What the core needs to change its role: Linux, `dwc2_force_mode`.
const FORCE_US: u64 = 25_000;
/// How long a soft reset, and a flush, take here.
const RESET_US: u64 = 5;
const FLUSH_US: u64 = 2;
/// How long an interrupt may stay unanswered.
const ANSWER_US: u64 = 10_000;
