//! A hub: its ports, and what is plugged into them.

mod port;
mod status;

use crate::descriptor::Endpoint;
use crate::ear::Ear;
use crate::link::{Link, Next};
use crate::mailbox::Outcome;
use crate::setup::{Setup, descriptor};
use crate::slots::SlotIndex;
use crate::timing::Wait;
use crate::{Fault, Kind, Memory, Step};
use port::{Port, Task};
use status::{Status, feature};

/// Ports of a hub that are served, from port 1 on.
pub const HUB_PORTS_MAXIMUM: u8 = 8;

/// A hub that is served.
#[derive(Debug)]
pub(crate) struct HubTalk {
    /// How many ports it has.
    count: u8,
    /// bPwrOn2PwrGood.
    power_good: u8,
    ports: [Port; HUB_PORTS_MAXIMUM as usize],
    ear: Ear,
    /// What has changed and was not looked at yet: bit `n` for port `n`, bit 0 for the hub itself (USB 2.0 §11.12.4).
    changes: u32,
    stage: Stage,
}

/// What is being done.
#[derive(Debug, Clone, Copy)]
enum Stage {
    Begin,
    /// Ports are powered, this one and those above.
    Power {
        port: u8,
    },
    PowerGood,
    Rest,
    /// The hub itself is asked what has changed.
    HubStatus,
    /// Its changes are taken note of.
    HubClear {
        changes: u16,
    },
    /// The translator is told to forget what it holds for a device: first what goes there, then what comes.
    ClearBuffer {
        of: SlotIndex,
        address: u8,
        input: bool,
    },
    /// A port, by its index, is dealt with.
    Port {
        index: u8,
        task: Task,
    },
}

impl HubTalk {
    /// Bytes of the hub descriptor that are of use.
    pub(crate) const DESCRIPTOR_LENGTH: usize = 9;

    /// Reads ports and bPwrOn2PwrGood from a hub descriptor (USB 2.0 §11.23.2.1); `None` if it is none.
    pub(crate) fn parse(bytes: &[u8]) -> Option<(u8, u8)> {
        match *bytes {
            [7..=255, descriptor::HUB, ports @ 1..=255, _, _, power_good, _, ..] => Some((ports, power_good)),
            _ => None,
        }
    }

    pub(crate) fn new(count: u8, power_good: u8, status: Endpoint) -> Self {
        Self {
            count,
            power_good,
            ports: core::array::from_fn(|index| Port::new(index as u8 + 1)),
            ear: Ear::new(status, Step::Port),
            changes: 0,
            stage: Stage::Begin,
        }
    }

    pub(crate) const fn kind(&self) -> Kind {
        Kind::Hub { ports: self.count }
    }

    fn served(&self) -> u8 {
        self.count.min(HUB_PORTS_MAXIMUM)
    }

    /// Takes note of what has changed.
    pub(crate) fn hear(&mut self, link: &Link, memory: &Memory, arrival: Outcome) {
        let mailbox = link.mailbox(memory);
        if let Some(length) = self.ear.hear(arrival) {
            let packet = mailbox.packet(length.min(size_of::<u32>()));
            self.changes |= packet.iter().rev().fold(0, |changes, &byte| changes << 8 | u32::from(byte));
            drop(packet);
            mailbox.go_on(false);
        }
    }

