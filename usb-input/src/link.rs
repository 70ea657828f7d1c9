//! One device, as those who talk to it see it: control transfers and pipes.

use core::future::poll_fn;
use core::task::Poll;

use embassy_futures::yield_now;
use embassy_usb_driver::host::{HostError, PipeError, TimeoutConfig, UsbHostAllocator, UsbPipe, pipe};
use embassy_usb_driver::{Direction, EndpointAddress, EndpointInfo, EndpointType};

use crate::bus::Bus;
use crate::descriptor::Endpoint;
use crate::route::Route;
use crate::setup::Setup;
use crate::slots::SlotIndex;
use crate::timing::{CONTROL_TIMEOUT_US, STAGE_TIMEOUT_US};
use crate::{Clock, Fault, Step};

/// How often a control transfer that was garbled on the way is sent.
const TRIES: u32 = 3;

/// A device, reached at an address.
pub(crate) struct Link<'b, A, K> {
    pub(crate) bus: &'b Bus<'b, A, K>,
    pub(crate) slot: SlotIndex,
    pub(crate) route: Route,
    /// 0 until the device has its own.
    pub(crate) address: u8,
    /// Bytes in a packet of endpoint 0.
    pub(crate) packet: u16,
}

impl<A, K> Clone for Link<'_, A, K> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<A, K> Copy for Link<'_, A, K> {}

/// The data stage of a control transfer.
enum Data<'a> {
    In(&'a mut [u8]),
    Out(&'a [u8]),
}

impl<'d, A: UsbHostAllocator<'d>, K: Clock> Link<'_, A, K> {
    /// Reads by a control transfer; returns how many bytes came.
    pub(crate) async fn read(&self, doing: Step, setup: Setup, buffer: &mut [u8]) -> Result<usize, Fault> {
        self.transfer(doing, setup, Data::In(buffer)).await
    }

    /// Writes by a control transfer.
    pub(crate) async fn write(&self, doing: Step, setup: Setup, data: &[u8]) -> Result<(), Fault> {
        self.transfer(doing, setup, Data::Out(data)).await.map(drop)
    }

    async fn transfer(&self, doing: Step, setup: Setup, data: Data<'_>) -> Result<usize, Fault> {
        let length = match &data {
            Data::In(buffer) => buffer.len(),
            Data::Out(bytes) => bytes.len(),
        };
        let packets = length.div_ceil(usize::from(self.packet)).max(1) as u64;
        let limit_us = CONTROL_TIMEOUT_US.min(packets * STAGE_TIMEOUT_US);
        let packet = setup.bytes(length as u16);
        let result = self.bus.within(limit_us, self.attempt(&packet, data)).await;
        // One transfer a poll.
        yield_now().await;
        match result {
            Some(Ok(count)) => Ok(count.min(length)),
            Some(Err(Refusal::NoPipe)) => Err(Fault::NoPipe),
            Some(Err(Refusal::Pipe(error))) => Err(Fault::Transfer { doing, error }),
            None => Err(Fault::Transfer { doing, error: PipeError::Timeout }),
        }
    }

    async fn attempt(&self, packet: &[u8; 8], mut data: Data<'_>) -> Result<usize, Refusal> {
        let endpoint = EndpointInfo {
            addr: EndpointAddress::from_parts(0, Direction::In),
            ep_type: EndpointType::Control,
            max_packet_size: self.packet,
            interval_ms: 0,
        };
        let mut pipe = self.pipe::<pipe::Control, pipe::InOut>(&endpoint).await?;
        let mut timeout = TimeoutConfig::default();
        timeout.data_timeout = core::time::Duration::from_micros(STAGE_TIMEOUT_US);
        timeout.no_data_timeout = core::time::Duration::from_micros(STAGE_TIMEOUT_US);
        pipe.set_timeout(timeout);
        let mut tries = 1;
        loop {
            let result = match &mut data {
                Data::In(buffer) => pipe.control_in(packet, buffer).await,
                Data::Out(bytes) => pipe.control_out(packet, bytes).await.map(|()| bytes.len()),
            };
            match result {
                Err(PipeError::BadResponse | PipeError::DataToggleError | PipeError::Canceled) if tries < TRIES => {
                    tries += 1;
                }
                other => return other.map_err(Refusal::Pipe),
            }
        }
    }

    /// Takes a pipe to an endpoint, waiting for one as long as the caller waits.
    async fn pipe<T: pipe::Type, D: pipe::Direction>(&self, endpoint: &EndpointInfo) -> Result<A::Pipe<T, D>, Refusal> {
        poll_fn(|_| match self.bus.allocator.alloc_pipe::<T, D>(self.address, endpoint, self.route.split) {
            Ok(pipe) => Poll::Ready(Ok(pipe)),
            Err(HostError::OutOfPipes) => Poll::Pending,
            Err(HostError::PipeError(error)) => Poll::Ready(Err(Refusal::Pipe(error))),
            Err(_) => Poll::Ready(Err(Refusal::NoPipe)),
        })
        .await
    }

    /// Takes a pipe to an interrupt endpoint, waiting half a second for one.
    pub(crate) async fn interrupt_pipe<D: pipe::Direction>(
        &self,
        doing: Step,
        endpoint: Endpoint,
    ) -> Result<A::Pipe<pipe::Interrupt, D>, Fault> {
        let direction = if D::is_in() { Direction::In } else { Direction::Out };
        let info = EndpointInfo {
            addr: EndpointAddress::from_parts(usize::from(endpoint.number), direction),
            ep_type: EndpointType::Interrupt,
            max_packet_size: endpoint.packet,
            interval_ms: endpoint.interval_ms(self.route.speed),
        };
        match self.bus.within(STAGE_TIMEOUT_US, self.pipe(&info)).await {
            Some(Ok(pipe)) => Ok(pipe),
            Some(Err(Refusal::Pipe(error))) => Err(Fault::Transfer { doing, error }),
            Some(Err(Refusal::NoPipe)) | None => Err(Fault::NoPipe),
        }
    }
}

/// Why there was no transfer.
enum Refusal {
    Pipe(PipeError),
    NoPipe,
}
