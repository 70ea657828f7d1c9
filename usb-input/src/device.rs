//! One device, from its reset until it has gone.

use core::convert::Infallible;

use embassy_futures::select::{Either, select};
use embassy_usb_driver::Speed;

use crate::bring_up::{Function, bring_up};
use crate::link::Link;
use crate::route::Route;
use crate::slots::SlotIndex;
use crate::timing::READY_TIMEOUT_US;
use crate::{Event, Fault, Memory, Place, hub, reports};

/// Talks to a device until it fails; tells how.
pub(crate) async fn talk(memory: &Memory, slot: SlotIndex, route: Route) -> Fault {
    match serve(memory, slot, route).await {
        Ok(never) => match never {},
        Err(fault) => fault,
    }
}

async fn serve(memory: &Memory, slot: SlotIndex, route: Route) -> Result<Infallible, Fault> {
    // What every device of the speed understands for its first eight bytes (USB 2.0 §5.5.3).
    let packet = if route.speed == Speed::Low { 8 } else { 64 };
    let mut link = Link { memory, slot, route, address: 0, packet };
    let ready = match select(bring_up(&mut link), memory.sleep(READY_TIMEOUT_US)).await {
        Either::First(ready) => ready?,
        Either::Second(()) => return Err(Fault::TooSlow),
    };
    memory.slots.end_turn(slot);
    let (device, identity, kind) = (route.place, ready.identity, ready.function.kind());
    memory.slots.set_told(slot, kind);
    memory
        .tell(match kind {
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

/// Tells that a device is let go or has failed, and makes its slot free, or ready for another attempt.
pub(crate) async fn farewell(memory: &Memory, slot: SlotIndex, device: Place, fault: Option<Fault>) {
    let slots = &memory.slots;
    slots.end_turn(slot);
    slots.leave_children(slot);
    if let Some(fault) = fault {
        memory.tell_fault(device, fault).await;
    }
    if let Some(kind) = slots.take_told(slot) {
        memory.tell(Event::Detached { device, kind }).await;
    }
    slots.end(slot);
}
