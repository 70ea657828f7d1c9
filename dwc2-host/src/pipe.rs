//! A pipe: transfers to one endpoint of one device.

use core::future::poll_fn;
use core::marker::PhantomData;
use core::task::{Context, Poll};

use embassy_usb_driver::EndpointInfo;
use embassy_usb_driver::host::{HostError, PipeError, SplitInfo, TimeoutConfig, UsbPipe, pipe};

use crate::endpoint::Endpoint;
use crate::hardware::Buffer;
use crate::port::Phase;
use crate::slot::{Activity, Effort, Fate, Slot};
use crate::state::State;
use crate::transfer::Transfer;
use crate::{Dwc2, TransferError};

/// Transfers to one endpoint. Dropping it aborts what is under way and gives its place back.
///
/// - A control transfer fails with `Timeout` when it has not moved for the time given to
///   [`set_timeout`](UsbPipe::set_timeout) (USB 2.0 §9.2.6.4: 500 ms with data, 50 ms without, to begin with).
/// - A control transfer's bytes must cover its wLength, else it fails with `BufferOverflow` before it begins.
/// - A bulk transfer is tried as long as the device answers NAK.
/// - `request_in` on an interrupt pipe returns one packet, the next that the device has; the endpoint is asked no more often than its
///   interval says, and only while somebody waits. A packet that comes while the request is being dropped is the next
///   request's.
/// - Three strikes in a row (no answer, or a broken one) end a transfer with `BadResponse`.
pub struct Pipe<'d, T: pipe::Type, D: pipe::Direction> {
    driver: &'d Dwc2<'d>,
    index: usize,
    last_error: Option<TransferError>,
    _kind: PhantomData<(T, D)>,
}

/// Cancels a transfer that its caller does not wait for any more.
struct Watch<'d> {
    driver: &'d Dwc2<'d>,
    index: usize,
}

impl Drop for Watch<'_> {
    fn drop(&mut self) {
        self.driver.with(|state| {
            let now = state.hardware.now();
            state.abandon(self.index, Fate::Cancelled, now);
        });
    }
}

/// The caller's bytes.
enum Data<'b> {
    /// To be filled by the device.
    In(&'b mut [u8]),
    /// For the device, and whether a full last packet is followed by an empty one.
    Out(&'b [u8], bool),
}

impl Data<'_> {
    fn length(&self) -> usize {
        match self {
            Self::In(bytes) => bytes.len(),
            Self::Out(bytes, _) => bytes.len(),
        }
    }
}

/// A transfer, with SETUP or without; the bytes that moved.
async fn transfer<'d>(
    driver: &'d Dwc2<'d>,
    index: usize,
    setup: Option<&[u8; 8]>,
    mut data: Data<'_>,
) -> Result<usize, TransferError> {
    let watch = Watch { driver, index };
    let total = data_length(setup, data.length())?;
    let request = Request { setup, total };
    poll_fn(|context| watch.driver.with(|state| state.submit(index, context, request, &data))).await?;
    loop {
        let over = poll_fn(|context| watch.driver.with(|state| state.turn(index, context))).await?;
        let moved = watch.driver.with(|state| state.exchange(index, &mut data, over));
        if over {
            return Ok(moved);
        }
    }
}

/// What a transfer is to do.
#[derive(Clone, Copy)]
struct Request<'s> {
    setup: Option<&'s [u8; 8]>,
    /// Bytes of data.
    total: usize,
}

/// Bytes of the data stage: a SETUP packet's wLength, which the caller's bytes have to cover, or all of those.
fn data_length(setup: Option<&[u8; 8]>, bytes: usize) -> Result<usize, TransferError> {
    let Some(setup) = setup else { return Ok(bytes) };
    let length = usize::from(u16::from_le_bytes([setup[6], setup[7]]));
    if length > bytes { Err(TransferError::BufferOverflow) } else { Ok(length) }
}

