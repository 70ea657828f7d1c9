//! A host controller with nothing behind it: `embassy-usb-driver`'s host traits over a device.
//!
//! A transaction takes no time; what takes time is what a device asks for (NAK), the intervals of
//! interrupt endpoints, and the root port's debounce and reset.

mod pipe;

use std::cell::{Cell, RefCell};
use std::future::poll_fn;
use std::rc::Rc;
use std::task::Poll;

use embassy_usb_driver::EndpointInfo;
use embassy_usb_driver::host::pipe::{Direction, Type};
use embassy_usb_driver::host::{DeviceEvent, HostError, SplitInfo, SplitSpeed, UsbHostAllocator, UsbHostController};

use crate::simple_hub::{Shared, Split, Translation};
use crate::wire::{Device, Speed};

pub use pipe::IdealPipe;

/// The root port's connection has to be steady this long (USB 2.0 §7.1.7.3).
const DEBOUNCE_US: u64 = 100_000;
/// A root port's reset lasts this long (TDRSTR, USB 2.0 §7.1.7.5).
const RESET_US: u64 = 50_000;

/// What the host, its pipes and the test share.
struct State {
    now: Rc<Cell<u64>>,
    fastest: Speed,
    device: RefCell<Option<Shared>>,
    enabled: Cell<bool>,
    /// Counts what was plugged in and out.
    generation: Cell<u32>,
    /// The generation that was told of last.
    told: Cell<u32>,
    plugged_at: Cell<u64>,
    over_current: Cell<bool>,
    pipes: Cell<usize>,
    pipes_maximum: usize,
    translation: Translation,
    wait_until: Cell<Option<u64>>,
    reads_whole_transfers: Cell<bool>,
    transactions: Cell<u64>,
}

/// A host controller; clones are the same one.
#[derive(Clone)]
pub struct IdealHost(Rc<State>);

impl IdealHost {
    /// Returns a host with nothing plugged in, whose root port is as fast as this, with so many pipes.
    pub fn new(now: Rc<Cell<u64>>, fastest: Speed, pipes_maximum: usize) -> Self {
        Self(Rc::new(State {
            now,
            fastest,
            device: RefCell::new(None),
            enabled: Cell::new(false),
            generation: Cell::new(0),
            told: Cell::new(0),
            plugged_at: Cell::new(0),
            over_current: Cell::new(false),
            pipes: Cell::new(0),
            pipes_maximum,
            translation: Rc::default(),
            wait_until: Cell::new(None),
            reads_whole_transfers: Cell::new(false),
            transactions: Cell::new(0),
        }))
    }

    /// The split of the token that is on the wire, for hubs to look at.
    pub fn translation(&self) -> Translation {
        self.0.translation.clone()
    }

    /// Plugs a device into the root port.
    pub fn plug(&self, device: Shared) {
        self.0.device.replace(Some(device));
        self.change();
    }

    /// Pulls whatever is in the root port.
    pub fn unplug(&self) {
        self.0.device.replace(None);
        self.change();
    }

    fn change(&self) {
        self.0.enabled.set(false);
        self.0.generation.set(self.0.generation.get() + 1);
        self.0.plugged_at.set(self.0.now.get());
    }

    /// Says once that the root port draws too much current.
    pub fn trip(&self) {
        self.0.over_current.set(true);
    }

    /// Whether an interrupt transfer goes on until its buffer is full or a packet is not; else it ends
    /// with its first packet. Controllers differ.
    pub fn set_reads_whole_transfers(&self, whole: bool) {
        self.0.reads_whole_transfers.set(whole);
    }

    /// Pipes that are in use.
    pub fn pipes(&self) -> usize {
        self.0.pipes.get()
    }

    /// Transactions so far.
    pub fn transactions(&self) -> u64 {
        self.0.transactions.get()
    }

    /// Takes the earliest time at which a transfer goes on by itself, of those that were met since the last call.
    pub fn take_wait_us(&self) -> Option<u64> {
        self.0.wait_until.take()
    }

    async fn reset_port(&self) -> Option<Speed> {
        self.0.sleep(RESET_US).await;
        let device = self.0.device.borrow();
        let mut device = device.as_ref()?.borrow_mut();
        let speed = device.speed(self.0.fastest);
        device.reset(self.0.now.get(), speed);
        self.0.enabled.set(true);
        Some(speed)
    }
}

impl State {
    /// Waits until a time, which the test is told.
    async fn until(&self, time: u64) {
        poll_fn(|_| {
            if self.now.get() >= time {
                return Poll::Ready(());
            }
            let earliest = self.wait_until.get().map_or(time, |other| other.min(time));
            self.wait_until.set(Some(earliest));
            Poll::Pending
        })
        .await;
    }

    async fn sleep(&self, duration: u64) {
        self.until(self.now.get() + duration).await;
    }

    /// Sends a token to whatever is plugged in; `None` if nothing is, or its port is not enabled.
    fn transact<T>(&self, split: Option<SplitInfo>, token: impl FnOnce(&mut dyn Device, u64) -> T) -> Option<T> {
        self.transactions.set(self.transactions.get() + 1);
        let device = self.device.borrow().clone().filter(|_| self.enabled.get())?;
        self.translation.set(split.map(|split| Split {
            hub: split.hub_addr(),
            port: split.port(),
            low: split.device_speed() == SplitSpeed::Low,
        }));
        let answer = token(&mut *device.borrow_mut(), self.now.get());
        self.translation.set(None);
        Some(answer)
    }
}

impl UsbHostController<'static> for IdealHost {
    type Allocator = Self;

    fn allocator(&self) -> Self {
        self.clone()
    }

    async fn wait_for_device_event(&mut self) -> DeviceEvent {
        let state = self.0.clone();
        loop {
            poll_fn(|_| match state.generation.get() != state.told.get() || state.over_current.get() {
                true => Poll::Ready(()),
                false => Poll::Pending,
            })
            .await;
            if state.over_current.take() {
                return DeviceEvent::Overcurrent;
            }
            let generation = state.generation.get();
            if state.device.borrow().is_none() || generation > state.told.get() + 1 {
                // Gone; a device that took its place is told of next.
                state.told.set(generation - u32::from(state.device.borrow().is_some()));
                return DeviceEvent::Disconnected;
            }
            state.until(state.plugged_at.get() + DEBOUNCE_US).await;
            let speed = self.reset_port().await;
            if let (Some(speed), true) = (speed, generation == state.generation.get()) {
                state.told.set(generation);
                return DeviceEvent::Connected(match speed {
                    Speed::Low => embassy_usb_driver::Speed::Low,
                    Speed::Full => embassy_usb_driver::Speed::Full,
                    Speed::High => embassy_usb_driver::Speed::High,
                });
            }
        }
    }

    async fn bus_reset(&mut self) {
        self.reset_port().await;
    }
}

impl UsbHostAllocator<'static> for IdealHost {
    type Pipe<T: Type, D: Direction> = IdealPipe<T, D>;

    fn alloc_pipe<T: Type, D: Direction>(
        &self,
        address: u8,
        endpoint: &EndpointInfo,
        split: Option<SplitInfo>,
    ) -> Result<IdealPipe<T, D>, HostError> {
        if self.pipes() >= self.0.pipes_maximum {
            return Err(HostError::OutOfPipes);
        }
        assert!(address < 128, "address {address} is none");
        assert!(endpoint.max_packet_size > 0, "packets of no bytes");
        self.0.pipes.set(self.pipes() + 1);
        Ok(IdealPipe::new(self.0.clone(), address, endpoint, split))
    }
}
