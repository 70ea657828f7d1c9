//! Some rogues at once beside a good device, and what has to be so then and after them.

use std::ops::Range;

use dwc2_host::{Config, SpeedLimit};
use usb_input::{Event, Fault, Kind, Place, SETTLED_WITHIN_US};
use usb_model::hub::Hub;
use usb_model::keyboard::{Form, Keyboard, keyboard};
use usb_model::rogue::rogue;
use usb_model::shared::Shared;
use usb_model::wire::{Device, Speed};

use super::reach::{REACHES, Reach};
use super::{Whole, port};

/// Rogues that are plugged in at once.
pub const BATCH: u64 = 6;
/// What comes to [`SETTLED_WITHIN_US`] for each device: the hub tells of one in 256 ms at most; on the root port the core
/// is started anew, which takes a second, whenever a device babbles into the next frame.
const MORE_US: u64 = 4_000_000;
/// A good device is ready within this: the hub tells of it (256 ms), it settles (100 ms), is reset and asked; at the
/// root port the core may be started anew before (1 s).
const GOOD_LIMIT_US: u64 = 2_000_000;
/// A report is there within this.
const REPORT_LIMIT_US: u64 = 30_000;
/// The hub's port of the keyboard that is there all the time.
const NEIGHBOUR: u8 = 7;

/// What came of the rogues so far.
#[derive(Default, Debug, Clone, Copy)]
pub struct Outcome {
    pub rogues: u64,
    /// How many came how far, by [`Reach`].
    pub reached: [u64; REACHES],
    /// From plugging a batch in to the end of its last rogue.
    pub longest_us: u64,
    /// Time on the bus.
    pub passed_us: u64,
}

/// A bus of which one port, or all of a hub's but one, take rogues.
pub struct Bench {
    whole: Whole,
    hub: Option<Shared<Hub>>,
    neighbour: Shared<Keyboard>,
}

impl Bench {
    /// The root port alone.
    pub fn root() -> Self {
        let whole = Whole::new(Config::new());
        Self { whole, hub: None, neighbour: Shared::new(keyboard(Form::Boot, Speed::Low)) }
    }

    /// A hub with a keyboard that has to go on working, whatever is plugged in beside it.
    pub fn hub(limit: SpeedLimit) -> Self {
        let whole = Whole::new(Config::new().with_speed_limit(limit));
        let hub = Shared::new(Hub::with_ports(Speed::High, NEIGHBOUR.into()));
        whole.rig.plug(hub.clone());
        let neighbour = Shared::new(keyboard(Form::Boot, Speed::Low));
        hub.lock().plug(NEIGHBOUR.into(), Box::new(neighbour.clone()));
        let mut bench = Self { whole, hub: Some(hub), neighbour };
        assert!(bench.until(GOOD_LIMIT_US, |whole| whole.is_attached(port(NEIGHBOUR), Kind::BootKeyboard)));
        bench
    }

    fn until(&mut self, limit_us: u64, condition: impl Fn(&Whole) -> bool) -> bool {
        self.whole.run_until(limit_us, condition)
    }

    /// Plugs a device in; who was there is gone.
    fn plug(&self, place: Place, device: impl Device + Send + 'static) {
        match &self.hub {
            Some(hub) => hub.lock().plug(number(place), Box::new(device)),
            None => self.whole.rig.plug(device),
        }
    }

    fn unplug(&self, place: Place) {
        match &self.hub {
            Some(hub) => drop(hub.lock().unplug(number(place))),
            None => self.whole.rig.unplug(),
        }
    }

    /// Plugs rogues in, at once behind a hub, else one after the other; at their end a good device takes the place of one.
    pub fn batch(&mut self, seeds: Range<u64>, outcome: &mut Outcome) {
        if self.hub.is_none() {
            return seeds.for_each(|seed| self.rogues(&[(Place::ROOT, seed)], outcome));
        }
        let rogues: Vec<(Place, u64)> = (1..).map(port).zip(seeds).collect();
        self.rogues(&rogues, outcome);
    }

