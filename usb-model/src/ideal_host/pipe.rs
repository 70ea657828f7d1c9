//! A pipe of the ideal host.

use std::marker::PhantomData;
use std::rc::Rc;

use embassy_usb_driver::EndpointInfo;
use embassy_usb_driver::host::pipe::{Direction, IsBulkOrInterrupt, IsControl, IsIn, IsOut, Type};
use embassy_usb_driver::host::{PipeError, SplitInfo, TimeoutConfig, UsbPipe};

use super::State;
use crate::wire::{Answer, Device, Handshake, Target, Toggle};

/// Transactions in a row that may go unanswered (USB 2.0 §4.7 and every host controller: three).
const STRIKES: u32 = 3;
/// From one NAK of endpoint 0 to the next try; it doubles, up to the maximum.
const RETRY_US: u64 = 1_000;
const RETRY_MAXIMUM_US: u64 = 64_000;

/// A pipe of the ideal host.
pub struct IdealPipe<T, D> {
    state: Rc<State>,
    target: Target,
    packet: usize,
    interval_us: u64,
    next_us: u64,
    split: Option<SplitInfo>,
    toggle_is_one: bool,
    timeout: TimeoutConfig,
    kind: PhantomData<(T, D)>,
}

/// What a control transfer waits for while the device says "not now".
struct Patience {
    until: u64,
    retry_us: u64,
    strikes: u32,
}

impl<T: Type, D: Direction> IdealPipe<T, D> {
    pub(super) fn new(state: Rc<State>, address: u8, endpoint: &EndpointInfo, split: Option<SplitInfo>) -> Self {
        let target = Target { address, endpoint: u8::from(endpoint.addr) & 0xF };
        let interval_us = u64::from(endpoint.interval_ms) * 1_000;
        Self {
            next_us: state.now.get(),
            state,
            target,
            packet: endpoint.max_packet_size.into(),
            interval_us,
            split,
            toggle_is_one: false,
            timeout: TimeoutConfig::default(),
            kind: PhantomData,
        }
    }

    fn transact<A>(&self, token: impl FnOnce(&mut dyn Device, u64, Target) -> A, silent: A) -> A {
        self.state.transact(self.split, |device, now| token(device, now, self.target)).unwrap_or(silent)
    }

    fn data_in(&self) -> Answer {
        self.transact(|device, now, target| device.data_in(now, target), Answer::Silent)
    }

    fn acknowledge(&self) {
        self.transact(|device, now, target| device.acknowledged(now, target), ());
    }

    fn data_out(&self, toggle_is_one: bool, bytes: &[u8]) -> Handshake {
        let toggle = if toggle_is_one { Toggle::Data1 } else { Toggle::Data0 };
        self.transact(|device, now, target| device.data_out(now, target, toggle, bytes), Handshake::Silent)
    }

    fn patience(&self, duration: core::time::Duration) -> Patience {
        Patience { until: self.state.now.get() + duration.as_micros() as u64, retry_us: RETRY_US, strikes: 0 }
    }

    /// Waits a little after a NAK.
    async fn not_now(&self, patience: &mut Patience) -> Result<(), PipeError> {
        if self.state.now.get() >= patience.until {
            return Err(PipeError::Timeout);
        }
        self.state.until(patience.until.min(self.state.now.get() + patience.retry_us)).await;
        patience.retry_us = (patience.retry_us * 2).min(RETRY_MAXIMUM_US);
        patience.strikes = 0;
        Ok(())
    }

    fn no_answer(&self, patience: &mut Patience) -> Result<(), PipeError> {
        patience.strikes += 1;
        if patience.strikes < STRIKES { Ok(()) } else { Err(PipeError::Timeout) }
    }

    async fn send_setup(&self, setup: &[u8; 8], patience: &mut Patience) -> Result<(), PipeError> {
        loop {
            match self.transact(|device, now, target| device.setup(now, target, *setup), Handshake::Silent) {
                Handshake::Ack => return Ok(()),
                Handshake::Stall => return Err(PipeError::Stall),
                _ => self.no_answer(patience)?,
            }
        }
    }

    /// Reads one packet with the right toggle; a repeated one is acknowledged and dropped (USB 2.0 §8.6.4).
    async fn read_packet(&self, toggle_is_one: bool, patience: &mut Patience) -> Result<Vec<u8>, PipeError> {
        loop {
            match self.data_in() {
                Answer::Data(_, bytes) if bytes.len() > self.packet => return Err(PipeError::Babble),
                Answer::Data(toggle, bytes) => {
                    self.acknowledge();
                    if (toggle == Toggle::Data1) == toggle_is_one {
                        return Ok(bytes);
                    }
                    self.no_answer(patience).map_err(|_| PipeError::DataToggleError)?;
                }
                Answer::Nak => self.not_now(patience).await?,
                Answer::Stall => return Err(PipeError::Stall),
                Answer::Silent => self.no_answer(patience)?,
            }
        }
    }

