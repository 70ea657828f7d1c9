//! The driver's handle, and the controller and allocator that a USB stack takes.

use core::cell::RefCell;
use core::future::poll_fn;
use core::task::Poll;

use critical_section::Mutex;
use embassy_usb_driver::host::{DeviceEvent, HostError, SplitInfo, UsbHostAllocator, UsbHostController, pipe};
use embassy_usb_driver::{EndpointInfo, EndpointType};

use crate::hardware::Core;
use crate::port::Phase;
use crate::state::State;
use crate::{Board, Config, Fault, Pipe, SpeedLimit};

/// One DWC2 core and all that the driver knows of it.
///
/// Shared by reference between the interrupt handler, the main loop and every [`Pipe`].
pub struct Dwc2<'d> {
    state: Mutex<RefCell<State<'d>>>,
}

impl<'d> Dwc2<'d> {
    /// Takes the core over; touches nothing yet. The first [`poll`](Dwc2::poll) starts it.
    pub fn new(board: &'d mut (dyn Board + Send), config: Config) -> Self {
        Self { state: Mutex::new(RefCell::new(State::new(Core::new(board), config))) }
    }

    /// Borrows the state, with interrupts off. Nothing inside may wait, or call this again.
    pub(crate) fn with<R>(&self, act: impl FnOnce(&mut State<'d>) -> R) -> R {
        critical_section::with(|section| act(&mut self.state.borrow_ref_mut(section)))
    }

    /// Handles the core's interrupt and wakes who waited for it; never waits.
    pub fn on_interrupt(&self) {
        self.service(false);
    }

    /// Does what is due by the clock and by the core, and wakes who waited for it; never waits. Call it at 1 kHz.
    pub fn poll(&self) {
        self.service(true);
    }

    fn service(&self, poll: bool) {
        if let Some(wakes) = self.with(|state| state.service(poll)) {
            wakes.wake();
        }
    }

    /// Takes the last fault, if there was one since the last call. The driver mends it by itself.
    pub fn take_fault(&self) -> Option<Fault> {
        self.with(|state| state.fault.take())
    }

    /// Limits the root port's speed from now on. A change ends all transfers, turns the port off and starts the core
    /// anew, which takes a second; devices go and come again.
    pub fn limit_speed(&self, limit: SpeedLimit) {
        self.with(|state| state.limit_speed(limit));
        self.poll();
    }

    /// Ends all transfers, turns the port's power and the interrupts off. [`start`](Dwc2::start) undoes it.
    pub fn shut_down(&self) {
        self.with(State::shut_down);
        self.poll();
    }

    /// Starts the core anew after [`shut_down`](Dwc2::shut_down).
    pub fn start(&self) {
        self.with(|state| {
            if state.phase == Phase::Off {
                state.phase = Phase::Identify;
            }
        });
    }

    /// The controller for a USB stack: root-port events and bus reset. Take one: a second one would take the first
    /// one's events.
    pub fn controller(&'d self) -> Controller<'d> {
        Controller { driver: self }
    }

    /// The allocator of pipes.
    pub fn allocator(&'d self) -> Allocator<'d> {
        Allocator { driver: self }
    }
}

/// Root-port events and bus reset, as `embassy-usb-driver` wants them.
pub struct Controller<'d> {
    driver: &'d Dwc2<'d>,
}

impl<'d> UsbHostController<'d> for Controller<'d> {
    type Allocator = Allocator<'d>;

    fn allocator(&self) -> Allocator<'d> {
        self.driver.allocator()
    }

    /// The driver resets a device when it comes, whether or not anybody waits here; dropping this future loses nothing.
    async fn wait_for_device_event(&mut self) -> DeviceEvent {
        poll_fn(|context| {
            self.driver.with(|state| match state.news.take() {
                Some(event) => Poll::Ready(event),
                None => {
                    state.event_waker = Some(context.waker().clone());
                    Poll::Pending
                }
            })
        })
        .await
    }

    /// Returns when the device may be talked to at address 0, or is gone (then an event says so).
    async fn bus_reset(&mut self) {
        self.driver.with(|state| {
            let now = state.hardware.now();
            state.ask_reset(now);
        });
        poll_fn(|context| {
            self.driver.with(|state| {
                if state.news.take_reset_over() {
                    return Poll::Ready(());
                }
                state.event_waker = Some(context.waker().clone());
                Poll::Pending
            })
        })
        .await;
    }
}

/// Hands out [`Pipe`]s; cheap to clone.
#[derive(Clone, Copy)]
pub struct Allocator<'d> {
    driver: &'d Dwc2<'d>,
}

impl<'d> UsbHostAllocator<'d> for Allocator<'d> {
    type Pipe<T: pipe::Type, D: pipe::Direction> = Pipe<'d, T, D>;

    /// # Errors
    ///
    /// - `NoSuchDevice` while nothing is plugged into the root port, or it is being reset.
    /// - `OutOfPipes` when [`PIPES`](crate::PIPES) are in use.
    /// - `InvalidDescriptor` for an endpoint that USB does not have, an isochronous one, or one that is not of the
    ///   pipe's kind and direction.
    /// - `InsufficientMemory` for packets longer than [`PIPE_BUFFER_BYTES`](crate::PIPE_BUFFER_BYTES).
    fn alloc_pipe<T: pipe::Type, D: pipe::Direction>(
        &self,
        address: u8,
        endpoint: &EndpointInfo,
        split: Option<SplitInfo>,
    ) -> Result<Pipe<'d, T, D>, HostError> {
        let both = T::ep_type() == EndpointType::Control;
        if endpoint.ep_type != T::ep_type() || !both && endpoint.addr.is_in() != D::is_in() {
            return Err(HostError::InvalidDescriptor);
        }
        let index = self.driver.with(|state| state.allocate(address, endpoint, split))?;
        Ok(Pipe::new(self.driver, index))
    }
}
