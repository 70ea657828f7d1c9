//! Each kind of device.

use controls::{Battery, Button, Buttons};
use usb_input::{Config, Event, Kind, Place};
use usb_model::dualshock3::{Temper, dualshock3};
use usb_model::dualshock4::dualshock4;
use usb_model::gamepad::gamepad;
use usb_model::keyboard::{Form, keyboard};
use usb_model::storage::storage;
use usb_model::wire::Speed;

use crate::bench::{Bench, shared};

#[test]
fn a_keyboard_of_any_form_and_speed_types() {
    let forms = [
        (Form::Boot, Kind::BootKeyboard),
        (Form::StubbornBoot, Kind::ReportKeyboard),
        (Form::Bitmap, Kind::ReportKeyboard),
        (Form::List, Kind::ReportKeyboard),
    ];
    for (form, kind) in forms {
        for speed in [Speed::Low, Speed::Full, Speed::High] {
            for whole in [false, true] {
                let mut bench = Bench::new();
                bench.host.set_reads_whole_transfers(whole);
                let keys = shared(keyboard(form, speed));
                bench.host.plug(keys.clone());
                bench.run_until_attached(Place::ROOT, kind);
                keys.borrow_mut().function.press(0x2C);
                keys.borrow_mut().function.press(0xE1);
                bench.run(60_000);
                assert!(bench.state().frozen, "{form:?} {speed:?}: Space freezes");
                let last = bench.reports.last().unwrap();
                let wanted = Event::KeyboardReport { device: Place::ROOT, report: [2, 0, 0x2C, 0, 0, 0, 0, 0] };
                assert_eq!(*last, wanted, "{form:?} {speed:?}");
                keys.borrow_mut().function.release(0x2C);
                bench.run(60_000);
                assert!(!bench.state().frozen);
                assert_eq!(bench.reports.len(), 3, "one for each change");
                assert_eq!(keys.borrow().violations(), &[] as &[String], "{form:?} {speed:?}");
                assert_eq!(bench.faults(), [] as [String; 0], "{form:?} {speed:?}");
                assert_eq!(keys.borrow().function.is_quiet(), form != Form::StubbornBoot);
            }
        }
    }
}

#[test]
fn a_keyboard_tells_who_it_is() {
    let mut bench = Bench::new();
    bench.host.plug(shared(keyboard(Form::Boot, Speed::Low)));
    bench.run_until_attached(Place::ROOT, Kind::BootKeyboard);
    let Event::Attached { identity, .. } = &bench.events[0] else { panic!("{:?}", bench.events) };
    assert_eq!(identity.to_string(), "16d0:0f01 class 0x03, low speed, Halfspace, Model keyboard");
}

#[test]
fn more_keys_than_six_change_nothing() {
    for form in [Form::Boot, Form::List] {
        let mut bench = Bench::new();
        let keys = shared(keyboard(form, Speed::Full));
        bench.host.plug(keys.clone());
        bench.run(300_000);
        for usage in [0x2C, 0x04, 0x05, 0x06, 0x07, 0x08, 0x09] {
            keys.borrow_mut().function.press(usage);
        }
        bench.run(200_000);
        assert_eq!(bench.reports.len(), 7);
        assert!(bench.state().frozen, "{form:?}: as long as nobody says that Space is up");
    }
}

#[test]
fn every_dualshock3_wakes() {
    for temper in [
        Temper::Sony,
        Temper::RefusesReading,
        Temper::RefusesWriting,
        Temper::RefusesBoth,
        Temper::WantsByte,
        Temper::Shanwan,
    ] {
        let mut bench = Bench::new();
        let pad = shared(dualshock3(temper));
        bench.host.plug(pad.clone());
        bench.run_until_attached(Place::ROOT, Kind::DualShock3);
        bench.run(50_000);
        let pad = pad.borrow();
        assert!(pad.function.is_awake(), "{temper:?}");
        assert!(!pad.function.shakes, "{temper:?}");
        assert!(bench.state().pad_present, "{temper:?}");
        assert!(!bench.reports.is_empty(), "{temper:?}");
        assert_eq!(bench.state().battery, Battery::Charging);
        assert_eq!(pad.function.outputs.len(), 1, "{temper:?}");
        assert_eq!((pad.function.outputs[0].len(), pad.function.outputs[0][9]), (35, 0x02), "the first lamp");
        assert_eq!(pad.violations(), &[] as &[String]);
        assert_eq!(bench.faults(), [] as [String; 0], "{temper:?}");
    }
}

