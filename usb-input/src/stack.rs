//! All that is said on the bus: to the root port's device, and to those below.

use crate::root::Root;
use crate::slots::{DEVICES_MAXIMUM, Phase, SlotIndex};
use crate::talk::Talk;
use crate::{Event, Fault, Memory};

/// What is said on the bus.
#[derive(Debug)]
pub(crate) struct Stack {
    talks: [Option<Talk>; DEVICES_MAXIMUM],
    /// The faults that ended talks, until they are told.
    ends: [Option<Fault>; DEVICES_MAXIMUM],
}

impl Stack {
    pub(crate) const fn new() -> Self {
        Self { talks: [const { None }; DEVICES_MAXIMUM], ends: [None; DEVICES_MAXIMUM] }
    }

    /// Goes on a step with everybody.
    #[inline(never)]
    pub(crate) fn poll(&mut self, memory: &Memory, root: &Root) {
        root.poll(memory);
        for slot in SlotIndex::ALL {
            self.poll_slot(memory, slot);
        }
    }

    fn poll_slot(&mut self, memory: &Memory, slot: SlotIndex) {
        let (talk, end) = (&mut self.talks[slot.index()], &mut self.ends[slot.index()]);
        let slots = &memory.slots;
        match slots.phase(slot) {
            Phase::Ready(route) => {
                memory.mailbox(slot).set_open(true);
                slots.take(slot);
                *talk = Some(Talk::new(slot, route, memory));
            }
            Phase::Busy => {
                if let Some(Err(fault)) = talk.as_mut().filter(|_| end.is_none()).map(|talk| talk.poll(memory)) {
                    *end = Some(fault);
                }
                if end.is_some() {
                    farewell(memory, slot, end, talk);
                }
            }
            Phase::Leaving => farewell(memory, slot, end, talk),
            Phase::Free | Phase::Reserved | Phase::Failed => {}
        }
    }
}

/// Tells that a device is let go or has failed, as soon as there is room, and makes its slot free, or ready for
/// another attempt. One that has failed keeps its turn at address 0, where it may still answer, until its port has
/// cut it off.
fn farewell(memory: &Memory, slot: SlotIndex, end: &mut Option<Fault>, talk: &mut Option<Talk>) {
    let slots = &memory.slots;
    *talk = None;
    memory.mailbox(slot).set_open(false);
    if slots.is_leaving(slot) {
        slots.end_turn(slot);
    }
    slots.leave_children(slot);
    if !memory.has_room() {
        return;
    }
    let device = slots.place(slot);
    if let Some(fault) = end.take() {
        memory.tell_fault(device, fault);
    }
    if let Some(kind) = slots.take_told(slot) {
        memory.tell(Event::Detached { device, kind });
    }
    slots.end(slot);
}
