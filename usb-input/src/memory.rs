//! What the bus remembers, and what everything on it shares: the time, the events.

use core::cell::{Cell, RefCell};
use core::pin::Pin;
use core::task::{Context, Poll};

use heapless::Deque;

use crate::mailbox::Mailbox;
use crate::slots::{DEVICES_MAXIMUM, SlotIndex, Slots};
use crate::stack::Stack;
use crate::timing::{Moment, Wait};
use crate::{Config, Event, Fault, Place};

/// Events that can wait.
const QUEUE_LENGTH: usize = 16;
/// Events that may come of one occurrence.
const EVENTS_AT_ONCE: usize = 2;

/// All that the bus keeps, but for its future. Goes where the bus lives: a stack that stays, or a static.
#[derive(Debug)]
pub struct Memory {
    pub(crate) config: Config,
    pub(crate) slots: Slots,
    pub(crate) frozen: Cell<bool>,
    pub(crate) stack: RefCell<Stack>,
    mailboxes: [Mailbox; DEVICES_MAXIMUM],
    events: RefCell<Deque<Event, QUEUE_LENGTH>>,
    /// The time of this poll.
    now: Cell<Moment>,
    now_us: Cell<u64>,
    /// How far the earliest end of a wait is away that this poll met.
    nearest: Cell<u32>,
}

/// Nothing is waited for.
const NEVER: u32 = u32::MAX;

impl Memory {
    /// Returns memory of a bus with nothing on it.
    #[must_use]
    pub const fn new(config: Config) -> Self {
        Self {
            config,
            slots: Slots::new(),
            frozen: Cell::new(false),
            stack: RefCell::new(Stack::new()),
            mailboxes: [const { Mailbox::new() }; DEVICES_MAXIMUM],
            events: RefCell::new(Deque::new()),
            now: Cell::new(Moment::from_us(0)),
            now_us: Cell::new(0),
            nearest: Cell::new(NEVER),
        }
    }

    /// Begins a poll.
    pub(crate) fn begin_poll(&self, now_us: u64) {
        self.now_us.set(now_us);
        self.now.set(Moment::from_us(now_us));
        self.nearest.set(NEVER);
    }

    /// Returns when a wait will be over that begins now.
    pub(crate) fn after(&self, wait: Wait) -> Moment {
        self.now.get().after(wait)
    }

    /// Returns when the earliest of the waits ends that the last poll met.
    pub(crate) fn next_wait_us(&self) -> Option<u64> {
        let nearest = self.nearest.get();
        (nearest != NEVER).then(|| Moment::to_us(nearest, self.now_us.get()))
    }

    /// Says that there is more to do at once.
    pub(crate) fn hurry(&self) {
        self.nearest.set(0);
    }

    pub(crate) fn mailbox(&self, slot: SlotIndex) -> &Mailbox {
        &self.mailboxes[slot.index()]
    }

    /// Tells whether anything has changed for somebody since it was asked last.
    pub(crate) fn take_stirred(&self) -> bool {
        let mailboxes = self.mailboxes.iter().fold(false, |stirred, mailbox| stirred | mailbox.take_stirred());
        self.slots.take_stirred() | mailboxes
    }

    /// Tells whether a moment has come; else notes that somebody waits for it.
    #[inline(never)]
    pub(crate) fn has_come(&self, moment: Moment) -> bool {
        let away = moment.away_from(self.now.get());
        if let Some(away) = away {
            self.nearest.set(self.nearest.get().min(away));
        }
        away.is_none()
    }

    /// Waits for a while.
    pub(crate) fn sleep(&self, wait: Wait) -> Sleep<'_> {
        Sleep { memory: self, until: self.after(wait) }
    }

    /// Tells whether there is room for what may come of one occurrence.
    pub(crate) fn has_room(&self) -> bool {
        self.events.borrow().len() <= QUEUE_LENGTH - EVENTS_AT_ONCE
    }

    /// Tells an event, after [`has_room`](Self::has_room).
    #[inline(never)]
    pub(crate) fn tell(&self, event: Event) {
        let full = self.events.borrow_mut().push_back(event).is_err();
        debug_assert!(!full, "an event without room");
    }

    /// Tells a fault, likewise.
    pub(crate) fn tell_fault(&self, device: Place, fault: Fault) {
        self.tell(Event::Fault { device, fault });
    }

    /// Takes the oldest event.
    pub(crate) fn take_event(&self) -> Option<Event> {
        self.events.borrow_mut().pop_front()
    }
}

/// A wait.
pub(crate) struct Sleep<'m> {
    memory: &'m Memory,
    until: Moment,
}

impl Future for Sleep<'_> {
    type Output = ();

    fn poll(self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<()> {
        if self.memory.has_come(self.until) { Poll::Ready(()) } else { Poll::Pending }
    }
}
