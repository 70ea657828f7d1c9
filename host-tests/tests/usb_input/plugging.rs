//! Plugging in, pulling out in every stage, swapping, faults and what follows them.

use controls::Button;
use usb_input::{Event, Kind, Place};
use usb_model::dualshock3::{Temper, dualshock3};
use usb_model::keyboard::{Form, keyboard};
use usb_model::rogue::{Habit, Rogue};
use usb_model::simple_hub::Ports;
use usb_model::wire::Speed;

use crate::bench::{Bench, place, shared};

const NONE: [String; 0] = [];

/// Checks that a keyboard that is plugged in now works, and takes it out again.
fn the_next_keyboard_works(bench: &mut Bench, ports: &Ports, port: u8) {
    bench.events.clear();
    let keys = shared(keyboard(Form::Boot, Speed::Low));
    bench.plug_into(ports, port, keys.clone());
    bench.run_until_attached(place(&[port]), Kind::BootKeyboard);
    keys.borrow_mut().function.press(0x2C);
    bench.run(60_000);
    assert!(bench.state().frozen);
    assert_eq!(bench.faults(), NONE);
    ports.unplug(port);
    bench.run(300_000);
    assert!(!bench.state().frozen, "what was held is let go");
    assert_eq!(bench.detached(), [place(&[port])]);
}

#[test]
fn in_out_in_again_and_swapped() {
    for through_hub in [false, true] {
        let mut bench = Bench::new();
        let hub = through_hub.then(|| bench.plug_hub(Speed::High, 2).1);
        let here = if through_hub { place(&[1]) } else { Place::ROOT };
        bench.run(500_000);
        bench.events.clear();
        for round in 0..3 {
            let keys = shared(keyboard(Form::Boot, Speed::Low));
            let pad = shared(dualshock3(Temper::Sony));
            let plug = |bench: &Bench, device| match &hub {
                Some(ports) => bench.plug_into(ports, 1, device),
                None => bench.host.plug(device),
            };
            plug(&bench, keys.clone());
            bench.run_until_attached(here, Kind::BootKeyboard);
            keys.borrow_mut().function.press(0x2C);
            bench.run(60_000);
            assert!(bench.state().frozen, "round {round}");
            // The pad takes the keyboard's place at once: nobody saw the port empty.
            if let Some(ports) = &hub {
                ports.unplug(1);
            }
            plug(&bench, pad.clone());
            bench.run_until_attached(here, Kind::DualShock3);
            assert!(!bench.state().frozen);
            bench.run(30_000);
            assert!(bench.state().pad_present);
            match &hub {
                Some(ports) => ports.unplug(1),
                None => bench.host.unplug(),
            }
            bench.run(500_000);
            assert!(!bench.state().pad_present);
            assert_eq!(bench.attached(), [(here, Kind::BootKeyboard), (here, Kind::DualShock3)]);
            assert_eq!(bench.detached(), [here; 2]);
            assert_eq!(bench.faults(), NONE, "through a hub: {through_hub}");
            bench.events.clear();
        }
        assert_eq!(bench.host.pipes(), usize::from(through_hub), "the hub's");
    }
}

#[test]
fn a_hub_takes_what_hangs_on_it_along() {
    let mut bench = Bench::new();
    let (_, ports) = bench.plug_hub(Speed::High, 3);
    let (inner, more) = bench.hub(Speed::Full, 3);
    bench.plug_into(&ports, 2, inner);
    let keys = shared(keyboard(Form::Boot, Speed::Low));
    bench.plug_into(&more, 3, keys.clone());
    bench.plug_into(&more, 1, shared(dualshock3(Temper::Sony)));
    bench.run_until_attached(place(&[2, 3]), Kind::BootKeyboard);
    bench.run_until_attached(place(&[2, 1]), Kind::DualShock3);
    keys.borrow_mut().function.press(0x28);
    bench.run(60_000);
    assert!(bench.state().held.contains(Button::Start) && bench.state().pad_present);
    ports.unplug(2);
    bench.run(400_000);
    assert!(bench.state().held.is_empty() && !bench.state().pad_present);
    let mut gone = bench.detached();
    gone.sort_by_key(ToString::to_string);
    assert_eq!(gone, [place(&[2]), place(&[2, 1]), place(&[2, 3])]);
    assert_eq!(bench.host.pipes(), 1);
    bench.host.unplug();
    bench.run(20_000);
    assert_eq!((bench.host.pipes(), bench.detached().len()), (0, 4));
}

#[test]
fn pulled_at_any_moment_it_is_gone_and_the_next_one_works() {
    let mut bench = Bench::new();
    let (_, ports) = bench.plug_hub(Speed::High, 2);
    bench.run(500_000);
    for after_ms in (0..330).step_by(3) {
        let pad = shared(dualshock3(Temper::Sony));
        bench.plug_into(&ports, 1, pad);
        bench.run(after_ms * 1_000);
        ports.unplug(1);
        bench.run(600_000);
        assert!(!bench.state().pad_present, "after {after_ms} ms");
        assert_eq!(bench.host.pipes(), 1, "after {after_ms} ms");
        the_next_keyboard_works(&mut bench, &ports, 1 + (after_ms % 2) as u8);
    }
}