#[test]
fn a_dualshock3_turns_the_model() {
    let mut bench = Bench::new();
    let pad = shared(dualshock3(Temper::Sony));
    bench.host.plug(pad.clone());
    bench.run_until_attached(Place::ROOT, Kind::DualShock3);
    pad.borrow_mut().function.set(|report| {
        report[3] = 0x40;
        report[41..43].copy_from_slice(&591_u16.to_be_bytes());
        report[45..47].copy_from_slice(&431_u16.to_be_bytes());
        report[6] = 0;
    });
    bench.run(2_000_000);
    let state = bench.state();
    assert!(state.frozen && state.held == Buttons::from(Button::Cross));
    assert!(state.left_stick.x < 0 && state.left_stick.y == 0);
    pad.borrow_mut().function.set(|report| report[3] = 0);
    bench.run(50_000);
    assert_eq!(bench.state().tilt.roll.to_num::<i32>(), 45);
}

#[test]
fn a_pulse_is_given_when_the_pose_is_frozen_and_only_if_wanted() {
    for wanted in [false, true] {
        let config = Config { player: 3, pulse_on_freeze: wanted };
        let mut bench = Bench::with(config, Speed::High, 16);
        let pad = shared(dualshock3(Temper::Sony));
        bench.host.plug(pad.clone());
        bench.run_until_attached(Place::ROOT, Kind::DualShock3);
        bench.run(100_000);
        for _ in 0..2 {
            bench.usb.set_frozen(true);
            bench.run(300_000);
            bench.usb.set_frozen(false);
            bench.run(300_000);
        }
        let motors: Vec<[u8; 2]> = pad.borrow().function.outputs.iter().map(|output| [output[2], output[9]]).collect();
        let all = [[0, 8], [1, 8], [0, 8], [1, 8], [0, 8]];
        assert_eq!(motors, all[..if wanted { 5 } else { 1 }]);
    }
}

#[test]
fn a_low_battery_is_told_once_until_it_is_charged() {
    let mut bench = Bench::new();
    let pad = shared(dualshock3(Temper::Sony));
    bench.host.plug(pad.clone());
    bench.run(300_000);
    for battery in [0x03, 0x02, 0x01, 0x02, 0xEE, 0x01] {
        pad.borrow_mut().function.set(|report| report[30] = battery);
        bench.run(100_000);
    }
    let low: Vec<_> = bench.events.iter().filter(|event| matches!(event, Event::BatteryLow { .. })).collect();
    let told = |battery| Event::BatteryLow { device: Place::ROOT, battery };
    assert_eq!(low, [&told(Battery::Dying), &told(Battery::Empty)]);
}

#[test]
fn a_dualshock4_is_read_by_its_descriptor_and_its_own_bytes() {
    let mut bench = Bench::new();
    let pad = shared(dualshock4());
    bench.host.plug(pad.clone());
    bench.run_until_attached(Place::ROOT, Kind::DualShock4);
    bench.run(50_000);
    assert_eq!(bench.state().battery, Battery::Charged);
    assert_eq!(bench.state().held, Buttons::NONE);
    pad.borrow_mut().function.set(|report| {
        report[5] = 0x22; // right, and Cross
        report[6] = 0x21; // L1, Options
        report[7] = 0x01; // PS
        report[19..21].copy_from_slice(&8192_i16.to_le_bytes());
        report[21..23].copy_from_slice(&0_i16.to_le_bytes());
    });
    bench.run(1_000_000);
    let held = [Button::Right, Button::Cross, Button::L1, Button::Start, Button::Ps];
    assert_eq!(bench.state().held, Buttons::from_iter(held));
    pad.borrow_mut().function.set(|report| report[5] = 8);
    bench.run(50_000);
    assert_eq!(bench.state().tilt.roll.to_num::<i32>(), 90);
    assert_eq!(pad.borrow().violations(), &[] as &[String]);
}

#[test]
fn a_plain_gamepad_is_read_by_its_descriptor() {
    let mut bench = Bench::new();
    let pad = shared(gamepad());
    bench.host.plug(pad.clone());
    bench.run_until_attached(Place::ROOT, Kind::Gamepad);
    pad.borrow_mut().function.set([0xFF, 0x80, 0x80, 0x00, 0x26, 0x02]);
    bench.run(50_000);
    let state = bench.state();
    assert_eq!(state.held, Buttons::from_iter([Button::Left, Button::Cross, Button::R1]));
    assert!(state.left_stick.x > 0 && state.left_stick.y == 0);
    assert!(state.right_stick.y != 0 && state.right_stick.x == 0);
    assert_eq!(bench.faults(), [] as [String; 0]);
}

#[test]
fn anything_else_is_named_and_left_alone() {
    let mut bench = Bench::new();
    let stick = shared(storage(Speed::High));
    bench.host.plug(stick.clone());
    bench.run(1_000_000);
    let [Event::Unsupported { device: Place::ROOT, identity }] = &bench.events[..] else {
        panic!("{:?}", bench.events)
    };
    assert_eq!(identity.to_string(), "0781:5567 class 0x08, high speed, SanDisk, Cruzer Blade, with a name longer");
    assert!(!stick.borrow().is_configured());
    assert_eq!(bench.host.pipes(), 0);
    bench.host.unplug();
    bench.run(10_000);
    assert_eq!(bench.events[1], Event::Detached { device: Place::ROOT, kind: None });
}