impl State<'_> {
    /// Takes a place for a pipe; see [`alloc_pipe`](embassy_usb_driver::host::UsbHostAllocator::alloc_pipe).
    pub(crate) fn allocate(
        &mut self,
        address: u8,
        info: &EndpointInfo,
        split: Option<SplitInfo>,
    ) -> Result<usize, HostError> {
        if self.phase != Phase::Ready {
            return Err(HostError::NoSuchDevice);
        }
        let endpoint = Endpoint::new(self.speed, address, info, split)?;
        let index = self.slots.iter().position(Option::is_none).ok_or(HostError::OutOfPipes)?;
        self.slots[index] = Some(Slot::new(endpoint));
        Ok(index)
    }

    fn release(&mut self, index: usize) {
        let now = self.hardware.now();
        self.abandon(index, Fate::Cancelled, now);
        if let Some(slot) = &mut self.slots[index] {
            slot.orphan = true;
            slot.waker = None;
            if !slot.busy() {
                self.slots[index] = None;
            }
        }
    }

    /// Waits until an earlier transfer that was cancelled has left its channel, and submits this one.
    fn submit(
        &mut self,
        index: usize,
        context: &Context<'_>,
        request: Request<'_>,
        data: &Data<'_>,
    ) -> Poll<Result<(), TransferError>> {
        let gone = Poll::Ready(Err(TransferError::Disconnected));
        let Some(slot) = &mut self.slots[index] else { return gone };
        if slot.stale || self.phase != Phase::Ready {
            return gone;
        }
        if slot.busy() {
            slot.waker = Some(context.waker().clone());
            return Poll::Pending;
        }
        let (input, zero_packet) = match data {
            Data::In(_) => (true, false),
            Data::Out(_, zero_packet) => (false, *zero_packet),
        };
        let mut transfer = Transfer::data(&slot.endpoint, input, request.total, zero_packet);
        if let Some(setup) = request.setup {
            transfer = transfer.with_setup();
            self.hardware.copy_in(index, Buffer::Setup, setup);
        }
        if let Data::Out(bytes, _) = data {
            self.hardware.copy_in(index, Buffer::Data(0), part(bytes, transfer.span()));
        }
        let now = self.hardware.now();
        slot.effort = Effort::new(transfer);
        slot.activity = match slot.activity {
            Activity::Kept(length) => Activity::Done(slot.effort.transfer.take_kept(length)),
            _ if slot.endpoint.periodic() => Activity::Waiting { from: slot.next_turn.max(now) },
            _ => Activity::Waiting { from: now },
        };
        self.call_turns(now);
        self.launch(now);
        Poll::Ready(Ok(()))
    }

    /// Waits until the transfer is over (true) or its buffer is the caller's (false).
    fn turn(&mut self, index: usize, context: &Context<'_>) -> Poll<Result<bool, TransferError>> {
        let Some(slot) = &mut self.slots[index] else { return Poll::Ready(Err(TransferError::Disconnected)) };
        match slot.activity {
            Activity::Done(result) => Poll::Ready(result.map(|_| true)),
            Activity::Exchange => Poll::Ready(Ok(false)),
            _ => {
                slot.waker = Some(context.waker().clone());
                Poll::Pending
            }
        }
    }

    /// Empties the buffer into the caller's bytes, or fills it with the next of them; the bytes of the transfer so far.
    fn exchange(&mut self, index: usize, data: &mut Data<'_>, over: bool) -> usize {
        let Some(slot) = &mut self.slots[index] else { return 0 };
        let transfer = &mut slot.effort.transfer;
        let (from, length) = transfer.span();
        if let Data::In(bytes) = data
            && let Some(bytes) = bytes.get_mut(from..from + length)
        {
            self.hardware.copy_out(index, Buffer::Data(0), bytes);
        }
        // The device may have gone since its turn was the caller's.
        if over || !matches!(slot.activity, Activity::Exchange) {
            return from + length;
        }
        transfer.exchanged(&slot.endpoint);
        if let Data::Out(bytes, _) = data {
            self.hardware.copy_in(index, Buffer::Data(0), part(bytes, transfer.span()));
        }
        let now = self.hardware.now();
        slot.touch(now);
        slot.activity = Activity::Waiting { from: now };
        self.launch(now);
        from + length
    }
}

/// The bytes of a span; none where it is not inside.
fn part(bytes: &[u8], (from, length): (usize, usize)) -> &[u8] {
    bytes.get(from..from + length).unwrap_or_default()
}

impl<'d, T: pipe::Type, D: pipe::Direction> Pipe<'d, T, D> {
    pub(crate) fn new(driver: &'d Dwc2<'d>, index: usize) -> Self {
        let mut pipe = Self { driver, index, last_error: None, _kind: PhantomData };
        pipe.set_limits(TimeoutConfig::default());
        pipe
    }

    fn set_limits(&mut self, timeout: TimeoutConfig) {
        self.driver.with(|state| {
            if let Some(slot) = &mut state.slots[self.index] {
                slot.timeouts = (timeout.data_timeout.as_micros() as u64, timeout.no_data_timeout.as_micros() as u64);
            }
        });
    }

    /// How the last transfer failed; `None` after one that did not.
    pub fn last_error(&self) -> Option<TransferError> {
        self.last_error
    }

    fn note<R>(&mut self, result: Result<R, TransferError>) -> Result<R, PipeError> {
        self.last_error = result.as_ref().err().copied();
        result.map_err(PipeError::from)
    }
}

impl<T: pipe::Type, D: pipe::Direction> Drop for Pipe<'_, T, D> {
    fn drop(&mut self) {
        self.driver.with(|state| state.release(self.index));
    }
}

impl<T: pipe::Type, D: pipe::Direction> UsbPipe<T, D> for Pipe<'_, T, D> {
    async fn control_in(&mut self, setup: &[u8; 8], buffer: &mut [u8]) -> Result<usize, PipeError>
    where
        T: pipe::IsControl,
        D: pipe::IsIn,
    {
        let result = transfer(self.driver, self.index, Some(setup), Data::In(buffer)).await;
        self.note(result)
    }

    async fn control_out(&mut self, setup: &[u8; 8], bytes: &[u8]) -> Result<(), PipeError>
    where
        T: pipe::IsControl,
        D: pipe::IsOut,
    {
        let result = transfer(self.driver, self.index, Some(setup), Data::Out(bytes, false)).await;
        self.note(result).map(drop)
    }

    async fn request_in(&mut self, buffer: &mut [u8]) -> Result<usize, PipeError>
    where
        D: pipe::IsIn,
    {
        let result = transfer(self.driver, self.index, None, Data::In(buffer)).await;
        self.note(result)
    }

    async fn request_out(&mut self, bytes: &[u8], ensure_transaction_end: bool) -> Result<(), PipeError>
    where
        D: pipe::IsOut,
    {
        let result = transfer(self.driver, self.index, None, Data::Out(bytes, ensure_transaction_end)).await;
        self.note(result).map(drop)
    }

    fn set_timeout(&mut self, timeout: TimeoutConfig)
    where
        T: pipe::IsControl,
    {
        self.set_limits(timeout);
    }

    fn reset_data_toggle(&mut self)
    where
        T: pipe::IsBulkOrInterrupt,
    {
        self.driver.with(|state| {
            if let Some(slot) = &mut state.slots[self.index] {
                slot.toggle = false;
                slot.ping = false;
                if let Activity::Kept(_) = slot.activity {
                    slot.activity = Activity::Idle;
                }
            }
        });
    }
}
