//! Hubs, hubs behind hubs, splits, limits.

use std::rc::Rc;

use usb_input::{Event, Kind, Place};
use usb_model::dualshock3::{Temper, dualshock3};
use usb_model::gamepad::gamepad;
use usb_model::keyboard::{Form, keyboard};
use usb_model::simple_hub::{Ports, Shared};
use usb_model::storage::storage;
use usb_model::wire::Speed;

use crate::bench::{Bench, place, shared};

const NONE: [String; 0] = [];

#[test]
fn a_keyboard_and_a_pad_behind_a_hub_both_work() {
    for hub_speed in [Speed::High, Speed::Full] {
        for keyboard_speed in [Speed::Low, Speed::Full, Speed::High] {
            let mut bench = Bench::new();
            let (hub, ports) = bench.plug_hub(hub_speed, 2);
            let keys = shared(keyboard(Form::Boot, keyboard_speed));
            let pad = shared(dualshock3(Temper::Sony));
            bench.plug_into(&ports, 1, keys.clone());
            bench.plug_into(&ports, 2, pad.clone());
            bench.run_until_attached(place(&[1]), Kind::BootKeyboard);
            bench.run_until_attached(place(&[2]), Kind::DualShock3);
            keys.borrow_mut().function.press(0x28);
            bench.run(50_000);
            let state = bench.state();
            assert!(
                state.pad_present && state.held.contains(controls::Button::Start),
                "{hub_speed:?} {keyboard_speed:?}"
            );
            assert_eq!(bench.faults(), NONE, "{hub_speed:?} {keyboard_speed:?}");
            assert_eq!(ports.violations(), NONE);
            assert_eq!(hub.borrow().leaf().violations(), &NONE);
            assert_eq!((keys.borrow().violations(), pad.borrow().violations()), (&NONE[..], &NONE[..]));
        }
    }
}

#[test]
fn five_devices_at_once_on_eight_pipes() {
    let mut bench = Bench::with(usb_input::Config::default(), Speed::High, 8);
    let (_, ports) = bench.plug_hub(Speed::High, 4);
    let keys = shared(keyboard(Form::Boot, Speed::Low));
    let more_keys = shared(keyboard(Form::Bitmap, Speed::Full));
    let devices: [(Shared, Kind); 4] = [
        (keys.clone(), Kind::BootKeyboard),
        (shared(dualshock3(Temper::Sony)), Kind::DualShock3),
        (shared(gamepad()), Kind::Gamepad),
        (more_keys.clone(), Kind::ReportKeyboard),
    ];
    for (port, (device, _)) in (1..).zip(&devices) {
        bench.plug_into(&ports, port, device.clone());
    }
    for (port, (_, kind)) in (1..).zip(&devices) {
        bench.run_until_attached(place(&[port]), *kind);
    }
    for keys in [&keys, &more_keys] {
        keys.borrow_mut().function.press(0x04);
    }
    bench.run(100_000);
    let from = |wanted: u8| {
        bench
            .reports
            .iter()
            .any(|report| matches!(report, Event::KeyboardReport { device, .. } if *device == place(&[wanted])))
    };
    assert!(from(1) && from(4));
    assert_eq!(bench.faults(), NONE);
}

/// A row of hubs, each on port 2 of the one before, and the last one's ports.
fn row(bench: &Bench, speeds: &[Speed]) -> Ports {
    let (_, mut ports) = bench.plug_hub(speeds[0], 2);
    for &speed in &speeds[1..] {
        let (hub, next) = bench.hub(speed, 2);
        bench.plug_into(&ports, 2, hub);
        ports = next;
    }
    ports
}

#[test]
fn hubs_behind_hubs_split_where_the_speed_changes() {
    use Speed::{Full, High, Low};
    for speeds in
        [&[High, High][..], &[High, Full], &[Full, Full], &[High, High, Full], &[High, Full, Full, Full, Full]]
    {
        for device_speed in [Low, Full, High] {
            let mut bench = Bench::new();
            let ports = row(&bench, speeds);
            let keys = shared(keyboard(Form::Boot, device_speed));
            bench.plug_into(&ports, 1, keys.clone());
            let mut way = vec![2; speeds.len()];
            *way.last_mut().unwrap() = 1;
            bench.run_until_attached(place(&way), Kind::BootKeyboard);
            keys.borrow_mut().function.press(0x2C);
            bench.run(50_000);
            assert!(bench.state().frozen, "{speeds:?} {device_speed:?}");
            assert_eq!(bench.faults(), NONE);
        }
    }
}

