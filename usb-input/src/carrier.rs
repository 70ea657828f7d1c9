//! Those who carry what is to be said to the controller: all that depends on its type.

use core::convert::Infallible;
use core::future::poll_fn;
use core::pin::pin;
use core::task::Poll;
use core::time::Duration;

use embassy_futures::join::join;
use embassy_futures::select::{Either, select};
use embassy_usb_driver::host::{
    HostError, PipeError, TimeoutConfig, UsbHostAllocator, UsbHostController, UsbPipe, pipe,
};
use embassy_usb_driver::{Direction, EndpointAddress, EndpointInfo, EndpointType};

use crate::descriptor::Endpoint;
use crate::mailbox::{ListenError, Listening, Mailbox, Request, RequestKind};
use crate::route::Route;
use crate::slots::SlotIndex;
use crate::timing::{CONTROL_TIMEOUT_US, STAGE_TIMEOUT_US};
use crate::{Fault, Memory, device};

/// How often a control transfer that was garbled on the way is sent.
const TRIES: u32 = 3;
/// How often one poll goes round a device that has something to say.
const ROUNDS: u32 = 4;

/// Serves the devices that get a slot, for ever.
pub(crate) async fn slot<'d, A: UsbHostAllocator<'d>>(memory: &Memory, allocator: &A, slot: SlotIndex) -> Infallible {
    let mailbox = memory.mailbox(slot);
    loop {
        let route = memory.slots.ready(slot).await;
        mailbox.clear();
        let fault = {
            let mut talk = pin!(device::talk(memory, slot, route));
            let carrier = Carrier { memory, allocator, mailbox, route };
            let mut carriers = pin!(join(carrier.transfers(), carrier.packets()));
            poll_fn(|context| {
                for _ in 0..ROUNDS {
                    if memory.slots.is_leaving(slot) {
                        return Poll::Ready(None);
                    }
                    if let Poll::Ready(fault) = talk.as_mut().poll(context) {
                        return Poll::Ready(Some(fault));
                    }
                    let _ = carriers.as_mut().poll(context);
                    if !mailbox.take_stirred() {
                        break;
                    }
                }
                Poll::Pending
            })
            .await
        };
        device::farewell(memory, slot, route.place, fault).await;
    }
}

/// Carries between one device's mailbox and the controller.
struct Carrier<'m, A> {
    memory: &'m Memory,
    allocator: &'m A,
    mailbox: &'m Mailbox,
    route: Route,
}

