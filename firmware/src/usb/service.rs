//! Driver and bus as the interrupt handler and the main loop see them.

use core::pin::Pin;

use dwc2_host::{Dwc2, Fault, SpeedLimit};
use static_cell::StaticCell;
use usb_input::{Event, Fallback, Memory, UsbInput};

use super::dwc2::{Dwc2Core, Now};
use super::forever::Forever;

/// Bytes of the bus's future.
const FUTURE_BYTES: usize = 16 * 1024;

/// Memory for a service; large, so a static.
pub struct Room<T: 'static> {
    core: StaticCell<Dwc2Core<T>>,
    driver: StaticCell<Dwc2<'static>>,
    memory: StaticCell<Memory>,
    future: Forever<FUTURE_BYTES>,
}

impl<T> Room<T> {
    /// Empty memory, for a static.
    pub const fn new() -> Self {
        Self { core: StaticCell::new(), driver: StaticCell::new(), memory: StaticCell::new(), future: Forever::new() }
    }
}

impl<T> Default for Room<T> {
    fn default() -> Self {
        Self::new()
    }
}

/// A clock as the bus wants it.
struct BusClock<T>(T);

impl<T: Now> usb_input::Clock for BusClock<T> {
    fn now_us(&self) -> u64 {
        self.0.microseconds()
    }
}

/// What a board chooses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Config {
    /// Of the controller.
    pub controller: dwc2_host::Config,
    /// Of the devices.
    pub devices: usb_input::Config,
}

/// What has happened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum News {
    /// To a device.
    Device(Event),
    /// The controller failed. It mends that by itself.
    Controller(dwc2_host::Fault),
    /// Nothing worked at high speed: the bus goes on at full speed.
    FullSpeed,
}

/// Driver and bus. The first tick starts the core.
pub struct Service {
    driver: &'static Dwc2<'static>,
    input: UsbInput<'static>,
    /// While the port may run at high speed.
    fallback: Option<Fallback>,
    /// It was fallen back, and nobody has been told.
    fell_back: bool,
}

// SAFETY: what it refers to in the room is referred to by nothing else, so that it moves as a whole.
unsafe impl Send for Service {}

impl Service {
    /// Puts driver and bus into their room; `None` when that is taken already.
    pub fn new<T: Now + Send + 'static>(
        room: &'static Room<T>,
        core: Dwc2Core<T>,
        config: Config,
        clock: T,
    ) -> Option<Self> {
        let Config { controller, devices } = config;
        let driver: &'static Dwc2<'static> = room.driver.try_init(Dwc2::new(room.core.try_init(core)?, controller))?;
        let memory: &'static Memory = room.memory.try_init(Memory::new(devices))?;
        let future = room.future.put(usb_input::run(driver.controller(), BusClock(clock), memory))?;
        let fallback = (controller.speed_limit == SpeedLimit::High).then(Fallback::default);
        Some(Self { driver, input: UsbInput::new(Pin::static_mut(future), memory), fallback, fell_back: false })
    }

    /// Does what is due by the clock, a step of each device. For the timer's interrupt.
    pub fn tick(&mut self) {
        self.driver.poll();
        self.input.poll();
    }

    /// Takes in what the controller reports. For its interrupt.
    pub fn on_interrupt(&mut self) {
        self.driver.on_interrupt();
    }

    /// Takes the oldest of what has happened.
    pub fn next_news(&mut self) -> Option<News> {
        if core::mem::take(&mut self.fell_back) {
            return Some(News::FullSpeed);
        }
        if let Some(fault) = self.driver.take_fault() {
            let signal = matches!(fault, Fault::PortNotEnabled | Fault::PortDisabled | Fault::ChannelStuck { .. });
            self.fall_back_if(|fallback| signal && fallback.controller_failed());
            return Some(News::Controller(fault));
        }
        let event = self.input.next_event()?;
        self.fall_back_if(|fallback| fallback.is_due(&event));
        Some(News::Device(event))
    }

    fn fall_back_if(&mut self, is_due: impl FnOnce(&mut Fallback) -> bool) {
        if self.fallback.as_mut().is_some_and(is_due) {
            self.fallback = None;
            self.fell_back = true;
            self.driver.limit_speed(SpeedLimit::Full);
        }
    }

    /// Tells whether the pose is frozen, for a touch of the pad's motor.
    pub fn set_frozen(&mut self, frozen: bool) {
        self.input.set_frozen(frozen);
    }
}