#[test]
fn below_five_hubs_is_the_end() {
    let mut bench = Bench::new();
    let ports = row(&bench, &[Speed::Full; 5]);
    let (sixth, _) = bench.hub(Speed::Full, 2);
    bench.plug_into(&ports, 1, shared(keyboard(Form::Boot, Speed::Full)));
    bench.plug_into(&ports, 2, sixth);
    bench.run(4_000_000);
    assert!(bench.attached().contains(&(place(&[2, 2, 2, 2, 1]), Kind::BootKeyboard)));
    assert!(bench.attached().contains(&(place(&[2, 2, 2, 2, 2]), Kind::Hub { ports: 2 })));
    assert_eq!(bench.faults(), NONE, "nothing hangs on it");

    let mut bench = Bench::new();
    let ports = row(&bench, &[Speed::Full; 6]);
    bench.plug_into(&ports, 1, shared(keyboard(Form::Boot, Speed::Full)));
    bench.run(4_000_000);
    assert_eq!(bench.faults(), ["2.2.2.2.2: below more than 5 hubs: plug it in nearer to the board"]);
    assert!(!ports.is_enabled(1));
}

#[test]
fn what_there_is_no_room_for_is_told_and_cut_off() {
    let mut bench = Bench::new();
    let (_, ports) = bench.plug_hub(Speed::High, 7);
    let (inner, more) = bench.hub(Speed::High, 7);
    bench.plug_into(&ports, 7, inner);
    let stick = || -> Shared { Rc::new(std::cell::RefCell::new(storage(Speed::High))) };
    (1..=6).for_each(|port| bench.plug_into(&ports, port, stick()));
    (1..=3).for_each(|port| bench.plug_into(&more, port, stick()));
    bench.run(6_000_000);
    let known = bench.events.iter().filter(|event| matches!(event, Event::Unsupported { .. })).count();
    assert_eq!(known, 8, "two hubs and eight sticks are ten");
    let [fault] = &bench.faults()[..] else { panic!("{:?}", bench.faults()) };
    assert!(fault.ends_with("too many devices: unplug one, and plug this in again"), "{fault}");
    let left_out = if fault.starts_with("7.") {
        (&more, fault.as_bytes()[2] - b'0')
    } else {
        (&ports, fault.as_bytes()[0] - b'0')
    };
    assert!(!left_out.0.is_enabled(left_out.1));
    // With one gone there is room again.
    ports.unplug(if left_out.1 == 1 { 2 } else { 1 });
    left_out.0.unplug(left_out.1);
    bench.run(600_000);
    bench.plug_into(left_out.0, left_out.1, shared(keyboard(Form::Boot, Speed::Full)));
    bench.run(600_000);
    assert!(bench.attached().iter().any(|(_, kind)| *kind == Kind::BootKeyboard), "{:#?}", bench.events);
}

#[test]
fn a_port_with_too_much_current_is_told_of_and_powered_again() {
    let mut bench = Bench::new();
    let (_, ports) = bench.plug_hub(Speed::High, 2);
    bench.run_until_attached(Place::ROOT, Kind::Hub { ports: 2 });
    bench.run(300_000);
    ports.set_over_current(1, true);
    bench.run(300_000);
    assert_eq!(bench.faults(), ["root: a port draws too much current: unplug what is there"]);
    assert!(!ports.is_powered(1));
    ports.set_over_current(1, false);
    bench.run(300_000);
    assert!(ports.is_powered(1));
    bench.plug_into(&ports, 1, shared(keyboard(Form::Boot, Speed::Low)));
    bench.run_until_attached(place(&[1]), Kind::BootKeyboard);
}

#[test]
fn a_port_that_was_cut_off_is_reset() {
    let mut bench = Bench::new();
    let (_, ports) = bench.plug_hub(Speed::Full, 2);
    let keys = shared(keyboard(Form::Boot, Speed::Full));
    bench.plug_into(&ports, 2, keys.clone());
    bench.run_until_attached(place(&[2]), Kind::BootKeyboard);
    ports.cut_off(2);
    bench.run(1_000_000);
    assert_eq!(bench.detached(), [place(&[2])]);
    keys.borrow_mut().function.press(0x2C);
    bench.run(50_000);
    assert!(bench.state().frozen);
}
