//! The root port.

use core::cell::Cell;
use core::convert::Infallible;
use core::future::poll_fn;
use core::task::Poll;

use embassy_usb_driver::Speed;
use embassy_usb_driver::host::DeviceEvent;

use crate::route::Route;
use crate::slots::SlotIndex;
use crate::timing::{ATTEMPTS, RETRY_PAUSE_US, ROOT_RETRY_PAUSE_US};
use crate::{Fault, Memory, Place};

/// What goes between the root port's logic and the controller.
#[derive(Debug)]
pub(crate) struct RootPort {
    event: Cell<Option<DeviceEvent>>,
    reset: Cell<Reset>,
}

/// A reset of the root port's device.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Reset {
    No,
    Wanted,
    Done,
}

impl RootPort {
    pub(crate) const fn new() -> Self {
        Self { event: Cell::new(None), reset: Cell::new(Reset::No) }
    }

    pub(crate) async fn reset_wanted(&self) {
        poll_fn(|_| if self.reset.get() == Reset::Wanted { Poll::Ready(()) } else { Poll::Pending }).await;
    }

    pub(crate) fn reset_done(&self) {
        self.reset.set(Reset::Done);
    }

    pub(crate) fn put_event(&self, event: DeviceEvent) {
        self.event.set(Some(event));
    }

    pub(crate) async fn event_taken(&self) {
        poll_fn(|_| if self.event.get().is_none() { Poll::Ready(()) } else { Poll::Pending }).await;
    }
}

/// Serves the root port.
pub(crate) async fn serve(memory: &Memory) -> Infallible {
    let (root, slots) = (&memory.root, &memory.slots);
    let mut device: Option<SlotIndex> = None;
    let (mut speed, mut attempts) = (Speed::Full, 0);
    // When the device that failed is reset.
    let mut retry_us: Option<u64> = None;
    loop {
        let event = poll_fn(|_| {
            let event = root.event.take();
            if event.is_some() {
                return Poll::Ready(event);
            }
            let failed = device.is_some_and(|device| slots.has_failed(device));
            let due = retry_us.is_some_and(|retry_us| memory.has_come(retry_us));
            if failed || due || root.reset.get() == Reset::Done { Poll::Ready(None) } else { Poll::Pending }
        })
        .await;
        if let Some(device) = device.take() {
            slots.leave(device);
            if event.is_none() {
                attempts = (attempts + 1).min(ATTEMPTS);
                // A device on the board cannot be plugged in again: it is never given up.
                let pause_us = if attempts < ATTEMPTS { RETRY_PAUSE_US } else { ROOT_RETRY_PAUSE_US };
                retry_us = Some(memory.now_us() + pause_us);
                continue;
            }
        }
        let was_reset = root.reset.replace(Reset::No) == Reset::Done;
        let was_due = retry_us.take().is_some();
        match event {
            Some(DeviceEvent::Connected(now)) => (speed, attempts) = (now, 0),
            Some(DeviceEvent::Overcurrent) => {
                memory.tell_fault(Place::ROOT, Fault::OverCurrent).await;
                continue;
            }
            None if was_due => {
                root.reset.set(Reset::Wanted);
                continue;
            }
            None if was_reset => {}
            Some(_) | None => continue,
        }
        // As soon as the one before it has been let go.
        let reserve = || if slots.may_begin(Place::ROOT) { slots.reserve(None, Place::ROOT) } else { None };
        let begun = poll_fn(|_| reserve().map_or(Poll::Pending, Poll::Ready)).await;
        slots.begin(begun, Route::root(speed));
        device = Some(begun);
    }
}
