//! Driver and bus as the interrupt handler and the main loop see them.

use core::pin::Pin;

use dwc2_host::{Config, Dwc2, Fault};
use static_cell::StaticCell;
use usb_input::{Event, Memory, UsbInput};

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

/// Driver and bus. The first tick starts the core.
pub struct Service {
    driver: &'static Dwc2<'static>,
    input: UsbInput<'static>,
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
        let driver: &'static Dwc2<'static> = room.driver.try_init(Dwc2::new(room.core.try_init(core)?, config))?;
        let memory: &'static Memory = room.memory.try_init(Memory::new(usb_input::Config::default()))?;
        let future = room.future.put(usb_input::run(driver.controller(), BusClock(clock), memory))?;
        Some(Self { driver, input: UsbInput::new(Pin::static_mut(future), memory) })
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

    /// Takes the oldest event.
    pub fn next_event(&mut self) -> Option<Event> {
        self.input.next_event()
    }

    /// Takes the controller's last fault, if there was one since the last call.
    pub fn take_fault(&mut self) -> Option<Fault> {
        self.driver.take_fault()
    }

    /// Tells whether the pose is frozen, for a touch of the pad's motor.
    pub fn set_frozen(&mut self, frozen: bool) {
        self.input.set_frozen(frozen);
    }
}
