//! The bus, as a main loop sees it.

use core::convert::Infallible;
use core::future::Future;
use core::pin::Pin;
use core::task::{Context, Waker};

use crate::{Event, Memory};

/// The bus, polled: by a main loop, or by a timer's interrupt.
///
/// It needs no executor and never blocks. One [`poll`](Self::poll) completes at most one transfer for each
/// device; between two polls nothing happens but what the controller does by itself. A report waits
/// for the next poll, so poll once a millisecond where that matters.
pub struct UsbInput<'a> {
    bus: Pin<&'a mut (dyn Future<Output = Infallible> + 'a)>,
    memory: &'a Memory,
}

impl<'a> UsbInput<'a> {
    /// Takes the future that [`run`](crate::run) gave, pinned, and the memory that it was given.
    pub fn new(bus: Pin<&'a mut (dyn Future<Output = Infallible> + 'a)>, memory: &'a Memory) -> Self {
        Self { bus, memory }
    }

    /// Lets everything that can go on go on, a step.
    pub fn poll(&mut self) {
        let _ = self.bus.as_mut().poll(&mut Context::from_waker(Waker::noop()));
    }

    /// Takes the oldest event.
    pub fn next_event(&mut self) -> Option<Event> {
        self.memory.take_event()
    }

    /// Returns when the earliest of the waits ends that the last [`poll`](Self::poll) met, by the
    /// [`Clock`](crate::Clock); `None` if none does. A transfer may want a poll before that.
    #[must_use]
    pub fn next_wait_us(&self) -> Option<u64> {
        self.memory.next_wait_us()
    }

    /// Tells whether the pose is frozen, for [`Config::pulse_on_freeze`](crate::Config::pulse_on_freeze);
    /// as often as one likes.
    pub fn set_frozen(&mut self, frozen: bool) {
        self.memory.frozen.set(frozen);
    }
}