    async fn write_packet(&self, toggle_is_one: bool, bytes: &[u8], patience: &mut Patience) -> Result<(), PipeError> {
        loop {
            match self.data_out(toggle_is_one, bytes) {
                Handshake::Ack | Handshake::Nyet => return Ok(()),
                Handshake::Nak => self.not_now(patience).await?,
                Handshake::Stall => return Err(PipeError::Stall),
                Handshake::Silent => self.no_answer(patience)?,
            }
        }
    }
}

impl<T: Type, D: Direction> UsbPipe<T, D> for IdealPipe<T, D> {
    async fn control_in(&mut self, setup: &[u8; 8], buffer: &mut [u8]) -> Result<usize, PipeError>
    where
        T: IsControl,
        D: IsIn,
    {
        let mut patience = self.patience(self.timeout.data_timeout);
        self.send_setup(setup, &mut patience).await?;
        let (mut filled, mut toggle_is_one) = (0, true);
        while filled < buffer.len() {
            let bytes = self.read_packet(toggle_is_one, &mut patience).await?;
            if filled + bytes.len() > buffer.len() {
                return Err(PipeError::Babble);
            }
            buffer[filled..filled + bytes.len()].copy_from_slice(&bytes);
            filled += bytes.len();
            toggle_is_one = !toggle_is_one;
            if bytes.len() < self.packet {
                break;
            }
        }
        self.write_packet(true, &[], &mut patience).await?;
        Ok(filled)
    }

    async fn control_out(&mut self, setup: &[u8; 8], bytes: &[u8]) -> Result<(), PipeError>
    where
        T: IsControl,
        D: IsOut,
    {
        let timeout = if bytes.is_empty() { self.timeout.no_data_timeout } else { self.timeout.data_timeout };
        let mut patience = self.patience(timeout);
        self.send_setup(setup, &mut patience).await?;
        let mut toggle_is_one = true;
        for packet in bytes.chunks(self.packet) {
            self.write_packet(toggle_is_one, packet, &mut patience).await?;
            toggle_is_one = !toggle_is_one;
        }
        match self.read_packet(true, &mut patience).await?.len() {
            0 => Ok(()),
            _ => Err(PipeError::BadResponse),
        }
    }

    async fn request_in(&mut self, buffer: &mut [u8]) -> Result<usize, PipeError>
    where
        D: IsIn,
    {
        let (mut filled, mut strikes) = (0, 0);
        loop {
            self.state.until(self.next_us).await;
            self.next_us = self.state.now.get() + self.interval_us;
            match self.data_in() {
                Answer::Data(_, bytes) if bytes.len() > self.packet => return Err(PipeError::Babble),
                Answer::Data(toggle, bytes) => {
                    self.acknowledge();
                    if (toggle == Toggle::Data1) != self.toggle_is_one {
                        continue;
                    }
                    self.toggle_is_one = !self.toggle_is_one;
                    if filled + bytes.len() > buffer.len() {
                        return Err(PipeError::BufferOverflow);
                    }
                    buffer[filled..filled + bytes.len()].copy_from_slice(&bytes);
                    filled += bytes.len();
                    let whole = bytes.len() < self.packet || filled == buffer.len();
                    if whole || !self.state.reads_whole_transfers.get() {
                        return Ok(filled);
                    }
                }
                Answer::Nak => strikes = 0,
                Answer::Stall => return Err(PipeError::Stall),
                Answer::Silent => {
                    strikes += 1;
                    if strikes == STRIKES {
                        return Err(PipeError::Timeout);
                    }
                }
            }
        }
    }

    async fn request_out(&mut self, bytes: &[u8], ensure_transaction_end: bool) -> Result<(), PipeError>
    where
        D: IsOut,
    {
        assert!(!ensure_transaction_end, "no test wants an empty packet at the end");
        for packet in bytes.chunks(self.packet) {
            // Whoever wants an end to it drops the future.
            let mut patience = Patience { until: u64::MAX, retry_us: self.interval_us.max(1), strikes: 0 };
            self.write_packet(self.toggle_is_one, packet, &mut patience).await?;
            self.toggle_is_one = !self.toggle_is_one;
        }
        Ok(())
    }

    fn set_timeout(&mut self, timeout: TimeoutConfig)
    where
        T: IsControl,
    {
        self.timeout = timeout;
    }

    fn reset_data_toggle(&mut self)
    where
        T: IsBulkOrInterrupt,
    {
        self.toggle_is_one = false;
    }
}

impl<T, D> Drop for IdealPipe<T, D> {
    fn drop(&mut self) {
        self.state.pipes.set(self.state.pipes.get() - 1);
    }
}
