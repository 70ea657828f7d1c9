//! The driver's handle, and the controller and allocator that a USB stack takes.

use core::cell::RefCell;

use critical_section::Mutex;
use embassy_usb_driver::EndpointInfo;
use embassy_usb_driver::host::{DeviceEvent, HostError, SplitInfo, UsbHostAllocator, UsbHostController, pipe};

use crate::{Board, Config, Fault, Pipe};

/// One DWC2 core and all that the driver knows of it.
///
/// Shared by reference between the interrupt handler, the main loop and every [`Pipe`].
pub struct Dwc2<'d> {
    #[expect(dead_code)]
    board: Mutex<RefCell<&'d mut (dyn Board + Send)>>,
    #[expect(dead_code)]
    config: Config,
}

impl<'d> Dwc2<'d> {
    /// Takes the core over; touches nothing yet. The first [`poll`](Dwc2::poll) starts it.
    pub fn new(board: &'d mut (dyn Board + Send), config: Config) -> Self {
        Self { board: Mutex::new(RefCell::new(board)), config }
    }

    /// Handles the core's interrupt and wakes who waited for it; never waits.
    pub fn on_interrupt(&self) {}

    /// Does what is due by the clock and by the core, and wakes who waited for it; never waits. Call it at 1 kHz.
    pub fn poll(&self) {}

    /// Takes the last fault, if there was one since the last call.
    pub fn take_fault(&self) -> Option<Fault> {
        None
    }

    /// The controller for a USB stack: root-port events and bus reset. One at a time.
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

    async fn wait_for_device_event(&mut self) -> DeviceEvent {
        core::future::pending().await
    }

    async fn bus_reset(&mut self) {}
}

/// Hands out [`Pipe`]s; cheap to clone.
#[derive(Clone, Copy)]
pub struct Allocator<'d> {
    #[expect(dead_code)]
    driver: &'d Dwc2<'d>,
}

impl<'d> UsbHostAllocator<'d> for Allocator<'d> {
    type Pipe<T: pipe::Type, D: pipe::Direction> = Pipe<'d, T, D>;

    fn alloc_pipe<T: pipe::Type, D: pipe::Direction>(
        &self,
        _address: u8,
        _endpoint: &EndpointInfo,
        _split: Option<SplitInfo>,
    ) -> Result<Pipe<'d, T, D>, HostError> {
        Err(HostError::OutOfPipes)
    }
}
