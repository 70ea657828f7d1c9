//! Who is on the bus: a slot, and so an address, for each device.

use core::cell::Cell;

use crate::route::Route;
use crate::{Kind, Place};

/// Devices on the bus at most, hubs among them.
pub const DEVICES_MAXIMUM: usize = 10;

/// A slot's number, 0…[`DEVICES_MAXIMUM`] − 1; the device's address is one more.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct SlotIndex(u8);

impl SlotIndex {
    pub(crate) const ALL: [Self; DEVICES_MAXIMUM] = {
        let mut all = [Self(0); DEVICES_MAXIMUM];
        let mut index = 0;
        while index < all.len() {
            all[index] = Self(index as u8);
            index += 1;
        }
        all
    };

    pub(crate) const fn new(index: usize) -> Self {
        Self(index as u8)
    }

    pub(crate) const fn index(self) -> usize {
        self.0 as usize
    }

    /// The address of the device, 1…127.
    pub(crate) const fn address(self) -> u8 {
        self.0 + 1
    }
}

/// How far a slot's device is. The hub or the root port that it hangs on owns it in the first three.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Phase {
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
    /// A slot's phase has changed.
    stirred: Cell<bool>,
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
        Self { slots, turn: Cell::new(None), stirred: Cell::new(false) }
    }

    fn slot(&self, index: SlotIndex) -> &Slot {
        &self.slots[index.index()]
    }

    pub(crate) fn phase(&self, index: SlotIndex) -> Phase {
        self.slot(index).phase.get()
    }

    fn set_phase(&self, index: SlotIndex, phase: Phase) {
        self.slot(index).phase.set(phase);
        self.stirred.set(true);
    }

    /// Tells whether a slot's phase has changed since it was asked last.
    pub(crate) fn take_stirred(&self) -> bool {
        self.stirred.take()
    }

    pub(crate) fn place(&self, index: SlotIndex) -> Place {
        self.slot(index).place.get()
    }

    /// Takes a free slot and the turn at address 0 for a device whose port is to be reset.
    ///
    /// # Errors
    /// [`NotNow::Later`] while another device has the turn, or who was there before has not been let go;
    /// [`NotNow::NoRoom`] if there is no free slot.
    pub(crate) fn reserve(&self, parent: Option<SlotIndex>, place: Place) -> Result<SlotIndex, NotNow> {
        let is_free = |slot: &Slot| matches!(slot.phase.get(), Phase::Free);
        if self.turn.get().is_some() || self.slots.iter().any(|slot| !is_free(slot) && slot.place.get() == place) {
            return Err(NotNow::Later);
        }
        let index = SlotIndex::ALL.into_iter().find(|&index| is_free(self.slot(index))).ok_or(NotNow::NoRoom)?;
        let slot = self.slot(index);
        self.set_phase(index, Phase::Reserved);
        slot.place.set(place);
        slot.parent.set(parent);
        self.turn.set(Some(index));
        Ok(index)
    }

    /// Says that a reserved slot's device has been reset.
    pub(crate) fn begin(&self, index: SlotIndex, route: Route) {
        self.set_phase(index, Phase::Ready(route));
    }

    /// Says that a device is being talked to from now on.
    pub(crate) fn take(&self, index: SlotIndex) {
        self.set_phase(index, Phase::Busy);
    }

    /// Ends a device's turn at address 0, if it is its.
    pub(crate) fn end_turn(&self, index: SlotIndex) {
        if self.turn.get() == Some(index) {
            self.turn.set(None);
            self.stirred.set(true);
        }
    }

    /// Lets a device go: at once, or as soon as that has been told.
    pub(crate) fn leave(&self, index: SlotIndex) {
        match self.phase(index) {
            Phase::Leaving => {}
            Phase::Busy => self.set_phase(index, Phase::Leaving),
            _ => {
                self.set_phase(index, Phase::Free);
                self.end_turn(index);
            }
        }
    }

    pub(crate) fn is_leaving(&self, index: SlotIndex) -> bool {
        matches!(self.phase(index), Phase::Leaving)
    }

    pub(crate) fn has_failed(&self, index: SlotIndex) -> bool {
        matches!(self.phase(index), Phase::Failed)
    }

    /// Ends the talk with a device, because it is let go or has failed.
    pub(crate) fn end(&self, index: SlotIndex) {
        let leaving = matches!(self.phase(index), Phase::Leaving);
        self.set_phase(index, if leaving { Phase::Free } else { Phase::Failed });
    }

    /// Lets go of everything that hangs on a hub.
    pub(crate) fn leave_children(&self, hub: SlotIndex) {
        for index in SlotIndex::ALL {
            if self.slot(index).parent.get() == Some(hub) && !matches!(self.phase(index), Phase::Free) {
                self.leave(index);
            }
        }
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

/// Why a port cannot be reset now.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NotNow {
    Later,
    NoRoom,
}
