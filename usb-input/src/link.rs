//! One device, as those who know what to say to it see it.

use core::cell::Ref;

use crate::descriptor::Endpoint;
use crate::mailbox::{Listening, Mailbox, Request, RequestKind, Transfer};
use crate::route::Route;
use crate::setup::Setup;
use crate::slots::SlotIndex;
use crate::{Memory, Step};

/// A device, reached at an address.
#[derive(Clone, Copy)]
pub(crate) struct Link<'m> {
    pub(crate) memory: &'m Memory,
    pub(crate) slot: SlotIndex,
    pub(crate) route: Route,
    /// 0 until the device has its own.
    pub(crate) address: u8,
    /// Bytes in a packet of endpoint 0.
    pub(crate) packet: u16,
}

impl<'m> Link<'m> {
    pub(crate) fn mailbox(&self) -> &'m Mailbox {
        self.memory.mailbox(self.slot)
    }

    /// Reads up to so many bytes by a control transfer, for [`data`](Self::data); tells how many came.
    pub(crate) fn read(&self, doing: Step, setup: Setup, length: usize) -> Transfer<'m> {
        self.transfer(doing, RequestKind::Control(setup), length, &[])
    }

    /// Writes by a control transfer.
    pub(crate) fn write<'a>(&self, doing: Step, setup: Setup, data: &'a [u8]) -> Transfer<'a>
    where
        'm: 'a,
    {
        self.transfer(doing, RequestKind::Control(setup), data.len(), data)
    }

    /// Sends a packet to an interrupt endpoint.
    pub(crate) fn send<'a>(&self, doing: Step, endpoint: Endpoint, data: &'a [u8]) -> Transfer<'a>
    where
        'm: 'a,
    {
        self.transfer(doing, RequestKind::Out(endpoint), data.len(), data)
    }

    fn transfer<'a>(&self, doing: Step, kind: RequestKind, length: usize, data: &'a [u8]) -> Transfer<'a>
    where
        'm: 'a,
    {
        let length = length.min(crate::mailbox::DATA_BYTES) as u16;
        let request = Request { address: self.address, packet: self.packet, doing, kind, length };
        Transfer::new(self.mailbox(), request, data)
    }

    /// What the last transfer brought.
    pub(crate) fn data(&self, count: usize) -> Ref<'m, [u8]> {
        self.mailbox().data(count)
    }

    /// Asks for packets from an interrupt endpoint.
    pub(crate) fn listen(&self, endpoint: Endpoint) {
        self.mailbox().listen(Listening { address: self.address, endpoint });
    }
}