/// Goes silent at its first transaction, its second, and so on, beyond the first reports.
#[test]
fn silent_from_any_transaction_on_it_is_given_up_and_the_next_one_works() {
    let mut bench = Bench::new();
    let (_, ports) = bench.plug_hub(Speed::High, 2);
    bench.run(500_000);
    for transactions in 0..130 {
        bench.events.clear();
        let pad = shared(Rogue::new(dualshock3(Temper::Sony), Habit::Silent, transactions, 1, 0));
        bench.plug_into(&ports, 1, pad);
        bench.run(4_000_000);
        let faults = bench.faults();
        assert!(faults.last().unwrap().contains("given up"), "after {transactions}: {:#?}", bench.events);
        assert_eq!(faults.len(), 4, "three failures, then the end: {faults:#?}");
        assert!(!ports.is_enabled(1) && !bench.state().pad_present);
        ports.unplug(1);
        bench.run(300_000);
        the_next_keyboard_works(&mut bench, &ports, 1);
    }
}

#[test]
fn a_device_that_says_not_now_for_ever_is_given_up_in_time() {
    for transactions in [0, 1, 5, 12, 20, 30] {
        let mut bench = Bench::new();
        let (_, ports) = bench.plug_hub(Speed::High, 2);
        bench.run(500_000);
        let keys = shared(Rogue::new(keyboard(Form::Boot, Speed::Full), Habit::Naks, transactions, 1, 0));
        bench.plug_into(&ports, 1, keys);
        // Three attempts of five seconds, and their resets.
        bench.run(16_500_000);
        // With its configuration chosen, saying "not now" is a keyboard's right.
        let given_up = bench.faults().last().is_some_and(|fault| fault.contains("given up"));
        assert!(given_up || bench.attached().len() == 2, "after {transactions}: {:#?}", bench.events);
        assert!(given_up || transactions > 12, "after {transactions}: {:#?}", bench.events);
        the_next_keyboard_works(&mut bench, &ports, 2);
    }
}

#[test]
fn a_halted_endpoint_is_cleared() {
    let mut bench = Bench::new();
    let keys = shared(keyboard(Form::Boot, Speed::Full));
    bench.host.plug(keys.clone());
    bench.run_until_attached(Place::ROOT, Kind::BootKeyboard);
    keys.borrow_mut().function.press(0x04);
    bench.run(50_000);
    keys.borrow_mut().halt(1);
    bench.run(50_000);
    keys.borrow_mut().function.press(0x2C);
    bench.run(50_000);
    assert!(bench.state().frozen, "the toggle is DATA0 again on both sides");
    assert_eq!((bench.reports.len(), bench.faults()), (2, vec![]));
}

#[test]
fn a_short_report_is_told_once_and_the_rest_is_read() {
    let mut bench = Bench::new();
    let keys = shared(keyboard(Form::Boot, Speed::Full));
    bench.host.plug(keys.clone());
    bench.run_until_attached(Place::ROOT, Kind::BootKeyboard);
    for length in [3, 7, 1] {
        keys.borrow_mut().function.report_bytes(vec![0; length]);
    }
    keys.borrow_mut().function.press(0x2C);
    bench.run(100_000);
    assert!(bench.state().frozen);
    assert_eq!(bench.faults(), ["root: report of 3 bytes is too short: dropped"]);
}

#[test]
fn the_root_ports_device_is_never_given_up() {
    let mut bench = Bench::new();
    bench.host.plug(shared(Rogue::new(keyboard(Form::Boot, Speed::High), Habit::Silent, 0, 1, 0)));
    bench.run(45_000_000);
    let faults = bench.faults();
    assert!((6..=9).contains(&faults.len()), "three at once, then one every ten seconds: {faults:#?}");
    bench.host.plug(shared(keyboard(Form::Boot, Speed::Low)));
    bench.run_until_attached(Place::ROOT, Kind::BootKeyboard);
}

#[test]
fn too_much_current_at_the_root_port_is_told_of() {
    let mut bench = Bench::new();
    bench.host.plug(shared(keyboard(Form::Boot, Speed::Low)));
    bench.run_until_attached(Place::ROOT, Kind::BootKeyboard);
    bench.host.trip();
    bench.run(20_000);
    assert_eq!(bench.faults(), ["root: a port draws too much current: unplug what is there"]);
    assert_eq!(bench.detached(), [Place::ROOT]);
    let gone = Event::Detached { device: Place::ROOT, kind: Some(Kind::BootKeyboard) };
    assert!(bench.events.contains(&gone));
}