impl<'d, A: UsbHostAllocator<'d>> Carrier<'_, A> {
    /// Carries out the transfers that are wanted, one after the other.
    #[expect(clippy::await_holding_refcell_ref, reason = "nobody else takes the data while a transfer is under way")]
    async fn transfers(&self) -> Infallible {
        loop {
            let request = self.mailbox.next_request().await;
            let result = {
                let mut data = self.mailbox.data_mut(request.length);
                let packets = data.len().div_ceil(usize::from(request.packet)).max(1) as u64;
                let limit_us = CONTROL_TIMEOUT_US.min(packets * STAGE_TIMEOUT_US);
                match select(self.transfer(&request, &mut data), self.memory.sleep(limit_us)).await {
                    Either::First(result) => result.map(|count| count.min(data.len())),
                    Either::Second(()) => Err(ListenError::Pipe(PipeError::Timeout)),
                }
            };
            self.mailbox.finish(result.map_err(|error| error.fault(request.doing)));
        }
    }

    async fn transfer(&self, request: &Request, data: &mut [u8]) -> Result<usize, ListenError> {
        match request.kind {
            RequestKind::Control(setup) => {
                let endpoint = EndpointInfo {
                    addr: EndpointAddress::from_parts(0, Direction::In),
                    ep_type: EndpointType::Control,
                    max_packet_size: request.packet,
                    interval_ms: 0,
                };
                let mut pipe = self.pipe::<pipe::Control, pipe::InOut>(request.address, &endpoint).await?;
                let mut timeout = TimeoutConfig::default();
                timeout.data_timeout = Duration::from_micros(STAGE_TIMEOUT_US);
                timeout.no_data_timeout = Duration::from_micros(STAGE_TIMEOUT_US);
                pipe.set_timeout(timeout);
                let packet = setup.bytes(request.length);
                let mut tries = 1;
                loop {
                    let result = if setup.reads() {
                        pipe.control_in(&packet, data).await
                    } else {
                        pipe.control_out(&packet, data).await.map(|()| data.len())
                    };
                    match result {
                        Err(PipeError::BadResponse | PipeError::DataToggleError | PipeError::Canceled)
                            if tries < TRIES =>
                        {
                            tries += 1;
                        }
                        other => return other.map_err(ListenError::Pipe),
                    }
                }
            }
            RequestKind::Out(endpoint) => {
                let info = self.interrupt(endpoint, Direction::Out);
                let mut pipe = self.pipe::<pipe::Interrupt, pipe::Out>(request.address, &info).await?;
                let result = pipe.request_out(data, false).await;
                result.map(|()| data.len()).map_err(ListenError::Pipe)
            }
        }
    }

    /// Brings the packets of the endpoint that is listened to.
    async fn packets(&self) -> Infallible {
        let Listening { address, endpoint } = self.mailbox.next_listening().await;
        let info = self.interrupt(endpoint, Direction::In);
        let pipe = self.pipe::<pipe::Interrupt, pipe::In>(address, &info);
        let error = match select(pipe, self.memory.sleep(STAGE_TIMEOUT_US)).await {
            Either::First(Ok(pipe)) => self.bring(pipe, endpoint.packet).await,
            Either::First(Err(error)) => error,
            Either::Second(()) => ListenError::NoPipe,
        };
        loop {
            self.mailbox.arrive(Err(error));
            self.mailbox.packet_taken().await;
        }
    }

    #[expect(clippy::await_holding_refcell_ref, reason = "nobody else takes the packet until it has arrived")]
    async fn bring<P: UsbPipe<pipe::Interrupt, pipe::In>>(&self, mut pipe: P, length: u16) -> ListenError {
        loop {
            // A slice of exactly one packet: it ends with that, whatever a controller makes of a longer one.
            let arrival = {
                let mut packet = self.mailbox.packet_mut(length);
                pipe.request_in(&mut packet).await
            };
            self.mailbox.arrive(arrival.map_err(ListenError::Pipe));
            if self.mailbox.packet_taken().await {
                pipe.reset_data_toggle();
            }
        }
    }

    fn interrupt(&self, endpoint: Endpoint, direction: Direction) -> EndpointInfo {
        EndpointInfo {
            addr: EndpointAddress::from_parts(usize::from(endpoint.number), direction),
            ep_type: EndpointType::Interrupt,
            max_packet_size: endpoint.packet,
            interval_ms: endpoint.interval_ms(self.route.speed),
        }
    }

    /// Takes a pipe to an endpoint, waiting for one as long as the caller waits.
    async fn pipe<T: pipe::Type, D: pipe::Direction>(
        &self,
        address: u8,
        endpoint: &EndpointInfo,
    ) -> Result<A::Pipe<T, D>, ListenError> {
        poll_fn(|_| match self.allocator.alloc_pipe::<T, D>(address, endpoint, self.route.split) {
            Ok(pipe) => Poll::Ready(Ok(pipe)),
            Err(HostError::OutOfPipes) => Poll::Pending,
            Err(HostError::PipeError(error)) => Poll::Ready(Err(ListenError::Pipe(error))),
            Err(_) => Poll::Ready(Err(ListenError::NoPipe)),
        })
        .await
    }
}

/// Carries between the root port's logic and the controller.
pub(crate) async fn root_port<'d, C: UsbHostController<'d>>(memory: &Memory, mut controller: C) -> Infallible {
    let root = &memory.root;
    loop {
        match select(controller.wait_for_device_event(), root.reset_wanted()).await {
            Either::First(event) => root.put_event(event),
            Either::Second(()) => {
                controller.bus_reset().await;
                root.reset_done();
            }
        }
        root.event_taken().await;
    }
}

impl ListenError {
    /// Says what was being done.
    pub(crate) const fn fault(self, doing: crate::Step) -> Fault {
        match self {
            Self::NoPipe => Fault::NoPipe,
            Self::Pipe(error) => Fault::Transfer { doing, error },
        }
    }
}
