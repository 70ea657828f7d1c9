//! One device, as those who know what to say to it see it.

use core::cell::Ref;

use crate::descriptor::Endpoint;
use crate::mailbox::{DATA_BYTES, Mailbox, Outcome, Request, TransferError, Way};
use crate::route::Route;
use crate::setup::Setup;
use crate::slots::SlotIndex;
use crate::timing::{Moment, Wait};
use crate::{Fault, Memory, Place, Step};

/// A device, reached at an address.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Link {
    pub(crate) slot: SlotIndex,
    pub(crate) route: Route,
    /// 0 until the device has its own.
    pub(crate) address: u8,
    /// Bytes in a packet of endpoint 0.
    pub(crate) packet: u16,
    /// What is being done.
    pub(crate) doing: Step,
    /// Nothing is said before.
    pub(crate) until: Moment,
}

/// What is wanted next of a device, or of time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Next {
    /// A transfer was wanted; its answer comes.
    Answer,
    /// To be asked again when [`Link::until`] has come.
    Wait,
    /// To be asked again, at once.
    Again,
    /// Nothing, until something happens.
    Nothing,
}

impl Link {
    pub(crate) fn place(&self) -> Place {
        self.route.place
    }

    pub(crate) fn mailbox<'m>(&self, memory: &'m Memory) -> &'m Mailbox {
        memory.mailbox(self.slot)
    }

    /// What the last transfer brought.
    pub(crate) fn data<'m>(&self, memory: &'m Memory, count: usize) -> Ref<'m, [u8]> {
        self.mailbox(memory).data(count)
    }

    /// Says nothing for a while.
    pub(crate) fn wait(&mut self, memory: &Memory, wait: Wait) -> Next {
        self.until = memory.after(wait);
        Next::Wait
    }

    /// Reads up to so many bytes by a control transfer, for [`data`](Self::data).
    #[inline(never)]
    pub(crate) fn read(&mut self, memory: &Memory, doing: Step, setup: Setup, length: usize) -> Next {
        self.doing = doing;
        let way =
            Way { address: self.address, endpoint: 0, packet: self.packet, interval_ms: 0, split: self.route.split };
        let length = length.min(DATA_BYTES) as u16;
        self.mailbox(memory).request(Request { way, setup: Some(setup), length });
        Next::Answer
    }

    /// Tells the device something by a control transfer without data.
    pub(crate) fn order(&mut self, memory: &Memory, doing: Step, setup: Setup) -> Next {
        self.read(memory, doing, setup, 0)
    }

    /// Writes by a control transfer.
    pub(crate) fn write(&mut self, memory: &Memory, doing: Step, setup: Setup, data: &[u8]) -> Next {
        self.mailbox(memory).put_data(data);
        self.read(memory, doing, setup, data.len())
    }

    /// Sends a packet to an interrupt endpoint.
    pub(crate) fn send(&mut self, memory: &Memory, doing: Step, endpoint: Endpoint, data: &[u8]) -> Next {
        self.doing = doing;
        self.mailbox(memory).put_data(data);
        self.mailbox(memory).request(Request { way: self.way(endpoint), setup: None, length: data.len() as u16 });
        Next::Answer
    }

    pub(crate) fn way(&self, endpoint: Endpoint) -> Way {
        Way {
            address: self.address,
            endpoint: endpoint.number,
            packet: endpoint.packet,
            interval_ms: endpoint.interval_ms(self.route.speed),
            split: self.route.split,
        }
    }

    /// Says what a failed transfer is.
    pub(crate) const fn fault(&self, error: TransferError) -> Fault {
        match error {
            TransferError::NoPipe => Fault::NoPipe,
            TransferError::Pipe(error) => Fault::Transfer { doing: self.doing, error },
        }
    }

    /// Takes a transfer that has to succeed.
    pub(crate) fn succeeded(&self, answer: Outcome) -> Result<usize, Fault> {
        answer.map_err(|error| self.fault(error))
    }

    /// Says that what a device told makes no sense.
    pub(crate) const fn nonsense(&self) -> Fault {
        Fault::Descriptor { doing: self.doing }
    }
}
