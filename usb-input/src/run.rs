//! The bus as a whole.

use core::convert::Infallible;
use core::future::{Future, poll_fn};
use core::pin::pin;
use core::task::Poll;

use embassy_futures::select::{select, select_array};
use embassy_usb_driver::host::UsbHostController;

use crate::root::Root;
use crate::slots::{DEVICES_MAXIMUM, SlotIndex};
use crate::{Clock, Memory, carrier};

/// How often one poll goes round everybody, at most: for an answer, and for what follows it.
const ROUNDS: u32 = 4;

/// Runs a bus: finds what is plugged into the controller's root port and below, and reads it, for ever.
///
/// Poll it through [`UsbInput`](crate::UsbInput).
///
/// What is asked of the controller beyond its traits' own words: if the future of
/// [`wait_for_device_event`](UsbHostController::wait_for_device_event) is dropped, the next one tells what it
/// would have told.
pub async fn run<'d, C: UsbHostController<'d>>(controller: C, clock: impl Clock, memory: &Memory) -> Infallible {
    let allocator = &controller.allocator();
    let root = Root::default();
    let slots =
        core::array::from_fn::<_, DEVICES_MAXIMUM, _>(|index| carrier::slot(memory, allocator, SlotIndex::new(index)));
    // None of them ever ends.
    let mut carriers = pin!(select(carrier::root_port(&root, controller), select_array(slots)));
    poll_fn(|context| {
        memory.begin_poll(clock.now_us());
        for _ in 0..ROUNDS {
            memory.stack.borrow_mut().poll(memory, &root);
            let _ = carriers.as_mut().poll(context);
            if !(memory.take_stirred() | root.take_stirred()) {
                return Poll::Pending;
            }
        }
        // There is more to do at once, but not in this poll.
        memory.hurry();
        Poll::Pending
    })
    .await
}
