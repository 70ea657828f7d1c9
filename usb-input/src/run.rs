//! The bus as a whole.

use core::convert::Infallible;
use core::future::{Future, poll_fn};
use core::pin::pin;

use embassy_futures::join::{join_array, join3};
use embassy_usb_driver::host::UsbHostController;

use crate::slots::{DEVICES_MAXIMUM, SlotIndex};
use crate::{Clock, Memory, carrier, root};

/// Runs a bus: finds what is plugged into the controller's root port and below, and reads it, for ever.
///
/// Poll it through [`UsbInput`](crate::UsbInput).
///
/// What is asked of the controller beyond its traits' own words: if the future of
/// [`wait_for_device_event`](UsbHostController::wait_for_device_event) is dropped, the next one tells what it
/// would have told.
pub async fn run<'d, C: UsbHostController<'d>>(controller: C, clock: impl Clock, memory: &Memory) -> Infallible {
    let allocator = &controller.allocator();
    let slots =
        core::array::from_fn::<_, DEVICES_MAXIMUM, _>(|index| carrier::slot(memory, allocator, SlotIndex::new(index)));
    let mut all = pin!(join3(carrier::root_port(memory, controller), root::serve(memory), join_array(slots)));
    poll_fn(|context| {
        memory.begin_poll(clock.now_us());
        all.as_mut().poll(context)
    })
    .await
    .0
}
