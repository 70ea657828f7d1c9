//! The root port.

use core::cell::Cell;
use core::future::poll_fn;
use core::task::Poll;

use embassy_usb_driver::Speed;
use embassy_usb_driver::host::DeviceEvent;

use crate::route::Route;
use crate::slots::SlotIndex;
use crate::timing::{ATTEMPTS, Moment, Wait};
use crate::{Fault, Memory, Place};

/// What goes between the root port's logic and the controller.
#[derive(Debug, Default)]
pub(crate) struct Root {
    event: Cell<Option<DeviceEvent>>,
    reset_wanted: Cell<bool>,
    state: Cell<State>,
    /// The controller has told something.
    stirred: Cell<bool>,
}

/// What is at the root port.
#[derive(Debug, Clone, Copy, Default)]
enum State {
    #[default]
    Empty,
    /// A device that was reset waits for its slot.
    Reset(Course),
    Busy(SlotIndex, Course),
    /// A device that failed is to be reset at a time.
    Failed {
        retry: Moment,
        course: Course,
    },
    /// It is being reset.
    Resetting(Course),
}

/// What is remembered of the root port's device from one attempt to the next.
#[derive(Debug, Clone, Copy)]
struct Course {
    speed: Speed,
    attempts: u8,
}

impl Root {
    /// Hands an event over, and waits until it was taken.
    pub(crate) async fn put_event(&self, event: DeviceEvent) {
        self.event.set(Some(event));
        self.stirred.set(true);
        poll_fn(|_| if self.event.get().is_none() { Poll::Ready(()) } else { Poll::Pending }).await;
    }

    pub(crate) async fn reset_wanted(&self) {
        poll_fn(|_| if self.reset_wanted.take() { Poll::Ready(()) } else { Poll::Pending }).await;
    }

    pub(crate) fn reset_done(&self) {
        if let State::Resetting(course) = self.state.get() {
            self.state.set(State::Reset(course));
        }
        self.stirred.set(true);
    }

    /// Tells whether the controller has told something since it was asked last.
    pub(crate) fn take_stirred(&self) -> bool {
        self.stirred.take()
    }

    /// Goes on a step if there is one to go.
    pub(crate) fn poll(&self, memory: &Memory) {
        if !memory.has_room() {
            return;
        }
        if let Some(event) = self.event.take() {
            if let State::Busy(device, _) = self.state.get() {
                memory.slots.leave(device);
            }
            self.reset_wanted.set(false);
            self.state.set(match event {
                DeviceEvent::Connected(speed) => State::Reset(Course { speed, attempts: 0 }),
                _ => State::Empty,
            });
            if event == DeviceEvent::Overcurrent {
                memory.tell_fault(Place::ROOT, Fault::OverCurrent);
            }
        }
        match self.state.get() {
            State::Reset(course) => {
                if let Ok(device) = memory.slots.reserve(None, Place::ROOT) {
                    memory.slots.begin(device, Route::root(course.speed));
                    self.state.set(State::Busy(device, course));
                }
            }
            State::Busy(device, Course { speed, attempts }) if memory.slots.has_failed(device) => {
                memory.slots.leave(device);
                let attempts = (attempts + 1).min(ATTEMPTS);
                // A device on the board cannot be plugged in again: it is never given up.
                let pause = if attempts < ATTEMPTS { Wait::RETRY_PAUSE } else { Wait::ROOT_RETRY_PAUSE };
                let course = Course { speed, attempts };
                self.state.set(State::Failed { retry: memory.after(pause), course });
            }
            State::Failed { retry, course } if memory.has_come(retry) => {
                self.reset_wanted.set(true);
                self.state.set(State::Resetting(course));
            }
            _ => {}
        }
    }
}
