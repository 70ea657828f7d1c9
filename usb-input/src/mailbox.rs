//! Between those who know what to say to a device and those who carry it to the controller.
//!
//! What to say does not depend on the controller's type, and so is compiled once, for size; the carriers
//! ([`carrier`](crate::carrier)) do, and are as little as can be.

use core::cell::{Cell, Ref, RefCell, RefMut};
use core::future::poll_fn;
use core::task::Poll;

use embassy_usb_driver::host::{PipeError, SplitInfo};

use crate::descriptor::PACKET_MAXIMUM;
use crate::setup::Setup;
use crate::timing::Wait;

/// Bytes of the longest transfer on endpoint 0; what a descriptor has beyond is not seen.
pub(crate) const DATA_BYTES: usize = 512;

/// How a transfer ended: bytes that came or went, or why none did.
pub(crate) type Outcome = Result<usize, TransferError>;

/// Why there was no transfer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TransferError {
    NoPipe,
    Pipe(PipeError),
}

impl TransferError {
    /// The device refuses.
    pub(crate) const STALL: Self = Self::Pipe(PipeError::Stall);
}

/// An endpoint of a device.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Way {
    pub(crate) address: u8,
    pub(crate) endpoint: u8,
    /// Bytes in a packet, at least 1.
    pub(crate) packet: u16,
    pub(crate) interval_ms: u8,
    pub(crate) split: Option<SplitInfo>,
}

/// A transfer that is wanted.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Request {
    pub(crate) way: Way,
    /// `None` for a packet to an interrupt endpoint.
    pub(crate) setup: Option<Setup>,
    /// Bytes of the mailbox's data that go out, or that there is room for.
    pub(crate) length: u16,
}

impl Request {
    /// How long it may take: each packet of its data its time, all no longer than any request.
    pub(crate) const fn limit(&self) -> Wait {
        let packets = self.length.div_ceil(self.way.packet);
        match packets {
            0..=1 => Wait::STAGE_TIMEOUT,
            2..=9 => Wait::STAGE_TIMEOUT.times(packets as u32),
            _ => Wait::CONTROL_TIMEOUT,
        }
    }
}

/// One device's mailbox.
#[derive(Debug)]
pub(crate) struct Mailbox {
    open: Cell<bool>,
    request: Cell<Option<Request>>,
    answer: Cell<Option<Outcome>>,
    data: RefCell<[u8; DATA_BYTES]>,
    listening: Cell<Option<Way>>,
    arrival: Cell<Option<Outcome>>,
    packet: RefCell<[u8; PACKET_MAXIMUM as usize]>,
    /// The toggle of the endpoint that is listened to is DATA0 again.
    restart: Cell<bool>,
    /// The device's translator may hold a buffer for this way that nobody will fetch. Stays when the mailbox is closed.
    muddle: Cell<Option<Way>>,
    /// Something was put in or taken out.
    stirred: Cell<bool>,
}

impl Mailbox {
    pub(crate) const fn new() -> Self {
        Self {
            open: Cell::new(false),
            request: Cell::new(None),
            answer: Cell::new(None),
            data: RefCell::new([0; DATA_BYTES]),
            listening: Cell::new(None),
            arrival: Cell::new(None),
            packet: RefCell::new([0; PACKET_MAXIMUM as usize]),
            restart: Cell::new(false),
            muddle: Cell::new(None),
            stirred: Cell::new(false),
        }
    }

    /// Empties it; open, it serves a new device, else the carriers drop what they carry.
    pub(crate) fn set_open(&self, open: bool) {
        self.open.set(open);
        self.request.set(None);
        self.answer.set(None);
        self.listening.set(None);
        self.arrival.set(None);
        self.restart.set(false);
    }

    /// Says that there is more to do at once.
    pub(crate) fn stir(&self) {
        self.stirred.set(true);
    }

    /// Tells whether something was put in or taken out since it was asked last.
    pub(crate) fn take_stirred(&self) -> bool {
        self.stirred.take()
    }

