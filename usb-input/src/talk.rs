//! What is said to one device, from its reset until it has gone.

use embassy_usb_driver::Speed;

use crate::bring_up::BringUp;
use crate::hub::HubTalk;
use crate::input::Input;
use crate::link::{Link, Next};
use crate::mailbox::Outcome;
use crate::route::Route;
use crate::slots::SlotIndex;
use crate::{Event, Fault, Identity, Kind, Memory, Step};

/// What is said to one device.
#[derive(Debug)]
pub(crate) struct Talk {
    link: Link,
    role: Role,
    /// A transfer is under way.
    waiting: bool,
    /// Nothing is said before.
    until_us: u64,
}

/// What a device is served as.
#[derive(Debug)]
enum Role {
    BringUp(BringUp),
    Hub(HubTalk),
    Input(Input),
    /// It is left alone.
    Alone,
}

/// What became of bringing a device up.
pub(crate) enum Function {
    Hub(HubTalk),
    Input(Kind, Input),
    None,
}

impl Talk {
    /// Begins with a device that has just been reset.
    pub(crate) fn new(slot: SlotIndex, route: Route, memory: &Memory) -> Self {
        // What every device of the speed understands for its first eight bytes (USB 2.0 §5.5.3).
        let packet = if route.speed == Speed::Low { 8 } else { 64 };
        let link = Link { slot, route, address: 0, packet, doing: Step::DeviceDescriptor };
        Self { link, role: Role::BringUp(BringUp::new(memory.now_us())), waiting: false, until_us: 0 }
    }

    /// Goes on a step if there is one to go.
    ///
    /// # Errors
    /// The fault for which the device is given up, or tried again.
    pub(crate) fn poll(&mut self, memory: &Memory) -> Result<(), Fault> {
        let Self { link, role, .. } = self;
        let mailbox = link.mailbox(memory);
        if let Some(arrival) = mailbox.arrival().filter(|_| memory.has_room()) {
            role.hear(link, memory, arrival);
        }
        if let Role::BringUp(bring_up) = role
            && memory.has_come(bring_up.deadline_us())
        {
            return Err(Fault::TooSlow);
        }
        if self.waiting {
            let Some(answer) = mailbox.take_answer() else { return Ok(()) };
            self.waiting = false;
            role.answered(link, memory, answer)?;
        }
        if !memory.has_come(self.until_us) || !memory.has_room() {
            return Ok(());
        }
        match role.next(link, memory)? {
            Next::Answer => self.waiting = true,
            Next::Until(time_us) => {
                memory.has_come(time_us);
                self.until_us = time_us;
            }
            Next::Again => mailbox.stir(),
            Next::Nothing => {}
        }
        Ok(())
    }
}

impl Role {
    fn hear(&mut self, link: &Link, memory: &Memory, arrival: Outcome) {
        match self {
            Self::Hub(hub) => hub.hear(link, memory, arrival),
            Self::Input(input) => input.hear(link, memory, arrival),
            Self::BringUp(_) | Self::Alone => {}
        }
    }

    fn answered(&mut self, link: &mut Link, memory: &Memory, answer: Outcome) -> Result<(), Fault> {
        match self {
            Self::BringUp(bring_up) => bring_up.answered(link, memory, answer),
            Self::Hub(hub) => hub.answered(link, memory, answer),
            Self::Input(input) => input.answered(link, memory, answer),
            Self::Alone => Ok(()),
        }
    }

    fn next(&mut self, link: &mut Link, memory: &Memory) -> Result<Next, Fault> {
        match self {
            Self::BringUp(bring_up) => {
                if let Some((identity, function)) = bring_up.take_ready(link) {
                    *self = Self::ready(link, memory, identity, function);
                    return Ok(Next::Again);
                }
                Ok(bring_up.next(link, memory))
            }
            Self::Hub(hub) => hub.next(link, memory),
            Self::Input(input) => input.next(link, memory),
            Self::Alone => Ok(Next::Nothing),
        }
    }

    /// Tells of a device that is ready, and begins to serve it.
    fn ready(link: &Link, memory: &Memory, identity: Identity, function: Function) -> Self {
        memory.slots.end_turn(link.slot);
        let device = link.place();
        let (kind, role) = match function {
            Function::Hub(hub) => (Some(hub.kind()), Self::Hub(hub)),
            Function::Input(kind, input) => {
                input.listen(link, memory);
                (Some(kind), Self::Input(input))
            }
            Function::None => (None, Self::Alone),
        };
        memory.slots.set_told(link.slot, kind);
        memory.tell(match kind {
            Some(kind) => Event::Attached { device, kind, identity },
            None => Event::Unsupported { device, identity },
        });
        role
    }
}
