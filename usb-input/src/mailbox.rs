//! Between those who know what to say to a device and those who carry it to the controller.
//!
//! What to say does not depend on the controller's type, and so is compiled once, for size; the carriers
//! ([`carrier`](crate::carrier)) do, and are as little as can be.

use core::cell::{Cell, Ref, RefCell, RefMut};
use core::future::poll_fn;
use core::pin::Pin;
use core::task::{Context, Poll};

use embassy_usb_driver::host::PipeError;

use crate::Fault;
use crate::descriptor::{Endpoint, PACKET_MAXIMUM};
use crate::fault::Step;
use crate::setup::Setup;

/// Bytes of the longest transfer on endpoint 0; what a descriptor has beyond is not seen.
pub(crate) const DATA_BYTES: usize = 512;

/// A transfer that is wanted.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Request {
    /// The device's address, and bytes in a packet of its endpoint 0.
    pub(crate) address: u8,
    pub(crate) packet: u16,
    pub(crate) doing: Step,
    pub(crate) kind: RequestKind,
    /// Bytes of the mailbox's data that go out, or that there is room for.
    pub(crate) length: u16,
}

/// What transfer it is.
#[derive(Debug, Clone, Copy)]
pub(crate) enum RequestKind {
    Control(Setup),
    /// To an interrupt endpoint.
    Out(Endpoint),
}

/// The endpoint that is listened to.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Listening {
    pub(crate) address: u8,
    pub(crate) endpoint: Endpoint,
}

/// A packet that came from the endpoint that is listened to, or why none did.
pub(crate) type Arrival = Result<usize, ListenError>;

/// Why no packet came.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ListenError {
    NoPipe,
    Pipe(PipeError),
}

/// One device's mailbox.
#[derive(Debug)]
pub(crate) struct Mailbox {
    request: Cell<Option<Request>>,
    /// A transfer is wanted or under way.
    busy: Cell<bool>,
    answer: Cell<Option<Result<usize, Fault>>>,
    data: RefCell<[u8; DATA_BYTES]>,
    listening: Cell<Option<Listening>>,
    arrival: Cell<Option<Arrival>>,
    packet: RefCell<[u8; PACKET_MAXIMUM as usize]>,
    restart: Cell<bool>,
    /// Something was put in or taken out.
    stirred: Cell<bool>,
}

impl Mailbox {
    pub(crate) const fn new() -> Self {
        Self {
            request: Cell::new(None),
            busy: Cell::new(false),
            answer: Cell::new(None),
            data: RefCell::new([0; DATA_BYTES]),
            listening: Cell::new(None),
            arrival: Cell::new(None),
            packet: RefCell::new([0; PACKET_MAXIMUM as usize]),
            restart: Cell::new(false),
            stirred: Cell::new(false),
        }
    }

    /// Empties it for a new device.
    pub(crate) fn clear(&self) {
        self.request.set(None);
        self.busy.set(false);
        self.answer.set(None);
        self.listening.set(None);
        self.arrival.set(None);
        self.restart.set(false);
    }

    /// Tells whether something was put in or taken out since it was asked last.
    pub(crate) fn take_stirred(&self) -> bool {
        self.stirred.take()
    }

    /// Puts bytes where a transfer takes them from. Not while one is under way.
    pub(crate) fn put_data(&self, bytes: &[u8]) {
        if let Some(place) = self.data.borrow_mut().get_mut(..bytes.len()) {
            place.copy_from_slice(bytes);
        }
    }

    /// The first so many of the bytes that a transfer brought.
    pub(crate) fn data(&self, length: usize) -> Ref<'_, [u8]> {
        Ref::map(self.data.borrow(), |data| &data[..length.min(data.len())])
    }

    /// Asks for packets from an endpoint.
    pub(crate) fn listen(&self, listening: Listening) {
        self.listening.set(Some(listening));
    }

    /// Waits for the next packet; its bytes go to `take`. After an error, [`resume`](Self::resume) asks for more.
    pub(crate) async fn packet<T>(&self, take: impl FnOnce(&[u8]) -> T) -> Result<T, ListenError> {
        let arrival = poll_fn(|_| self.arrival.get().map_or(Poll::Pending, Poll::Ready)).await;
        let taken = arrival.map(|length| {
            let packet = self.packet.borrow();
            take(&packet[..length.min(packet.len())])
        });
        if taken.is_ok() {
            self.take_arrival();
        }
        taken
    }

    fn take_arrival(&self) {
        self.arrival.set(None);
        self.stirred.set(true);
    }

    /// Goes on after an error; `restart` if the endpoint's toggle is DATA0 again.
    pub(crate) fn resume(&self, restart: bool) {
        self.restart.set(restart);
        self.take_arrival();
    }
}

/// What the carriers see of it.
impl Mailbox {
    /// Waits for a transfer that is wanted; it counts as under way until [`finish`](Self::finish).
    pub(crate) async fn next_request(&self) -> Request {
        poll_fn(|_| self.request.take().map_or(Poll::Pending, Poll::Ready)).await
    }

    /// The bytes that go out, or come in.
    pub(crate) fn data_mut(&self, length: u16) -> RefMut<'_, [u8]> {
        RefMut::map(self.data.borrow_mut(), |data| {
            let length = usize::from(length).min(data.len());
            &mut data[..length]
        })
    }

    pub(crate) fn finish(&self, answer: Result<usize, Fault>) {
        self.busy.set(false);
        self.answer.set(Some(answer));
        self.stirred.set(true);
    }

    /// Waits until somebody wants packets.
    pub(crate) async fn next_listening(&self) -> Listening {
        poll_fn(|_| self.listening.take().map_or(Poll::Pending, Poll::Ready)).await
    }

    /// Waits until the last packet was taken; tells whether the toggle is DATA0 again.
    pub(crate) async fn packet_taken(&self) -> bool {
        poll_fn(|_| if self.arrival.get().is_none() { Poll::Ready(()) } else { Poll::Pending }).await;
        self.restart.take()
    }

    pub(crate) fn packet_mut(&self, length: u16) -> RefMut<'_, [u8]> {
        RefMut::map(self.packet.borrow_mut(), |packet| {
            let length = usize::from(length).min(packet.len());
            &mut packet[..length]
        })
    }

    pub(crate) fn arrive(&self, arrival: Arrival) {
        self.arrival.set(Some(arrival));
        self.stirred.set(true);
    }
}

/// A transfer, from the wish to its end. One that is dropped is carried out nevertheless, and the next waits for it.
pub(crate) struct Transfer<'m> {
    mailbox: &'m Mailbox,
    request: Option<Request>,
    data: &'m [u8],
}

impl<'m> Transfer<'m> {
    pub(crate) const fn new(mailbox: &'m Mailbox, request: Request, data: &'m [u8]) -> Self {
        Self { mailbox, request: Some(request), data }
    }
}

impl Future for Transfer<'_> {
    type Output = Result<usize, Fault>;

    #[inline(never)]
    fn poll(mut self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<Self::Output> {
        let mailbox = self.mailbox;
        if mailbox.busy.get() {
            return Poll::Pending;
        }
        match self.request.take() {
            None => mailbox.answer.take().map_or(Poll::Pending, Poll::Ready),
            Some(request) => {
                mailbox.put_data(self.data);
                mailbox.answer.set(None);
                mailbox.busy.set(true);
                mailbox.request.set(Some(request));
                mailbox.stirred.set(true);
                Poll::Pending
            }
        }
    }
}
