//! Sessions of a player, through the public interface alone.

use controls::{
    Acceleration, Battery, Button, Buttons, Config, ControllerState, Controls, DualShock3Report, KeyboardReport,
    LowPass, ReportError, Source, Stick, Tilt,
};
use fixed::types::{I2F14, I16F16};

const LEFT: u8 = 0x50;
const RIGHT: u8 = 0x4F;
const UP: u8 = 0x52;
const SPACE: u8 = 0x2C;
const W: u8 = 0x1A;
const D: u8 = 0x07;
const R: u8 = 0x15;
const Z: u8 = 0x1D;

/// A pad that leans to the left by this many degrees.
fn leaning(degrees: f64, held: &[Button]) -> [u8; 49] {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let raw = [511.0 + 113.0 * sine, 511.0, 511.0 - 113.0 * cosine].map(|word| word.round() as u16);
    let held = held.iter().copied().collect();
    DualShock3Report { held, acceleration: Acceleration::from_raw(raw), ..Default::default() }.to_bytes()
}

fn keys(usages: &[u8]) -> [u8; 8] {
    let mut report = KeyboardReport::default();
    report.usages[..usages.len()].copy_from_slice(usages);
    report.to_bytes()
}

fn unfiltered() -> Controls {
    Controls::new(Config { low_pass: LowPass::Off, ..Config::default() })
}

fn roll(state: ControllerState) -> i32 {
    state.tilt.roll.round().to_num()
}

#[test]
fn nothing_connected_is_nothing_done() {
    assert_eq!(Controls::new(Config::default()).state(), ControllerState::default());
}

#[test]
fn a_pad_gives_tilt_sticks_buttons_and_battery() {
    let mut controls = unfiltered();
    let report = DualShock3Report {
        held: Buttons::from_iter([Button::L1, Button::Ps]),
        left_stick: [0xFF, 0xFF],
        right_stick: [0x00, 0x00],
        battery: Battery::Charging,
        acceleration: Acceleration::from_raw([591, 511, 431]),
    };
    controls.accept_dualshock3(&report.to_bytes()).unwrap();
    let state = controls.state();
    assert_eq!(state.tilt, Tilt { roll: I16F16::from_num(45), pitch: I16F16::ZERO });
    assert_eq!(state.pan(), Stick { x: I2F14::ONE, y: I2F14::NEG_ONE });
    assert_eq!((state.turn(), state.zoom()), (I2F14::NEG_ONE, I2F14::ONE));
    assert_eq!((state.held, state.pressed), (report.held, report.held));
    assert_eq!((state.pad_present, state.battery), (true, Battery::Charging));
    assert_eq!(state.last_moved, Some(Source::DualShock3));
}

#[test]
fn a_tap_between_frames_is_seen_and_a_repeated_report_is_not() {
    let mut controls = unfiltered();
    controls.accept_dualshock3(&leaning(0.0, &[])).unwrap();
    controls.end_frame();
    for held in [&[Button::Start][..], &[]] {
        controls.accept_dualshock3(&leaning(0.0, held)).unwrap();
    }
    let start = Buttons::from(Button::Start);
    let state = controls.state();
    assert_eq!((state.held, state.pressed, state.released), (Buttons::NONE, start, start));
    controls.end_frame();
    for _ in 0..5 {
        controls.accept_dualshock3(&leaning(0.0, &[])).unwrap();
    }
    let state = controls.state();
    assert_eq!((state.pressed, state.released), (Buttons::NONE, Buttons::NONE));
}

#[test]
fn one_button_held_twice_goes_up_once() {
    let mut controls = unfiltered();
    controls.accept_dualshock3(&leaning(0.0, &[Button::Cross])).unwrap();
    controls.accept_keyboard(&keys(&[SPACE])).unwrap();
    controls.end_frame();
    controls.accept_dualshock3(&leaning(0.0, &[])).unwrap();
    assert_eq!(controls.state().released, Buttons::NONE);
    assert!(controls.state().frozen);
    controls.accept_keyboard(&keys(&[])).unwrap();
    assert_eq!(controls.state().released, Button::Cross.into());
    assert!(!controls.state().frozen);
}

