//! A slot: one device after the other, from its reset until it has gone.

use core::convert::Infallible;

use embassy_futures::select::{Either, select};
use embassy_usb_driver::Speed;
use embassy_usb_driver::host::UsbHostAllocator;

use crate::bring_up::{Function, bring_up};
use crate::bus::Bus;
use crate::link::Link;
use crate::route::Route;
use crate::slots::SlotIndex;
use crate::timing::READY_TIMEOUT_US;
use crate::{Clock, Event, Fault, hub, reports};

/// Serves the devices that get this slot, for ever.
pub(crate) async fn slot<'d, A: UsbHostAllocator<'d>, K: Clock>(bus: &Bus<'_, A, K>, slot: SlotIndex) -> Infallible {
    let slots = &bus.memory.slots;
    loop {
        let route = slots.ready(slot).await;
        let fault = match select(serve(bus, slot, route), slots.left(slot)).await {
            Either::First(Ok(never)) => match never {},
            Either::First(Err(fault)) => Some(fault),
            Either::Second(()) => None,
        };
        slots.end_turn(slot);
        slots.leave_children(slot);
        if let Some(fault) = fault {
            bus.tell_fault(route.place, fault).await;
        }
        if let Some(kind) = slots.take_told(slot) {
            bus.tell(Event::Detached { device: route.place, kind }).await;
        }
        slots.end(slot);
    }
}

/// Serves a device until it fails.
async fn serve<'d, A: UsbHostAllocator<'d>, K: Clock>(
    bus: &Bus<'_, A, K>,
    slot: SlotIndex,
    route: Route,
) -> Result<Infallible, Fault> {
    // What every device of the speed understands for its first eight bytes (USB 2.0 §5.5.3).
    let packet = if route.speed == Speed::Low { 8 } else { 64 };
    let mut link = Link { bus, slot, route, address: 0, packet };
    let Some(ready) = bus.within(READY_TIMEOUT_US, bring_up(&mut link)).await else {
        return Err(Fault::TooSlow);
    };
    let ready = ready?;
    let slots = &bus.memory.slots;
    slots.end_turn(slot);
    let (device, identity, kind) = (route.place, ready.identity, ready.function.kind());
    slots.set_told(slot, kind);
    bus.tell(match kind {
        Some(kind) => Event::Attached { device, kind, identity },
        None => Event::Unsupported { device, identity },
    })
    .await;
    match ready.function {
        Function::Hub(hub) => hub::serve(link, hub).await,
        Function::Input { hid, reader, .. } => reports::serve(link, hid, &reader).await,
        Function::None => core::future::pending().await,
    }
}