    fn rogues(&mut self, rogues: &[(Place, u64)], outcome: &mut Outcome) {
        let (began, count) = (self.whole.now(), rogues.len() as u64);
        self.whole.events.clear();
        rogues.iter().for_each(|&(place, seed)| self.plug(place, rogue(seed)));
        let settled = |whole: &Whole| rogues.iter().all(|&(place, _)| is_settled(&whole.events, place));
        let done = self.until(SETTLED_WITHIN_US * count + MORE_US, settled);
        assert!(done, "{rogues:?} are not done with: {:?}", self.whole.events);
        outcome.longest_us = outcome.longest_us.max(self.whole.now() - began);
        // Reports, of whatever kind.
        self.whole.run(60_000);
        for &(place, _) in rogues {
            outcome.reached[Reach::of(&self.whole.events, place) as usize] += 1;
        }
        self.the_next_one_works(rogues);
        let broken = self.whole.rig.take_violations();
        assert!(broken.is_empty(), "{rogues:?} made the driver break rules: {broken:#?}");
        outcome.rogues += count;
        outcome.passed_us += self.whole.now() - began;
    }

    /// A good device takes the place of a rogue, the others are pulled out; it works, and so does the neighbour.
    fn the_next_one_works(&mut self, rogues: &[(Place, u64)]) {
        let here = rogues[rogues[0].1 as usize % rogues.len()].0;
        let before = self.whole.events.len();
        let good = Shared::new(keyboard(Form::List, Speed::Full));
        rogues.iter().for_each(|&(place, _)| self.unplug(place));
        self.plug(here, good.clone());
        let ready = self.until(GOOD_LIMIT_US, |whole| {
            let attached = |event: &Event| {
                matches!(event, Event::Attached { device, kind: Kind::ReportKeyboard, .. } if *device == here)
            };
            whole.events[before..].iter().any(attached) && rogues.iter().all(|&(place, _)| is_over(&whole.events, place))
        });
        assert!(ready, "after {rogues:?}: {:?}", self.whole.events);
        self.whole.reports.clear();
        let mut wanted = vec![press(&good, here)];
        if self.hub.is_some() {
            let lost = self.whole.is_detached(port(NEIGHBOUR));
            assert!(!lost, "{rogues:?} harm their neighbour: {:?}", self.whole.events);
            wanted.push(press(&self.neighbour, port(NEIGHBOUR)));
        }
        let typed = self.until(REPORT_LIMIT_US, |whole| wanted.iter().all(|report| whole.reports.contains(report)));
        assert!(typed, "after {rogues:?}: {:?} {:?}", self.whole.events, self.whole.reports);
        self.neighbour.lock().function.release(SPACE);
        for device in [&good, &self.neighbour] {
            assert_eq!(device.lock().violations(), &[] as &[String], "after {rogues:?}");
        }
    }
}

const SPACE: u8 = 0x2C;

/// Presses a key; returns the report that is to come.
fn press(keyboard: &Shared<Keyboard>, device: Place) -> Event {
    keyboard.lock().function.press(SPACE);
    Event::KeyboardReport { device, report: [0, 0, SPACE, 0, 0, 0, 0, 0] }
}

/// The port of a hub's device.
fn number(place: Place) -> usize {
    (1..=NEIGHBOUR).find(|&number| port(number) == place).expect("a port of the hub").into()
}

fn is_given_up(events: &[Event], here: Place) -> bool {
    let end = |event: &Event| match event {
        Event::Fault { device, fault: Fault::GivenUp | Fault::TooManyDevices } => *device == here,
        _ => false,
    };
    // The root port's device is tried for ever, but seldom.
    let faults = events.iter().filter(|event| matches!(event, Event::Fault { device, .. } if *device == here)).count();
    events.iter().any(end) || here == Place::ROOT && faults >= 3
}

/// Whether whoever is at a place has come to its end: given up, or something that is served or let be.
fn is_settled(events: &[Event], here: Place) -> bool {
    let known = |event: &Event| matches!(event, Event::Unsupported { device, .. } | Event::Attached { device, .. } if *device == here);
    is_given_up(events, here) || events.iter().any(known)
}

/// Whether everybody who was told of at a place was told to have gone, but for the last, who may be there.
fn is_over(events: &[Event], here: Place) -> bool {
    is_given_up(events, here)
        || events.iter().any(|event| matches!(event, Event::Detached { device, .. } if *device == here))
}
