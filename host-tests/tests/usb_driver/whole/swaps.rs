//! One device in another's place, at any moment.

use dwc2_host::{Config, SpeedLimit};
use usb_input::{Event, Kind, Place};
use usb_model::dualshock3::{Temper, dualshock3};
use usb_model::hub::Hub;
use usb_model::keyboard::{Form, keyboard};
use usb_model::shared::Shared;
use usb_model::wire::Speed;

use super::{Whole, port};

/// A hub's news come every 256 ms, at full speed every 255: any moment between two of them, and a bit more.
const MOMENTS_US: u64 = 300_000;

/// What is connected while the hub is asked about, or has just been told to forget, the one that went is found as well.
#[test]
fn whoever_takes_anothers_place_is_found() {
    for limit in [SpeedLimit::High, SpeedLimit::Full] {
        let mut whole = Whole::new(Config::new().with_speed_limit(limit));
        let hub = Shared::new(Hub::new(Speed::High));
        whole.rig.plug(hub.clone());
        assert!(whole.run_until(1_000_000, |whole| !whole.events.is_empty()));
        let mut speeds = [Speed::Low, Speed::Full, Speed::High].into_iter().cycle();
        for moment in (0..MOMENTS_US).step_by(1_000) {
            hub.lock().plug(1, Box::new(keyboard(Form::Boot, speeds.next().unwrap_or(Speed::Low))));
            whole.run(moment);
            hub.lock().plug(1, Box::new(keyboard(Form::List, speeds.next().unwrap_or(Speed::Low))));
            let found = whole.run_until(1_000_000, |whole| whole.is_attached(port(1), Kind::ReportKeyboard));
            assert!(found, "{limit:?}, after {moment} us: {:?}", whole.events);
            drop(hub.lock().unplug(1));
            whole.run(300_000);
            assert!(whole.is_detached(port(1)));
            assert!(!whole.events.iter().any(|event| matches!(event, Event::Fault { .. })), "{:?}", whole.events);
            whole.events.clear();
        }
    }
}

/// What is said to the one that was reset is not said to the one that takes its place, whatever speeds they have.
#[test]
fn whoever_goes_while_it_starts_breaks_no_rule() {
    for speeds in [[Speed::High, Speed::Full], [Speed::Low, Speed::High]] {
        let mut whole = Whole::new(Config::new());
        let hub = Shared::new(Hub::new(Speed::High));
        // Somebody who is read, so that the hub is spoken to all the time.
        hub.lock().plug(2, Box::new(keyboard(Form::Boot, Speed::Low)));
        whole.rig.plug(hub.clone());
        assert!(whole.run_until(1_000_000, |whole| whole.is_attached(port(2), Kind::BootKeyboard)));
        // The hub tells of it, it settles, is reset, and is asked for all that it has.
        for moment in (100_000..500_000).step_by(1_700) {
            let [first, second] = speeds.map(|speed| Box::new(keyboard(Form::Boot, speed)));
            hub.lock().plug(1, first);
            whole.run(moment);
            hub.lock().plug(1, second);
            whole.run(1_200_000);
            assert!(whole.is_attached(port(1), Kind::BootKeyboard), "after {moment} us: {:?}", whole.events);
            drop(hub.lock().unplug(1));
            whole.run(300_000);
            whole.events.clear();
        }
    }
}

/// At any moment of a frame: the core is reset whatever it is at, and whatever interrupts it was to raise.
#[test]
fn the_hub_itself_may_be_pulled_out() {
    let mut whole = Whole::new(Config::new());
    let hub = Shared::new(Hub::new(Speed::High));
    hub.lock().plug(1, Box::new(dualshock3(Temper::Sony)));
    for moment in (0..2_000).step_by(70) {
        whole.rig.plug(hub.clone());
        assert!(whole.run_until(1_500_000, |whole| whole.is_attached(port(1), Kind::DualShock3)));
        let now = whole.now();
        whole.rig.pass_until(now + moment);
        whole.rig.unplug();
        whole.run(10_000);
        assert!(whole.is_detached(port(1)) && whole.is_detached(Place::ROOT), "after {moment} us: {:?}", whole.events);
        whole.events.clear();
    }
}
