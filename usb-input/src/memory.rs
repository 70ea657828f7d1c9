//! What the bus remembers.

use core::cell::{Cell, RefCell};

use heapless::Deque;

use crate::slots::Slots;
use crate::{Config, Event};

/// Events that can wait.
const QUEUE_LENGTH: usize = 16;

/// All that the bus keeps, but for its future. Goes where the bus lives: a stack that stays, or a static.
#[derive(Debug)]
pub struct Memory {
    pub(crate) config: Config,
    pub(crate) events: RefCell<Deque<Event, QUEUE_LENGTH>>,
    pub(crate) slots: Slots,
    pub(crate) frozen: Cell<bool>,
    /// Counts polls, so that none does too much.
    pub(crate) round: Cell<u32>,
    /// The earliest end of a wait that the last poll met.
    pub(crate) next_wait_us: Cell<Option<u64>>,
}

impl Memory {
    /// Returns memory of a bus with nothing on it.
    #[must_use]
    pub const fn new(config: Config) -> Self {
        Self {
            config,
            events: RefCell::new(Deque::new()),
            slots: Slots::new(),
            frozen: Cell::new(false),
            round: Cell::new(0),
            next_wait_us: Cell::new(None),
        }
    }

    /// Begins a poll.
    pub(crate) fn begin_round(&self) {
        self.round.set(self.round.get().wrapping_add(1));
        self.next_wait_us.set(None);
    }

    /// Notes that somebody waits until a time.
    pub(crate) fn note_wait(&self, until_us: u64) {
        let earliest = self.next_wait_us.get().map_or(until_us, |other| other.min(until_us));
        self.next_wait_us.set(Some(earliest));
    }
}
