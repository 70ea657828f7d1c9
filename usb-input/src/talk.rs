//! What is said to one device, from its reset until it has gone.

use embassy_usb_driver::Speed;

use crate::bring_up::BringUp;
use crate::hub::HubTalk;
use crate::input::Input;
use crate::link::{Link, Next};
use crate::mailbox::Outcome;
use crate::route::Route;
use crate::slots::SlotIndex;
use crate::timing::Wait;
use crate::{Event, Fault, Memory, Step};

/// What is said to one device.
#[derive(Debug)]
pub(crate) struct Talk {
    link: Link,
    role: Role,
    /// A transfer is under way.
    waiting: bool,
}

/// What a device is served as.
#[derive(Debug)]
pub(crate) enum Role {
    BringUp(BringUp),
    Hub(HubTalk),
    Input(Input),
    /// It is left alone.
    Alone,
}

impl Talk {
    /// Begins with a device that has just been reset.
    pub(crate) fn new(slot: SlotIndex, route: Route, memory: &Memory) -> Self {
        // What every device of the speed understands for its first eight bytes (USB 2.0 §5.5.3).
        let packet = if route.speed == Speed::Low { 8 } else { 64 };
        let until = memory.after(Wait::RESET_RECOVERY);
        let link = Link { slot, route, address: 0, packet, doing: Step::DeviceDescriptor, until };
        Self { link, role: Role::BringUp(BringUp::new(memory.after(Wait::READY_TIMEOUT), route.speed)), waiting: false }
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
            && memory.has_come(bring_up.deadline)
        {
            return Err(Fault::TooSlow);
        }
        if self.waiting {
            let Some(answer) = mailbox.take_answer() else { return Ok(()) };
            self.waiting = false;
            role.answered(link, memory, answer)?;
        }
        if !memory.has_come(link.until) || !memory.has_room() {
            return Ok(());
        }
        match role.next(link, memory)? {
            Next::Answer => self.waiting = true,
            Next::Wait | Next::Again => mailbox.stir(),
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
                if bring_up.is_ready() {
                    self.begin(link, memory);
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
    fn begin(&mut self, link: &Link, memory: &Memory) {
        let Self::BringUp(bring_up) = self else { return };
        let (device, identity, role) = (link.place(), bring_up.identity, bring_up.role());
        let kind = match &role {
            Self::Hub(hub) => Some(hub.kind()),
            Self::Input(input) => {
                input.listen(link, memory);
                Some(input.kind())
            }
            _ => None,
        };
        memory.slots.end_turn(link.slot);
        memory.slots.set_told(link.slot, kind);
        memory.tell(match kind {
            Some(kind) => Event::Attached { device, kind, identity },
            None => Event::Unsupported { device, identity },
        });
        *self = role;
    }
}