#[test]
fn cross_freezes_the_pose_and_release_shows_the_one_of_that_moment() {
    let mut controls = Controls::new(Config::default());
    controls.accept_dualshock3(&leaning(20.0, &[])).unwrap();
    let before = controls.state().tilt;
    for _ in 0..60 {
        controls.accept_dualshock3(&leaning(60.0, &[Button::Cross])).unwrap();
        assert!(controls.state().frozen);
        assert_eq!(controls.state().tilt, before);
        controls.end_frame();
    }
    controls.accept_dualshock3(&leaning(60.0, &[])).unwrap();
    assert!(!controls.state().frozen);
    assert_eq!(roll(controls.state()), 60, "the low-pass went on");
}

#[test]
fn a_pad_that_is_pulled_out_while_it_freezes_lets_go() {
    let mut controls = unfiltered();
    controls.accept_dualshock3(&leaning(30.0, &[])).unwrap();
    controls.accept_dualshock3(&leaning(50.0, &[Button::Cross, Button::L1])).unwrap();
    controls.accept_keyboard(&keys(&[Z, 0x28])).unwrap();
    assert_eq!(roll(controls.state()), 30);
    controls.end_frame();
    controls.disconnect(Source::DualShock3);
    let state = controls.state();
    assert_eq!(state.held, Button::Start.into(), "the keyboard's stays");
    assert_eq!(state.released, Buttons::from_iter([Button::Cross, Button::L1]));
    assert_eq!((state.frozen, state.pad_present, state.battery), (false, false, Battery::Unknown));
    assert_eq!((roll(state), state.zoom()), (50, I2F14::ONE));
    controls.end_frame();
    controls.disconnect(Source::Keyboard);
    let state = controls.state();
    assert_eq!((state.held, state.released, state.zoom()), (Buttons::NONE, Button::Start.into(), I2F14::ZERO));
    assert_eq!(roll(state), 50);
}

#[test]
fn a_held_arrow_turns_to_a_right_angle_and_release_keeps_it() {
    let mut controls = Controls::new(Config::default());
    controls.accept_keyboard(&keys(&[LEFT, UP])).unwrap();
    assert_eq!(controls.state().tilt, Tilt::LEVEL);
    controls.end_frame();
    assert_eq!(controls.state().tilt, Tilt { roll: I16F16::lit("1.5"), pitch: I16F16::lit("1.5") });
    for _ in 0..100 {
        controls.end_frame();
    }
    let quarter = I16F16::from_num(90);
    assert_eq!(controls.state().tilt, Tilt { roll: quarter, pitch: quarter });
    controls.accept_keyboard(&keys(&[])).unwrap();
    controls.end_frame();
    controls.end_frame();
    assert_eq!(controls.state().tilt, Tilt { roll: quarter, pitch: quarter });
    controls.accept_keyboard(&keys(&[RIGHT])).unwrap();
    controls.end_frame();
    assert_eq!(controls.state().tilt.roll, I16F16::lit("88.5"));
    controls.accept_keyboard(&keys(&[RIGHT, LEFT])).unwrap();
    controls.end_frame();
    controls.end_frame();
    assert_eq!(controls.state().tilt.roll, I16F16::lit("88.5"), "both arrows are none");
}