    /// Puts bytes where a transfer takes them from. Not while one is under way.
    pub(crate) fn put_data(&self, bytes: &[u8]) {
        self.data_mut(bytes.len()).copy_from_slice(bytes);
    }

    /// The first so many of the bytes that a transfer brought.
    pub(crate) fn data(&self, length: usize) -> Ref<'_, [u8]> {
        Ref::map(self.data.borrow(), |data| &data[..length.min(DATA_BYTES)])
    }

    /// Wants a transfer.
    pub(crate) fn request(&self, request: Request) {
        self.request.set(Some(request));
        self.stir();
    }

    /// The way to endpoint 0 of a device behind this hub, if its translator's buffer is to be cleared.
    pub(crate) fn muddle_of(&self, hub: u8) -> Option<Way> {
        self.muddle.get().filter(|way| way.split.is_some_and(|split| split.hub_addr() == hub))
    }

    /// Says that it was cleared.
    pub(crate) fn set_clear(&self) {
        self.muddle.set(None);
        self.stir();
    }

    pub(crate) fn take_answer(&self) -> Option<Outcome> {
        self.answer.take()
    }

    /// Wants the packets of an endpoint.
    pub(crate) fn listen(&self, way: Way) {
        self.listening.set(Some(way));
    }

    /// What has come of an endpoint that is listened to: the length of [`packet`](Self::packet). No more comes
    /// until [`go_on`](Self::go_on).
    pub(crate) fn arrival(&self) -> Option<Outcome> {
        self.arrival.get()
    }

    pub(crate) fn packet(&self, length: usize) -> Ref<'_, [u8]> {
        Ref::map(self.packet.borrow(), |packet| &packet[..length.min(packet.len())])
    }

    /// Wants the next packet; `restart` if the endpoint's toggle is DATA0 again.
    pub(crate) fn go_on(&self, restart: bool) {
        self.restart.set(restart);
        self.arrival.set(None);
        self.stir();
    }
}

/// What the carriers see of it.
impl Mailbox {
    /// Waits until it is open, or closed.
    pub(crate) async fn until_open(&self, open: bool) {
        poll_fn(|_| if self.open.get() == open { Poll::Ready(()) } else { Poll::Pending }).await;
    }

    /// Waits for a request, and until no transfer before has left anything behind in the translator on its way.
    pub(crate) async fn next_request(&self) -> Request {
        poll_fn(|_| self.take_request().map_or(Poll::Pending, Poll::Ready)).await
    }

    #[inline(never)]
    fn take_request(&self) -> Option<Request> {
        let split = self.request.get()?.way.split;
        if split.is_some_and(|split| self.muddle_of(split.hub_addr()).is_some()) {
            return None;
        }
        self.request.take()
    }

    /// The bytes that go out, or come in.
    pub(crate) fn data_mut(&self, length: usize) -> RefMut<'_, [u8]> {
        RefMut::map(self.data.borrow_mut(), |data| &mut data[..length.min(DATA_BYTES)])
    }

    /// Says that a transfer by this way went wrong.
    pub(crate) fn set_muddle(&self, way: Way) {
        if way.split.is_some() {
            self.muddle.set(Some(way));
        }
        self.stir();
    }

    pub(crate) fn put_answer(&self, answer: Outcome) {
        self.answer.set(Some(answer));
        self.stir();
    }

    pub(crate) async fn next_listening(&self) -> Way {
        poll_fn(|_| self.listening.take().map_or(Poll::Pending, Poll::Ready)).await
    }

    pub(crate) fn packet_mut(&self, length: u16) -> RefMut<'_, [u8]> {
        RefMut::map(self.packet.borrow_mut(), |packet| {
            let length = usize::from(length).min(packet.len());
            &mut packet[..length]
        })
    }

    /// Hands a packet over, and waits until the next is wanted; tells whether the toggle is DATA0 again.
    pub(crate) async fn put_packet(&self, arrival: Outcome) -> bool {
        self.arrival.set(Some(arrival));
        self.stir();
        poll_fn(|_| if self.arrival.get().is_none() { Poll::Ready(()) } else { Poll::Pending }).await;
        self.restart.take()
    }
}
