//! USB1: the DWC2 core, and behind it what is soldered and plugged: a high-speed hub, a keyboard, a
//! DualShock 3. Core, hub and devices are `usb-model`'s, which forgives nothing: a broken rule ends
//! the run.

use usb_model::dualshock3::{DualShock3, Temper, dualshock3};
use usb_model::dwc2::{Build, Core};
use usb_model::hub::Hub;
use usb_model::keyboard::{Form, Keyboard, keyboard};
use usb_model::memory::DmaBus;
use usb_model::shared::Shared;
use usb_model::violation::{Log, Rule};
use usb_model::wire::Speed;

use crate::bus::Bus;
use crate::time::{Clocks, microseconds};
use crate::violation::Access;

/// Ports of the board's hub, a USB2512B.
const PORTS: usize = 2;
/// Ports of the hub that have a connector, and what is plugged there.
const KEYBOARD_PORT: usize = 1;
const PAD_PORT: usize = 2;

/// The bus master's way to memory.
struct Master<'a>(&'a Bus);

impl DmaBus for Master<'_> {
    fn read(&mut self, address: u32, bytes: &mut [u8]) -> bool {
        // A refusal ends the run; what the core makes of it does not matter any more.
        self.0.dma_read(address, bytes).is_ok() || self.0.is_refusing()
    }

    fn write(&mut self, address: u32, bytes: &[u8]) -> bool {
        self.0.dma_write(address, bytes).is_ok() || self.0.is_refusing()
    }

    fn lend(&mut self, channel: usize, address: u32, length: usize, writes: bool) {
        self.0.lend(channel, address, length as u32, writes);
    }

    fn give_back(&mut self, channel: usize) {
        self.0.give_back(channel);
    }
}

/// The controller and its bus.
pub struct Usb {
    core: Core,
    log: Log,
    hub: Shared<Hub>,
    keyboard: Shared<Keyboard>,
    pad: Shared<DualShock3>,
    /// What the devices complained of already.
    told: [usize; 2],
}

impl Usb {
    /// Returns the controller after power-on, with a hub and nothing plugged into it.
    pub fn new() -> Self {
        let log = Log::default();
        let hub = Shared::new(Hub::with_ports(Speed::High, PORTS));
        let mut core = Core::new(Build::cyclone_v(), log.clone());
        core.plug(Box::new(hub.clone()));
        Self {
            core,
            log,
            hub,
            keyboard: Shared::new(keyboard(Form::Boot, Speed::Low)),
            pad: Shared::new(dualshock3(Temper::Sony)),
            told: [0; 2],
        }
    }

    /// Resets the controller; hub and devices notice nothing but that the bus falls silent.
    pub fn reset(&mut self, now: Clocks, bus: &Bus) {
        self.core.unplug();
        let mut core = Core::new(Build::cyclone_v(), self.log.clone());
        core.advance(now / microseconds(1), &mut Master(bus));
        core.plug(Box::new(self.hub.clone()));
        self.core = core;
    }

    /// Plugs the keyboard in.
    pub fn plug_keyboard(&mut self) {
        self.hub.lock().plug(KEYBOARD_PORT, Box::new(self.keyboard.clone()));
    }

    /// Pulls the keyboard out.
    pub fn unplug_keyboard(&mut self) {
        self.hub.lock().unplug(KEYBOARD_PORT);
    }

    /// Plugs the pad in.
    pub fn plug_pad(&mut self) {
        self.hub.lock().plug(PAD_PORT, Box::new(self.pad.clone()));
    }

    /// Pulls the pad out.
    pub fn unplug_pad(&mut self) {
        self.hub.lock().unplug(PAD_PORT);
    }

    /// Returns the keyboard, plugged in or not.
    pub fn keyboard(&self) -> &Shared<Keyboard> {
        &self.keyboard
    }

    /// Returns the pad, plugged in or not.
    pub fn pad(&self) -> &Shared<DualShock3> {
        &self.pad
    }

    /// Returns the interrupt line.
    pub fn interrupt(&self) -> bool {
        self.core.irq()
    }

    /// Lets time pass on the bus.
    pub fn advance(&mut self, now: Clocks, bus: &Bus) {
        self.core.advance(now / microseconds(1), &mut Master(bus));
        self.tell(bus);
    }

    /// Ends the run when a rule was broken; but for that of the interrupt that nobody answers: a processor that hangs
    /// answers none, and to end that is the watchdog's part.
    fn tell(&mut self, bus: &Bus) {
        for violation in self.log.take().into_iter().filter(|found| found.rule != Rule::InterruptIgnored) {
            bus.refuse(Access::Protocol, USB1, "USB1", &violation.to_string());
        }
        let complaints = [self.keyboard.lock().violations().to_vec(), self.pad.lock().violations().to_vec()];
        for (told, complaints) in self.told.iter_mut().zip(complaints) {
            for complaint in &complaints[*told..] {
                bus.refuse(Access::Protocol, USB1, "a USB device", complaint);
            }
            *told = complaints.len();
        }
    }

    /// Returns when something happens on the bus.
    pub fn next_event(&self) -> Clocks {
        self.core.next_event().map_or(Clocks::MAX, |at| at.saturating_mul(microseconds(1)))
    }

    /// Reads a register.
    pub fn read(&mut self, offset: u32, bus: &Bus) -> u32 {
        let value = self.core.read(offset);
        self.tell(bus);
        value
    }

    /// Writes a register.
    pub fn write(&mut self, offset: u32, value: u32, bus: &Bus) {
        self.core.write(offset, value);
        self.tell(bus);
    }
}

impl Default for Usb {
    fn default() -> Self {
        Self::new()
    }
}

/// Where the controller's registers begin, for a report.
const USB1: u32 = 0xFFB4_0000;
