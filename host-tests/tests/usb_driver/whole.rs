//! All that reads a keyboard or a pad on the board: `usb-input` on the driver on the strict model.
//!
//! | module | shows |
//! | --- | --- |
//! | `times` | how long it takes to the first report, and from a report to the state |
//! | `cost` | how often the driver runs, and what it asks of the core's registers |
//! | `swaps` | one device in another's place, at any moment |
//! | `beside` | a good device that starts beside one that fails |
//! | `speed` | the root port held at full speed while everything runs |
//! | `batch`, `reach`, `rogues` | devices that are wrong, 100,000 of them |

mod batch;
mod beside;
mod cost;
mod reach;
mod rogues;
mod speed;
mod swaps;
mod times;

use std::cell::Cell;
use std::pin::Pin;
use std::rc::Rc;

use controls::Controls;
use dwc2_host::Config;
use usb_input::{Clock, Event, Kind, Memory, Place, UsbInput};

use crate::rig::Rig;

struct BusClock(Rc<Cell<u64>>);

impl Clock for BusClock {
    fn now_us(&self) -> u64 {
        self.0.get()
    }
}

/// The stack on a rig, served as on a board: driver and stack once a millisecond, the driver at every interrupt.
pub struct Whole {
    pub rig: Rig,
    pub controls: Controls,
    /// All events so far but reports.
    pub events: Vec<Event>,
    /// All reports so far.
    pub reports: Vec<Event>,
    usb: UsbInput<'static>,
    now: Rc<Cell<u64>>,
}

impl Whole {
    pub fn new(config: Config) -> Self {
        let (rig, now) = (Rig::new(config), Rc::new(Cell::new(0)));
        let memory: &'static Memory = Box::leak(Box::new(Memory::new(usb_input::Config::default())));
        let bus = Box::leak(Box::new(usb_input::run(rig.driver.controller(), BusClock(now.clone()), memory)));
        let usb = UsbInput::new(Pin::static_mut(bus), memory);
        let controls = Controls::new(controls::Config::default());
        Self { rig, controls, events: Vec::new(), reports: Vec::new(), usb, now }
    }

    pub fn now(&self) -> u64 {
        self.now.get()
    }

    /// Lets a millisecond pass.
    pub fn tick(&mut self) {
        self.rig.tick();
        self.now.set(self.rig.now());
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

    /// Lets time pass.
    pub fn run(&mut self, duration_us: u64) {
        self.run_until(duration_us, |_| false);
    }

    /// Lets time pass until something is so; tells whether it became so within the time.
    pub fn run_until(&mut self, limit_us: u64, condition: impl Fn(&Self) -> bool) -> bool {
        let end = self.now() + limit_us;
        while !condition(self) {
            if self.now() >= end {
                return false;
            }
            self.tick();
        }
        true
    }

    /// Whether something was attached somewhere.
    pub fn is_attached(&self, place: Place, wanted: Kind) -> bool {
        self.events
            .iter()
            .any(|event| matches!(event, Event::Attached { device, kind, .. } if *device == place && *kind == wanted))
    }

    /// Whether something was detached somewhere.
    pub fn is_detached(&self, place: Place) -> bool {
        self.events.iter().any(|event| matches!(event, Event::Detached { device, .. } if *device == place))
    }
}

/// A port of the root port's hub.
pub fn port(number: u8) -> Place {
    Place::ROOT.below(number).expect("a place")
}
