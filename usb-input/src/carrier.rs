//! Those who carry what is to be said to the controller: all that depends on its type.

use core::convert::Infallible;
use core::future::{Future, pending, poll_fn};
use core::task::Poll;
use core::time::Duration;

use embassy_futures::select::{Either, select};
use embassy_usb_driver::host::{
    HostError, PipeError, TimeoutConfig, UsbHostAllocator, UsbHostController, UsbPipe, pipe,
};
use embassy_usb_driver::{Direction, EndpointAddress, EndpointInfo, EndpointType};

use crate::Memory;
use crate::mailbox::{Mailbox, Outcome, Request, TransferError, Way};
use crate::root::Root;
use crate::slots::SlotIndex;
use crate::timing::Wait;

/// How often a control transfer that was garbled on the way is sent.
const TRIES: u32 = 3;
const STAGE_TIMEOUT: Duration = Duration::from_micros(Wait::STAGE_TIMEOUT.microseconds());

/// Carries between one slot's mailbox and the controller, for one device after the other.
pub(crate) async fn slot<'d, A: UsbHostAllocator<'d>>(memory: &Memory, allocator: &A, slot: SlotIndex) -> Infallible {
    let mailbox = memory.mailbox(slot);
    loop {
        mailbox.until_open(true).await;
        let carried = select(transfers(memory, allocator, mailbox), packets(memory, allocator, mailbox));
        select(carried, mailbox.until_open(false)).await;
    }
}

/// Carries between the root port and the controller.
pub(crate) async fn root_port<'d, C: UsbHostController<'d>>(root: &Root, mut controller: C) -> Infallible {
    loop {
        match select(controller.wait_for_device_event(), root.reset_wanted()).await {
            Either::First(event) => root.put_event(event).await,
            Either::Second(()) => {
                controller.bus_reset().await;
                root.reset_done();
            }
        }
    }
}

/// Carries out the transfers that are wanted, one after the other.
#[expect(clippy::await_holding_refcell_ref, reason = "nobody else takes the data while a transfer is under way")]
async fn transfers<'d, A: UsbHostAllocator<'d>>(memory: &Memory, allocator: &A, mailbox: &Mailbox) -> Infallible {
    let mut tries = 0;
    loop {
        let request = mailbox.next_request().await;
        let answer = {
            let mut data = mailbox.data_mut(request.length.into());
            match select(transfer(allocator, mailbox, &request, &mut data), memory.sleep(request.limit())).await {
                Either::First(outcome) => outcome,
                Either::Second(()) => Err(TransferError::Pipe(PipeError::Timeout)),
            }
        };
        tries += 1;
        match answer {
            Err(TransferError::Pipe(PipeError::BadResponse | PipeError::DataToggleError | PipeError::Canceled))
                if request.setup.is_some() && tries < TRIES =>
            {
                mailbox.request(request);
            }
            answer => {
                tries = 0;
                mailbox.put_answer(answer.map(|count| count.min(request.length.into())));
            }
        }
    }
}

async fn transfer<'d, A: UsbHostAllocator<'d>>(
    allocator: &A,
    mailbox: &Mailbox,
    request: &Request,
    data: &mut [u8],
) -> Outcome {
    let Some(setup) = request.setup else {
        let mut pipe = take_pipe::<A, pipe::Interrupt, pipe::Out>(allocator, &request.way).await?;
        return pipe.request_out(data, false).await.map(|()| data.len()).map_err(TransferError::Pipe);
    };
    let mut pipe = take_pipe::<A, pipe::Control, pipe::InOut>(allocator, &request.way).await?;
    let mut timeout = TimeoutConfig::default();
    timeout.data_timeout = STAGE_TIMEOUT;
    timeout.no_data_timeout = STAGE_TIMEOUT;
    pipe.set_timeout(timeout);
    let packet = setup.bytes(request.length);
    let muddle = Muddle { mailbox, way: request.way };
    let outcome = if setup.reads() {
        pipe.control_in(&packet, data).await
    } else {
        pipe.control_out(&packet, data).await.map(|()| data.len())
    };
    if matches!(outcome, Ok(_) | Err(PipeError::Stall)) {
        core::mem::forget(muddle);
    }
    outcome.map_err(TransferError::Pipe)
}

/// What a transfer leaves behind that fails, or is dropped while it is under way.
struct Muddle<'a> {
    mailbox: &'a Mailbox,
    way: Way,
}

impl Drop for Muddle<'_> {
    fn drop(&mut self) {
        self.mailbox.set_muddle(self.way);
    }
}

/// Brings the packets of the endpoint that is listened to.
#[expect(clippy::await_holding_refcell_ref, reason = "nobody else takes the packet until it has arrived")]
async fn packets<'d, A: UsbHostAllocator<'d>>(memory: &Memory, allocator: &A, mailbox: &Mailbox) -> Infallible {
    let way = mailbox.next_listening().await;
    let pipe = take_pipe::<A, pipe::Interrupt, pipe::In>(allocator, &way);
    let error = match select(pipe, memory.sleep(Wait::STAGE_TIMEOUT)).await {
        Either::First(Ok(mut pipe)) => loop {
            // A slice of exactly one packet: it ends with that, whatever a controller makes of a longer one.
            let arrival = pipe.request_in(&mut mailbox.packet_mut(way.packet)).await;
            if mailbox.put_packet(arrival.map_err(TransferError::Pipe)).await {
                pipe.reset_data_toggle();
            }
        },
        Either::First(Err(error)) => error,
        Either::Second(()) => TransferError::NoPipe,
    };
    mailbox.put_packet(Err(error)).await;
    pending().await
}

/// Takes a pipe to an endpoint, waiting for one as long as the caller waits.
fn take_pipe<'d, A: UsbHostAllocator<'d>, T: pipe::Type, D: pipe::Direction>(
    allocator: &A,
    way: &Way,
) -> impl Future<Output = Result<A::Pipe<T, D>, TransferError>> {
    let endpoint = EndpointInfo {
        addr: EndpointAddress::from_parts(way.endpoint.into(), if D::is_in() { Direction::In } else { Direction::Out }),
        ep_type: if way.endpoint == 0 { EndpointType::Control } else { EndpointType::Interrupt },
        max_packet_size: way.packet,
        interval_ms: way.interval_ms,
    };
    poll_fn(move |_| match allocator.alloc_pipe::<T, D>(way.address, &endpoint, way.split) {
        Ok(pipe) => Poll::Ready(Ok(pipe)),
        Err(HostError::OutOfPipes) => Poll::Pending,
        Err(HostError::PipeError(error)) => Poll::Ready(Err(TransferError::Pipe(error))),
        Err(_) => Poll::Ready(Err(TransferError::NoPipe)),
    })
}