#[test]
fn a_tapped_key_is_one_frame_of_it() {
    let mut controls = Controls::new(Config::default());
    for report in [keys(&[LEFT]), keys(&[]), keys(&[W]), keys(&[])] {
        controls.accept_keyboard(&report).unwrap();
    }
    assert_eq!(controls.state().pan().y, I2F14::ONE);
    controls.end_frame();
    assert_eq!(controls.state().tilt.roll, I16F16::lit("1.5"));
    assert_eq!(controls.state().pan(), Stick::CENTRE);
    controls.end_frame();
    assert_eq!(controls.state().tilt.roll, I16F16::lit("1.5"));
    controls.accept_keyboard(&keys(&[RIGHT])).unwrap();
    controls.end_frame();
    controls.accept_keyboard(&keys(&[])).unwrap();
    controls.end_frame();
    assert_eq!(controls.state().tilt.roll, 0, "a key that is down at one frame's end turns once");
    controls.accept_keyboard(&keys(&[LEFT])).unwrap();
    controls.end_frame();
    for report in [keys(&[LEFT, Z]), keys(&[])] {
        controls.accept_keyboard(&report).unwrap();
    }
    controls.end_frame();
    assert_eq!(controls.state().tilt.roll, I16F16::lit("1.5"), "another key does not press it again");
}

#[test]
fn every_key_of_an_axis_pushes_its_way() {
    /// Usage, then the signs of roll, pitch, pan x, pan y, turn and zoom.
    const PUSHES: [(u8, [i32; 6]); 18] = [
        (0x50, [1, 0, 0, 0, 0, 0]),
        (0x4F, [-1, 0, 0, 0, 0, 0]),
        (0x52, [0, 1, 0, 0, 0, 0]),
        (0x51, [0, -1, 0, 0, 0, 0]),
        (0x07, [0, 0, 1, 0, 0, 0]),
        (0x04, [0, 0, -1, 0, 0, 0]),
        (0x1A, [0, 0, 0, 1, 0, 0]),
        (0x16, [0, 0, 0, -1, 0, 0]),
        (0x08, [0, 0, 0, 0, 1, 0]),
        (0x14, [0, 0, 0, 0, -1, 0]),
        (0x2E, [0, 0, 0, 0, 0, 1]),
        (0x57, [0, 0, 0, 0, 0, 1]),
        (0x4B, [0, 0, 0, 0, 0, 1]),
        (0x1D, [0, 0, 0, 0, 0, 1]),
        (0x2D, [0, 0, 0, 0, 0, -1]),
        (0x56, [0, 0, 0, 0, 0, -1]),
        (0x4E, [0, 0, 0, 0, 0, -1]),
        (0x1B, [0, 0, 0, 0, 0, -1]),
    ];
    for (usage, signs) in PUSHES {
        let mut controls = Controls::new(Config::default());
        controls.accept_keyboard(&keys(&[usage])).unwrap();
        controls.end_frame();
        let state = controls.state();
        let tilt = [state.tilt.roll, state.tilt.pitch].map(|angle| angle.signum().to_num::<i32>());
        let sticks = [state.pan().x, state.pan().y, state.turn(), state.zoom()].map(|axis| axis.to_num::<i32>());
        assert_eq!([&tilt[..], &sticks].concat(), signs, "usage {usage:#04x}");
        assert!(state.held.is_empty());
    }
}

#[test]
fn keys_that_take_the_tilt_keep_it_from_a_pad_that_had_crept() {
    let mut controls = unfiltered();
    let at = |count: u16| {
        let acceleration = Acceleration::from_raw([511 + count, 511, 398]);
        DualShock3Report { acceleration, ..Default::default() }.to_bytes()
    };
    controls.accept_dualshock3(&at(0)).unwrap();
    controls.accept_dualshock3(&at(4)).unwrap();
    controls.accept_keyboard(&keys(&[LEFT])).unwrap();
    controls.end_frame();
    controls.accept_keyboard(&keys(&[])).unwrap();
    controls.end_frame();
    controls.accept_dualshock3(&at(8)).unwrap();
    assert_eq!(controls.state().tilt.roll, I16F16::lit("1.5"));
    controls.accept_dualshock3(&at(9)).unwrap();
    assert!(controls.state().tilt.roll > 4);
}

