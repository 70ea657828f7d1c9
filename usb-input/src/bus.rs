//! What everything that runs on the bus shares: the controller's pipes, the time, the events.

use core::future::{Future, poll_fn};
use core::task::Poll;

use embassy_futures::select::{Either, select};

use crate::{Clock, Event, Fault, Memory, Place};

/// What everything that runs on the bus shares.
pub(crate) struct Bus<'b, A, K> {
    pub(crate) allocator: A,
    pub(crate) clock: K,
    pub(crate) memory: &'b Memory,
}

impl<A, K: Clock> Bus<'_, A, K> {
    pub(crate) fn now_us(&self) -> u64 {
        self.clock.now_us()
    }

    /// Tells whether a time has come; else notes that somebody waits for it.
    pub(crate) fn has_come(&self, time_us: u64) -> bool {
        let come = self.now_us() >= time_us;
        if !come {
            self.memory.note_wait(time_us);
        }
        come
    }

    /// Waits until a time has come.
    pub(crate) async fn until(&self, time_us: u64) {
        poll_fn(|_| if self.has_come(time_us) { Poll::Ready(()) } else { Poll::Pending }).await;
    }

    /// Waits for a while.
    pub(crate) async fn sleep(&self, duration_us: u64) {
        self.until(self.now_us() + duration_us).await;
    }

    /// Waits for something, but no longer than a while; `None` when it is over, and the future is dropped.
    pub(crate) async fn within<F: Future>(&self, duration_us: u64, future: F) -> Option<F::Output> {
        match select(future, self.sleep(duration_us)).await {
            Either::First(output) => Some(output),
            Either::Second(()) => None,
        }
    }

    /// Tells an event, as soon as there is room.
    pub(crate) async fn tell(&self, event: Event) {
        let mut waiting = Some(event);
        poll_fn(|_| {
            let mut events = self.memory.events.borrow_mut();
            waiting = waiting.take().and_then(|event| events.push_back(event).err());
            if waiting.is_none() { Poll::Ready(()) } else { Poll::Pending }
        })
        .await;
    }

    /// Tells a fault.
    pub(crate) async fn tell_fault(&self, device: Place, fault: Fault) {
        self.tell(Event::Fault { device, fault }).await;
    }
}
