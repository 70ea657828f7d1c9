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
/// - A bulk transfer is tried as long as the device answers NAK.
/// - `request_in` on an interrupt pipe returns one packet, the next that the device has; the endpoint is asked no more often than its
///   interval says, and only while somebody waits.
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

impl<'d> Watch<'d> {
    /// Waits until an earlier transfer that was cancelled has left its channel, and submits this one.
    async fn submit(&self, transfer: impl Fn(&mut State, &Endpoint) -> Transfer) -> Result<(), TransferError> {
        poll_fn(|context| self.driver.with(|state| state.submit(self.index, context, &transfer))).await
    }

    /// Waits until the transfer is over (true) or its buffer is the caller's (false).
    async fn turn(&self) -> Result<bool, TransferError> {
        poll_fn(|context| self.driver.with(|state| state.turn(self.index, context))).await
    }
}

/// A transfer from the device, with SETUP or without; the bytes that came.
async fn read<'d>(
    driver: &'d Dwc2<'d>,
    index: usize,
    setup: Option<&[u8; 8]>,
    buffer: &mut [u8],
) -> Result<usize, TransferError> {
    let watch = Watch { driver, index };
    let total = setup.map_or(buffer.len(), |setup| buffer.len().min(length_of(setup)));
    watch
        .submit(|state, endpoint| match setup {
            Some(setup) => {
                state.hardware.copy_in(index, Buffer::Setup, setup);
                Transfer::control(endpoint, true, total)
            }
            None => Transfer::data(endpoint, true, total, false),
        })
        .await?;
    loop {
        let over = watch.turn().await?;
        let moved = driver.with(|state| state.take_bytes(index, buffer, over));
        if over {
            return Ok(moved);
        }
    }
}

/// A transfer to the device, with SETUP or without.
async fn write<'d>(
    driver: &'d Dwc2<'d>,
    index: usize,
    setup: Option<&[u8; 8]>,
    bytes: &[u8],
    zero_packet: bool,
) -> Result<(), TransferError> {
    let watch = Watch { driver, index };
    let total = setup.map_or(bytes.len(), |setup| bytes.len().min(length_of(setup)));
    watch
        .submit(|state, endpoint| {
            let transfer = match setup {
                Some(setup) => {
                    state.hardware.copy_in(index, Buffer::Setup, setup);
                    Transfer::control(endpoint, false, total)
                }
                None => Transfer::data(endpoint, false, total, zero_packet),
            };
            let (from, length) = transfer.span();
            state.hardware.copy_in(index, Buffer::Data(0), bytes.get(from..from + length).unwrap_or_default());
            transfer
        })
        .await?;
    while !watch.turn().await? {
        driver.with(|state| state.give_bytes(index, bytes));
    }
    Ok(())
}

/// A SETUP packet's wLength.
fn length_of(setup: &[u8; 8]) -> usize {
    usize::from(u16::from_le_bytes([setup[6], setup[7]]))
}

impl State<'_> {
    /// Takes a place for a pipe; see [`alloc_pipe`](embassy_usb_driver::host::UsbHostAllocator::alloc_pipe).
    pub(crate) fn allocate(
        &mut self,
        address: u8,
        info: &EndpointInfo,
        split: Option<SplitInfo>,
    ) -> Result<usize, HostError> {
        let Phase::Ready { speed } = self.phase else { return Err(HostError::NoSuchDevice) };
        let endpoint = Endpoint::new(speed, address, info, split)?;
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

    fn submit(
        &mut self,
        index: usize,
        context: &Context<'_>,
        make: &impl Fn(&mut State, &Endpoint) -> Transfer,
    ) -> Poll<Result<(), TransferError>> {
        let ready = matches!(self.phase, Phase::Ready { .. });
        let gone = Poll::Ready(Err(TransferError::Disconnected));
        let Some(slot) = &mut self.slots[index] else { return gone };
        if slot.stale || !ready {
            return gone;
        }
        if slot.busy() {
            slot.waker = Some(context.waker().clone());
            return Poll::Pending;
        }
        let endpoint = slot.endpoint;
        let transfer = make(self, &endpoint);
        let now = self.hardware.now();
        if let Some(slot) = &mut self.slots[index] {
            slot.effort = Effort::new(transfer);
            let from = if endpoint.periodic() { slot.next_turn.max(now) } else { now };
            slot.activity = Activity::Waiting { from };
        }
        self.launch(now);
        Poll::Ready(Ok(()))
    }

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

    /// Copies what came into the caller's buffer; the bytes of the transfer so far.
    fn take_bytes(&mut self, index: usize, buffer: &mut [u8], over: bool) -> usize {
        let Some(slot) = &mut self.slots[index] else { return 0 };
        let (from, length) = slot.effort.transfer.span();
        if let Some(part) = buffer.get_mut(from..from + length) {
            self.hardware.copy_out(index, Buffer::Data(0), part);
        }
        if !over {
            self.resume(index);
        }
        from + length
    }

    /// Copies the next bytes in.
    fn give_bytes(&mut self, index: usize, bytes: &[u8]) {
        let Some(slot) = &mut self.slots[index] else { return };
        let mut next = slot.effort.transfer;
        next.exchanged(&slot.endpoint);
        let (from, length) = next.span();
        self.hardware.copy_in(index, Buffer::Data(0), bytes.get(from..from + length).unwrap_or_default());
        self.resume(index);
    }

    /// The buffer is the core's again.
    fn resume(&mut self, index: usize) {
        let now = self.hardware.now();
        if let Some(slot) = &mut self.slots[index]
            && matches!(slot.activity, Activity::Exchange)
        {
            slot.effort.transfer.exchanged(&slot.endpoint);
            slot.touch(now);
            slot.activity = Activity::Waiting { from: now };
        }
        self.launch(now);
    }
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
        let result = read(self.driver, self.index, Some(setup), buffer).await;
        self.note(result)
    }

    async fn control_out(&mut self, setup: &[u8; 8], bytes: &[u8]) -> Result<(), PipeError>
    where
        T: pipe::IsControl,
        D: pipe::IsOut,
    {
        let result = write(self.driver, self.index, Some(setup), bytes, false).await;
        self.note(result)
    }

    async fn request_in(&mut self, buffer: &mut [u8]) -> Result<usize, PipeError>
    where
        D: pipe::IsIn,
    {
        let result = read(self.driver, self.index, None, buffer).await;
        self.note(result)
    }

    async fn request_out(&mut self, bytes: &[u8], ensure_transaction_end: bool) -> Result<(), PipeError>
    where
        D: pipe::IsOut,
    {
        let result = write(self.driver, self.index, None, bytes, ensure_transaction_end).await;
        self.note(result)
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
            }
        });
    }
}
