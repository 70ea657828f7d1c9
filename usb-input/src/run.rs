//! The root port, and the bus as a whole.

use core::convert::Infallible;
use core::future::poll_fn;
use core::task::Poll;

use embassy_futures::join::{join, join_array};
use embassy_futures::select::{Either, select};
use embassy_usb_driver::Speed;
use embassy_usb_driver::host::{DeviceEvent, UsbHostController};

use crate::bus::Bus;
use crate::route::Route;
use crate::slots::{DEVICES_MAXIMUM, SlotIndex};
use crate::timing::{ATTEMPTS, RETRY_PAUSE_US, ROOT_RETRY_PAUSE_US};
use crate::{Clock, Fault, Memory, Place, device};

/// Runs a bus: finds what is plugged into the controller's root port and below, and reads it, for ever.
///
/// Poll it through [`UsbInput`](crate::UsbInput).
///
/// What is asked of the controller beyond its traits' own words: if the future of
/// [`wait_for_device_event`](UsbHostController::wait_for_device_event) is dropped, the next one tells what it
/// would have told.
pub async fn run<'d, C: UsbHostController<'d>>(controller: C, clock: impl Clock, memory: &Memory) -> Infallible {
    let bus = Bus { allocator: controller.allocator(), clock, memory };
    let slots = core::array::from_fn::<_, DEVICES_MAXIMUM, _>(|index| device::slot(&bus, SlotIndex::new(index)));
    join(root(&bus, controller), join_array(slots)).await.0
}

/// Serves the root port.
async fn root<'d, C: UsbHostController<'d>, K: Clock>(bus: &Bus<'_, C::Allocator, K>, mut controller: C) -> Infallible {
    let slots = &bus.memory.slots;
    let mut device: Option<SlotIndex> = None;
    let (mut speed, mut attempts) = (Speed::Full, 0);
    loop {
        match select(controller.wait_for_device_event(), failure(bus, device)).await {
            Either::First(event) => {
                if let Some(device) = device.take() {
                    slots.leave(device);
                }
                match event {
                    DeviceEvent::Connected(now) => (speed, attempts) = (now, 0),
                    DeviceEvent::Overcurrent => {
                        bus.tell_fault(Place::ROOT, Fault::OverCurrent).await;
                        continue;
                    }
                    _ => continue,
                }
            }
            Either::Second(failed) => {
                slots.leave(failed);
                attempts += 1;
                // A device on the board cannot be plugged in again: it is never given up.
                bus.sleep(if attempts < ATTEMPTS { RETRY_PAUSE_US } else { ROOT_RETRY_PAUSE_US }).await;
                controller.bus_reset().await;
            }
        }
        device = Some(begin(bus, speed).await);
    }
}

/// Waits until the root port's device has failed.
async fn failure<A, K>(bus: &Bus<'_, A, K>, device: Option<SlotIndex>) -> SlotIndex {
    let failed = || device.filter(|&device| bus.memory.slots.has_failed(device));
    poll_fn(|_| failed().map_or(Poll::Pending, Poll::Ready)).await
}

/// Begins with the root port's device, which has been reset, as soon as the one before it has been let go.
async fn begin<A, K>(bus: &Bus<'_, A, K>, speed: Speed) -> SlotIndex {
    let slots = &bus.memory.slots;
    let reserve = || if slots.may_begin(Place::ROOT) { slots.reserve(None, Place::ROOT) } else { None };
    let device = poll_fn(|_| reserve().map_or(Poll::Pending, Poll::Ready)).await;
    slots.begin(device, Route::root(speed));
    device
}