#[test]
fn the_tilt_is_of_whichever_moved_last() {
    let mut controls = unfiltered();
    controls.accept_dualshock3(&leaning(30.0, &[])).unwrap();
    assert_eq!(roll(controls.state()), 30);
    controls.accept_keyboard(&keys(&[LEFT])).unwrap();
    for _ in 0..20 {
        controls.end_frame();
        controls.accept_dualshock3(&leaning(31.0, &[])).unwrap(); // the hand is not quite still
    }
    assert_eq!(roll(controls.state()), 60, "the keys turn on from the pad's 30 degrees");
    assert_eq!(controls.state().last_moved, Some(Source::Keyboard));
    controls.accept_keyboard(&keys(&[])).unwrap();
    controls.accept_dualshock3(&leaning(10.0, &[])).unwrap();
    assert_eq!(roll(controls.state()), 10, "the pad moved");
    assert_eq!(controls.state().last_moved, Some(Source::DualShock3));
}

#[test]
fn reset_levels_the_tilt_until_the_pad_moves() {
    let mut controls = unfiltered();
    controls.accept_dualshock3(&leaning(30.0, &[])).unwrap();
    controls.accept_keyboard(&keys(&[R])).unwrap();
    assert_eq!(controls.state().tilt, Tilt::LEVEL);
    assert!(controls.state().pressed.contains(Button::R3));
    controls.accept_dualshock3(&leaning(31.0, &[])).unwrap();
    assert_eq!(controls.state().tilt, Tilt::LEVEL);
    controls.accept_dualshock3(&leaning(40.0, &[])).unwrap();
    assert_eq!(roll(controls.state()), 40);
}

#[test]
fn pad_and_keys_push_a_stick_together_to_no_more_than_one() {
    let mut controls = unfiltered();
    let pushed = DualShock3Report { left_stick: [0xFF, 0x80], ..Default::default() };
    controls.accept_dualshock3(&pushed.to_bytes()).unwrap();
    controls.accept_keyboard(&keys(&[W, D])).unwrap();
    assert_eq!(controls.state().pan(), Stick { x: I2F14::ONE, y: I2F14::ONE });
}

#[test]
fn too_many_keys_keep_what_was_held() {
    let mut controls = Controls::new(Config::default());
    controls.accept_keyboard(&keys(&[SPACE])).unwrap();
    let before = controls.state();
    controls.accept_keyboard(&[0, 0, 1, 1, 1, 1, 1, 1]).unwrap();
    assert_eq!(controls.state(), before);
}

#[test]
fn frames_of_a_serial_line_do_the_same_as_reports() {
    let mut controls = unfiltered();
    controls.accept_frame(0x01, &leaning(30.0, &[Button::Circle])).unwrap();
    controls.accept_frame(0x02, &keys(&[SPACE])).unwrap();
    assert_eq!(controls.state().held, Buttons::from_iter([Button::Circle, Button::Cross]));
    controls.accept_frame(0x03, &[0x01]).unwrap();
    assert_eq!(controls.state().held, Button::Cross.into());
    controls.accept_frame(0x03, &[0x02]).unwrap();
    assert!(controls.state().held.is_empty());
    let before = controls.state();
    let refused = [
        (0x00, &[][..], ReportError::UnknownKind { found: 0x00 }),
        (0x40, &[1], ReportError::UnknownKind { found: 0x40 }),
        (0x01, &[1; 48], ReportError::DualShock3Length { found: 48 }),
        (0x02, &[0; 9], ReportError::KeyboardLength { found: 9 }),
        (0x03, &[], ReportError::DisconnectedLength { found: 0 }),
        (0x03, &[1, 2], ReportError::DisconnectedLength { found: 2 }),
        (0x03, &[4], ReportError::UnknownSource { found: 4 }),
    ];
    for (kind, payload, error) in refused {
        assert_eq!(controls.accept_frame(kind, payload), Err(error));
        assert_eq!(controls.state(), before);
    }
}
