//! What the bus remembers.

use core::cell::{Cell, RefCell};

use heapless::Deque;

use crate::{Config, Event};

/// Events that can wait.
const QUEUE_LENGTH: usize = 16;

/// All that the bus keeps, but for its future. Goes where the bus lives: a stack that stays, or a static.
#[derive(Debug)]
pub struct Memory {
    pub(crate) config: Config,
    pub(crate) events: RefCell<Deque<Event, QUEUE_LENGTH>>,
    pub(crate) frozen: Cell<bool>,
}

impl Memory {
    /// Returns memory of a bus with nothing on it.
    #[must_use]
    pub const fn new(config: Config) -> Self {
        Self { config, events: RefCell::new(Deque::new()), frozen: Cell::new(false) }
    }
}
