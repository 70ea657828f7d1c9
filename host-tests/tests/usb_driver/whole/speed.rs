//! The root port held at full speed while everything runs.

use dwc2_host::{Config, SpeedLimit};
use usb_input::{Event, Fallback, Kind};
use usb_model::hub::Hub;
use usb_model::keyboard::{Form, keyboard};
use usb_model::shared::Shared;
use usb_model::wire::Speed;

use super::{Whole, port};

/// The core's pause (1 s), the hub's start and the keyboard's.
const AGAIN_US: u64 = 3_000_000;

#[test]
fn a_bus_that_is_held_at_full_speed_comes_again_and_works() {
    let mut whole = Whole::new(Config::new());
    let hub = Shared::new(Hub::new(Speed::High));
    let typist = Shared::new(keyboard(Form::Boot, Speed::Low));
    hub.lock().plug(2, Box::new(typist.clone()));
    whole.rig.plug(hub.clone());
    let ready = |whole: &Whole| whole.is_attached(port(2), Kind::BootKeyboard);
    assert!(whole.run_until(AGAIN_US, ready), "{:?}", whole.events);
    assert_eq!(hub.lock().link_speed(), Speed::High);

    whole.events.clear();
    whole.rig.driver.limit_speed(SpeedLimit::Full);
    assert!(whole.run_until(AGAIN_US, ready), "{:?}", whole.events);
    assert!(whole.is_detached(port(2)));
    assert_eq!(hub.lock().link_speed(), Speed::Full);
    typist.lock().function.press(0x2C);
    let report = Event::KeyboardReport { device: port(2), report: [0, 0, 0x2C, 0, 0, 0, 0, 0] };
    assert!(whole.run_until(30_000, |whole| whole.reports.contains(&report)));

    // The same limit again changes nothing.
    whole.events.clear();
    whole.rig.driver.limit_speed(SpeedLimit::Full);
    whole.run(AGAIN_US);
    assert_eq!(whole.events, []);
    assert_eq!(whole.rig.take_violations(), [] as [String; 0]);
}

/// A device is given up after three attempts of at most five seconds, and their pauses.
const GIVEN_UP_US: u64 = 20_000_000;

#[test]
fn a_hub_that_translates_nothing_is_used_at_full_speed() {
    let mut whole = Whole::new(Config::new());
    let mut hub = Hub::new(Speed::High);
    hub.break_translator();
    let typist = Shared::new(keyboard(Form::Boot, Speed::Low));
    hub.plug(2, Box::new(typist.clone()));
    whole.rig.plug(hub);
    let (mut fallback, mut seen) = (Fallback::default(), 0);
    let end = whole.now() + GIVEN_UP_US;
    while !whole.events[core::mem::replace(&mut seen, whole.events.len())..].iter().any(|event| fallback.is_due(event))
    {
        assert!(whole.now() < end, "{:?}", whole.events);
        whole.tick();
    }
    assert!(!whole.is_attached(port(2), Kind::BootKeyboard));
    whole.rig.driver.limit_speed(SpeedLimit::Full);
    assert!(whole.run_until(AGAIN_US, |whole| whole.is_attached(port(2), Kind::BootKeyboard)), "{:?}", whole.events);
    assert_eq!(whole.rig.take_violations(), [] as [String; 0]);
}
