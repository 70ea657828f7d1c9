//! Who is on the bus: a slot, and so an address, for each device.

use core::cell::Cell;
use core::future::poll_fn;
use core::task::Poll;

use crate::route::Route;
use crate::{Kind, Place};

/// Devices on the bus at most, hubs among them.
pub const DEVICES_MAXIMUM: usize = 10;

/// A slot's number, 0…[`DEVICES_MAXIMUM`] − 1; the device's address is one more.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct SlotIndex(u8);

impl SlotIndex {
    pub(crate) fn all() -> impl Iterator<Item = Self> {
        (0..DEVICES_MAXIMUM as u8).map(Self)
    }

    pub(crate) const fn new(index: usize) -> Self {
        Self(index as u8)
    }

    /// The address of the device, 1…127.
    pub(crate) const fn address(self) -> u8 {
        self.0 + 1
    }
}

/// How far a slot's device is. A hub or the root port owns it in all but the last three.
#[derive(Debug, Clone, Copy)]
enum Phase {
    Free,
    /// Promised to a port whose reset is under way.
    Reserved,
    /// Failed; wants its port reset.
    Failed,
    /// Its port is reset, it answers to address 0.
    Ready(Route),
    /// It is being talked to.
    Busy,
    /// It has gone, and will be told so.
    Leaving,
}

#[derive(Debug)]
struct Slot {
    phase: Cell<Phase>,
    place: Cell<Place>,
    /// The hub that it hangs on; `None` for the root port.
    parent: Cell<Option<SlotIndex>>,
    /// What was told of it: nothing, or that it is there, and as what.
    told: Cell<Option<Option<Kind>>>,
}

/// All slots, and whose turn it is at address 0.
#[derive(Debug)]
pub(crate) struct Slots {
    slots: [Slot; DEVICES_MAXIMUM],
    turn: Cell<Option<SlotIndex>>,
}

impl Slots {
    pub(crate) const fn new() -> Self {
        let slots = [const {
            Slot {
                phase: Cell::new(Phase::Free),
                place: Cell::new(Place::ROOT),
                parent: Cell::new(None),
                told: Cell::new(None),
            }
        }; DEVICES_MAXIMUM];
        Self { slots, turn: Cell::new(None) }
    }

    fn slot(&self, index: SlotIndex) -> &Slot {
        &self.slots[usize::from(index.0)]
    }

    /// Tells whether a new device at a place may be reset: no other has address 0, and who was there before
    /// has been let go.
    pub(crate) fn may_begin(&self, place: Place) -> bool {
        let gone = |slot: &Slot| matches!(slot.phase.get(), Phase::Free) || slot.place.get() != place;
        self.turn.get().is_none() && self.slots.iter().all(gone)
    }

    /// Takes a free slot and the turn at address 0 for a device; `None` if there is no free slot.
    pub(crate) fn reserve(&self, parent: Option<SlotIndex>, place: Place) -> Option<SlotIndex> {
        let index = SlotIndex::all().find(|&index| matches!(self.slot(index).phase.get(), Phase::Free))?;
        let slot = self.slot(index);
        slot.phase.set(Phase::Reserved);
        slot.place.set(place);
        slot.parent.set(parent);
        self.turn.set(Some(index));
        Some(index)
    }

    /// Says that a reserved slot's device has been reset.
    pub(crate) fn begin(&self, index: SlotIndex, route: Route) {
        self.slot(index).phase.set(Phase::Ready(route));
    }

    /// Waits until a slot's device has been reset.
    pub(crate) async fn ready(&self, index: SlotIndex) -> Route {
        let phase = &self.slot(index).phase;
        poll_fn(|_| match phase.get() {
            Phase::Ready(route) => {
                phase.set(Phase::Busy);
                Poll::Ready(route)
            }
            _ => Poll::Pending,
        })
        .await
    }

    /// Ends a device's turn at address 0, if it is its.
    pub(crate) fn end_turn(&self, index: SlotIndex) {
        if self.turn.get() == Some(index) {
            self.turn.set(None);
        }
    }

    /// Lets a device go: at once, or as soon as who talks to it has told so.
    pub(crate) fn leave(&self, index: SlotIndex) {
        let phase = &self.slot(index).phase;
        match phase.get() {
            Phase::Busy | Phase::Leaving => phase.set(Phase::Leaving),
            _ => {
                phase.set(Phase::Free);
                self.end_turn(index);
            }
        }
    }

    /// Waits until a device is to be let go.
    pub(crate) async fn left(&self, index: SlotIndex) {
        poll_fn(|_| if self.is_leaving(index) { Poll::Ready(()) } else { Poll::Pending }).await;
    }

    fn is_leaving(&self, index: SlotIndex) -> bool {
        matches!(self.slot(index).phase.get(), Phase::Leaving)
    }

    pub(crate) fn has_failed(&self, index: SlotIndex) -> bool {
        matches!(self.slot(index).phase.get(), Phase::Failed)
    }

    /// Ends the talk with a device, because it is let go or has failed.
    pub(crate) fn end(&self, index: SlotIndex) {
        let phase = if self.is_leaving(index) { Phase::Free } else { Phase::Failed };
        self.slot(index).phase.set(phase);
    }

    /// Lets go of everything that hangs on a hub.
    pub(crate) fn leave_children(&self, hub: SlotIndex) {
        let on_hub = |index: &SlotIndex| {
            let slot = self.slot(*index);
            slot.parent.get() == Some(hub) && !matches!(slot.phase.get(), Phase::Free)
        };
        SlotIndex::all().filter(on_hub).for_each(|index| self.leave(index));
    }

    /// Notes that a device was told of.
    pub(crate) fn set_told(&self, index: SlotIndex, kind: Option<Kind>) {
        self.slot(index).told.set(Some(kind));
    }

    /// Takes what was told of a device.
    pub(crate) fn take_told(&self, index: SlotIndex) -> Option<Option<Kind>> {
        self.slot(index).told.take()
    }
}