    pub(crate) fn next(&mut self, link: &mut Link, memory: &Memory) -> Result<Next, Fault> {
        if let Some(next) = self.ear.next(link, memory)? {
            return Ok(next);
        }
        match self.stage {
            Stage::Begin => {
                if self.count > HUB_PORTS_MAXIMUM {
                    memory.tell_fault(link.place(), Fault::TooManyPorts { ports: self.count });
                }
                self.stage = Stage::Power { port: 1 };
            }
            Stage::Power { port } if port > self.served() => {
                self.stage = Stage::PowerGood;
                return Ok(link.wait(memory, Wait::POWER_GOOD_UNIT.times(self.power_good.into())));
            }
            Stage::Power { port } => {
                return Ok(link.order(memory, Step::Port, Setup::set_port_feature(feature::POWER, port)));
            }
            Stage::PowerGood => {
                link.mailbox(memory).listen(link.way(self.ear.endpoint));
                // What was plugged in before power came need not be told of as a change.
                self.changes = u32::MAX;
                self.stage = Stage::Rest;
            }
            Stage::Rest => {
                self.choose(link, memory);
                if let Stage::Rest = self.stage {
                    return Ok(Next::Nothing);
                }
            }
            Stage::HubStatus => return Ok(link.read(memory, Step::Port, Setup::hub_status(0), Status::LENGTH)),
            Stage::HubClear { changes: 0 } => self.stage = Stage::Rest,
            Stage::HubClear { changes } => {
                let change = changes.trailing_zeros() as u8;
                return Ok(link.order(memory, Step::Port, Setup::clear_hub_feature(change, 0)));
            }
            Stage::ClearBuffer { address, input, .. } => {
                return Ok(link.order(memory, Step::Port, Setup::clear_tt_buffer(address, input)));
            }
            Stage::Port { index, task } => {
                let next = self.ports[usize::from(index)].next(link, memory, task);
                if let Some((next, task)) = next {
                    self.stage = Stage::Port { index, task };
                    return Ok(next);
                }
                self.stage = Stage::Rest;
            }
        }
        Ok(Next::Again)
    }

    /// Finds something to do.
    fn choose(&mut self, link: &Link, memory: &Memory) {
        if self.changes & 1 != 0 {
            self.changes &= !1;
            self.stage = Stage::HubStatus;
            return;
        }
        for of in SlotIndex::ALL {
            if let Some(way) = memory.mailbox(of).muddle_of(link.address) {
                self.stage = Stage::ClearBuffer { of, address: way.address, input: false };
                return;
            }
        }
        let served = self.served();
        for (index, port) in (0..served).zip(&mut self.ports) {
            let bit = 1 << (index + 1);
            let task = if self.changes & bit != 0 {
                self.changes &= !bit;
                Some(Task::LOOK)
            } else {
                port.wish(link, memory)
            };
            if let Some(task) = task {
                self.stage = Stage::Port { index, task };
                return;
            }
        }
    }

    pub(crate) fn answered(&mut self, link: &mut Link, memory: &Memory, answer: Outcome) -> Result<(), Fault> {
        if self.ear.answered(link, memory, answer)? {
            return Ok(());
        }
        if let Stage::ClearBuffer { of, address, input } = self.stage {
            // A hub at full speed has no translator, and refuses.
            self.stage = if input {
                memory.mailbox(of).set_clear();
                Stage::Rest
            } else {
                Stage::ClearBuffer { of, address, input: true }
            };
            return Ok(());
        }
        let count = link.succeeded(answer)?;
        match self.stage {
            Stage::Power { port } => self.stage = Stage::Power { port: port + 1 },
            Stage::HubStatus => {
                let hub = Status::parse(&link.data(memory, count)).ok_or(link.nonsense())?;
                if hub.changes & hub.status & 1 << 1 != 0 {
                    memory.tell_fault(link.place(), Fault::OverCurrent);
                }
                // Local power and over-current (USB 2.0 §11.24.2.6); there are no others.
                self.stage = Stage::HubClear { changes: hub.changes & 0b11 };
            }
            Stage::HubClear { changes } => self.stage = Stage::HubClear { changes: changes & (changes - 1) },
            Stage::Port { index, task } => {
                let data = link.data(memory, count);
                let task = self.ports[usize::from(index)].answered(link, memory, task, &data)?;
                self.stage = task.map_or(Stage::Rest, |task| Stage::Port { index, task });
            }
            Stage::Begin | Stage::PowerGood | Stage::ClearBuffer { .. } | Stage::Rest => {}
        }
        Ok(())
    }
}
