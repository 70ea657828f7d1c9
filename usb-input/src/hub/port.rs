//! One port of a hub.

use embassy_usb_driver::Speed;

use super::status::{Status, bit, feature};
use crate::link::{Link, Next};
use crate::setup::Setup;
use crate::slots::{NotNow, SlotIndex};
use crate::timing::{ATTEMPTS, Moment, Wait};
use crate::{Fault, Memory, Step};

/// One port.
#[derive(Debug)]
pub(super) struct Port {
    number: u8,
    /// Who is there, as far as it has been reset.
    device: Option<SlotIndex>,
    /// When who is there may be reset.
    due: Option<Moment>,
    /// How often it was reset since it was plugged in.
    attempts: u8,
}

/// What is done with a port.
#[derive(Debug, Clone, Copy)]
pub(super) enum Task {
    /// It is asked what has changed, beside what was taken note of already.
    Look {
        noted: u16,
    },
    /// Its changes are taken note of, those that are left.
    Clear {
        noted: u16,
        left: u16,
    },
    /// Power that it lost comes back.
    Power,
    Reset,
    /// Its reset lasts.
    Wait {
        end: Moment,
    },
    /// It is asked whether its reset is over.
    Ask {
        end: Moment,
    },
    /// The end of its reset is taken note of; the speed of who is there, if it is enabled.
    ClearReset {
        speed: Option<Speed>,
    },
    /// Who failed is cut off, before it is tried again.
    CutOff,
    /// Who is there is cut off for good.
    Disable {
        fault: Fault,
    },
}

impl Task {
    pub(super) const LOOK: Self = Self::Look { noted: 0 };
}

impl Port {
    pub(super) const fn new(number: u8) -> Self {
        Self { number, device: None, due: None, attempts: 0 }
    }

    /// Returns what it wants done: who is there reset, or cut off.
    pub(super) fn wish(&mut self, link: &Link, memory: &Memory) -> Option<Task> {
        if let Some(device) = self.device {
            // Until it is cut off it may still answer at address 0, and has the turn there.
            return memory.slots.has_failed(device).then_some(Task::CutOff);
        }
        if !memory.has_come(self.due?) {
            return None;
        }
        let fault = match (self.attempts, link.place().below(self.number)) {
            (ATTEMPTS.., _) => Fault::GivenUp,
            (_, None) => Fault::TooDeep,
            // Takes the turn at address 0; from here on it has to be begun or let go.
            (_, Some(place)) => match memory.slots.reserve(Some(link.slot), place) {
                Ok(device) => {
                    self.device = Some(device);
                    self.due = None;
                    self.attempts += 1;
                    return Some(Task::Reset);
                }
                Err(NotNow::Later) => return None,
                Err(NotNow::NoRoom) => Fault::TooManyDevices,
            },
        };
        self.due = None;
        self.attempts = ATTEMPTS;
        Some(Task::Disable { fault })
    }

    /// Says what is next of a task, and the task from there on; `None` at its end.
    pub(super) fn next(&mut self, link: &mut Link, memory: &Memory, task: Task) -> Option<(Next, Task)> {
        let setup = match task {
            // What changed again before the note was taken is seen now: the note has cleared it.
            Task::Clear { left: 0, noted } => return Some((Next::Again, Task::Look { noted })),
            Task::Look { .. } | Task::Ask { .. } => {
                let next = link.read(memory, Step::Port, Setup::hub_status(self.number), Status::LENGTH);
                return Some((next, task));
            }
            Task::Wait { end } => {
                return Some((link.wait(memory, Wait::PORT_RESET_STEP), Task::Ask { end }));
            }
            Task::Clear { left, .. } => {
                let change = left.trailing_zeros() as u8;
                Setup::clear_hub_feature(feature::CHANGES + change, self.number)
            }
            Task::Power => Setup::set_port_feature(feature::POWER, self.number),
            Task::Reset => Setup::set_port_feature(feature::RESET, self.number),
            Task::ClearReset { .. } => Setup::clear_hub_feature(feature::CHANGE_RESET, self.number),
            Task::CutOff | Task::Disable { .. } => Setup::clear_hub_feature(feature::ENABLE, self.number),
        };
        Some((link.order(memory, Step::Port, setup), task))
    }

    /// Takes the answer to a task's request; returns the task from there on.
    pub(super) fn answered(
        &mut self,
        link: &Link,
        memory: &Memory,
        task: Task,
        data: &[u8],
    ) -> Result<Option<Task>, Fault> {
        let status = || Status::parse(data).ok_or(link.nonsense());
        Ok(match task {
            Task::Look { noted } => {
                let port = status()?;
                match port.changes & bit::CHANGES {
                    0 => self.looked(link, memory, Status { changes: noted, ..port }),
                    left => Some(Task::Clear { noted: noted | left, left }),
                }
            }
            Task::Clear { noted, left } => Some(Task::Clear { noted, left: left & (left - 1) }),
            Task::Reset => Some(Task::Wait { end: memory.after(Wait::PORT_RESET_TIMEOUT) }),
            Task::Ask { end } => {
                let port = status()?;
                if port.has_changed(bit::RESET) {
                    // Another connection in between will be looked at as a change.
                    let steady = port.is(bit::CONNECTION) && !port.has_changed(bit::CONNECTION);
                    let speed = (steady && port.is(bit::ENABLE)).then(|| port.speed());
                    Some(Task::ClearReset { speed })
                } else if memory.has_come(end) {
                    self.was_reset(link, memory, None)
                } else {
                    Some(Task::Wait { end })
                }
            }
            Task::ClearReset { speed } => self.was_reset(link, memory, speed),
            Task::CutOff => {
                self.let_go(memory);
                self.due = Some(memory.after(Wait::RETRY_PAUSE));
                None
            }
            Task::Disable { fault } => {
                memory.tell_fault(link.place().below(self.number).unwrap_or(link.place()), fault);
                None
            }
            Task::Power | Task::Wait { .. } => None,
        })
    }

    /// Goes on after a reset.
    fn was_reset(&mut self, link: &Link, memory: &Memory, speed: Option<Speed>) -> Option<Task> {
        match (speed, self.device, link.place().below(self.number)) {
            (Some(speed), Some(device), Some(place)) => {
                let route = link.route.below(link.address, self.number, place, speed);
                memory.slots.begin(device, route);
            }
            // It may be at address 0 all the same.
            _ => return Some(Task::CutOff),
        }
        None
    }

    /// Acts on what the port says now, and on what has changed, all of which was taken note of.
    fn looked(&mut self, link: &Link, memory: &Memory, port: Status) -> Option<Task> {
        let connected = port.is(bit::CONNECTION);
        let unnoticed = self.device.is_none() && self.due.is_none() && self.attempts == 0;
        if port.has_changed(bit::CONNECTION) || unnoticed || !connected {
            self.let_go(memory);
            self.attempts = 0;
            self.due = connected.then(|| memory.after(Wait::PORT_DEBOUNCE));
        } else if port.has_changed(bit::ENABLE) && !port.is(bit::ENABLE) && self.device.is_some() {
            // The hub cut it off for what it did on the bus (§11.8.1).
            self.let_go(memory);
            self.due = Some(memory.after(Wait::RETRY_PAUSE));
        }
        if !port.has_changed(bit::OVER_CURRENT) {
            return None;
        }
        if port.is(bit::OVER_CURRENT) {
            memory.tell_fault(link.place(), Fault::OverCurrent);
            return None;
        }
        Some(Task::Power)
    }

    fn let_go(&mut self, memory: &Memory) {
        if let Some(device) = self.device.take() {
            memory.slots.leave(device);
        }
    }
}
