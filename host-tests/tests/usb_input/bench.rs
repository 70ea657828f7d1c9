//! A bus on a table: a host, a clock that the test turns, controls that take the reports.

use std::cell::{Cell, RefCell};
use std::pin::Pin;
use std::rc::Rc;

use controls::{ControllerState, Controls};
use usb_input::{Clock, Config, Event, Kind, Memory, Place, UsbInput};
use usb_model::ideal_host::IdealHost;
use usb_model::simple_hub::{Ports, Shared, SimpleHub};
use usb_model::wire::{Device, Speed};

/// How often the bus is polled.
pub const POLL_US: u64 = 1_000;

struct TestClock(Rc<Cell<u64>>);

impl Clock for TestClock {
    fn now_us(&self) -> u64 {
        self.0.get()
    }
}

pub struct Bench {
    pub now: Rc<Cell<u64>>,
    pub host: IdealHost,
    pub usb: UsbInput<'static>,
    pub controls: Controls,
    /// All events so far but reports.
    pub events: Vec<Event>,
    /// All reports so far.
    pub reports: Vec<Event>,
}

impl Bench {
    pub fn new() -> Self {
        Self::with(Config::default(), Speed::High, 16)
    }

    pub fn with(config: Config, fastest: Speed, pipes: usize) -> Self {
        let now = Rc::new(Cell::new(0));
        let host = IdealHost::new(now.clone(), fastest, pipes);
        let memory: &'static Memory = Box::leak(Box::new(Memory::new(config)));
        let bus = Box::leak(Box::new(usb_input::run(host.clone(), TestClock(now.clone()), memory)));
        let usb = UsbInput::new(Pin::static_mut(bus), memory);
        let controls = Controls::new(controls::Config::default());
        Self { now, host, usb, controls, events: Vec::new(), reports: Vec::new() }
    }

    /// Polls once and takes what comes.
    pub fn poll(&mut self) {
        self.usb.poll();
        while let Some(event) = self.usb.next_event() {
            if let Some(report) = event.report() {
                self.controls.accept(report).expect("a report that controls can read");
            }
            match event {
                Event::KeyboardReport { .. } | Event::PadReport { .. } => self.reports.push(event),
                other => self.events.push(other),
            }
        }
    }

    /// Lets time pass, a poll every [`POLL_US`].
    pub fn run(&mut self, duration_us: u64) {
        let end = self.now.get() + duration_us;
        while self.now.get() < end {
            self.poll();
            self.now.set((self.now.get() + POLL_US).min(end));
        }
        self.poll();
    }

    /// Lets time pass until something is so; fails after `limit_us`.
    pub fn run_until(&mut self, limit_us: u64, what: &str, condition: impl Fn(&Self) -> bool) {
        let end = self.now.get() + limit_us;
        while !condition(self) {
            assert!(self.now.get() < end, "not within {limit_us} µs: {what}; events: {:#?}", self.events);
            self.run(POLL_US);
        }
    }

    /// What was attached, in order.
    pub fn attached(&self) -> Vec<(Place, Kind)> {
        let kind = |event: &Event| match event {
            Event::Attached { device, kind, .. } => Some((*device, *kind)),
            _ => None,
        };
        self.events.iter().filter_map(kind).collect()
    }

    /// Runs until something is attached somewhere.
    pub fn run_until_attached(&mut self, place: Place, kind: Kind) {
        self.run_until(2_000_000, &format!("{kind} at {place}"), |bench| bench.attached().contains(&(place, kind)));
    }

    /// What was detached, in order.
    pub fn detached(&self) -> Vec<Place> {
        let place = |event: &Event| match event {
            Event::Detached { device, .. } => Some(*device),
            _ => None,
        };
        self.events.iter().filter_map(place).collect()
    }

    /// Everything that went wrong, as text.
    pub fn faults(&self) -> Vec<String> {
        let fault = |event: &Event| match event {
            Event::Fault { device, fault } => Some(format!("{device}: {fault}")),
            _ => None,
        };
        self.events.iter().filter_map(fault).collect()
    }

    pub fn state(&self) -> ControllerState {
        self.controls.state()
    }

    /// Plugs a hub into the root port.
    pub fn plug_hub(&self, speed: Speed, ports: u8) -> (Rc<RefCell<SimpleHub>>, Ports) {
        let (hub, ports) = self.hub(speed, ports);
        self.host.plug(hub.clone());
        (hub, ports)
    }

    /// Returns a hub that is not plugged in.
    pub fn hub(&self, speed: Speed, ports: u8) -> (Rc<RefCell<SimpleHub>>, Ports) {
        let (hub, ports) = SimpleHub::new(speed, ports, self.host.translation());
        (Rc::new(RefCell::new(hub)), ports)
    }

    /// Plugs a device into a hub's port.
    pub fn plug_into(&self, ports: &Ports, port: u8, device: Shared) {
        ports.plug(port, device, self.now.get());
    }
}

/// Lets a test keep a hand on a device.
pub fn shared<D: Device + 'static>(device: D) -> Rc<RefCell<D>> {
    Rc::new(RefCell::new(device))
}

/// The place at ports one below the other.
pub fn place(ports: &[u8]) -> Place {
    ports.iter().fold(Place::ROOT, |place, &port| place.below(port).expect("a place"))
}
