//! Random reports of random lengths: no panic, no impossible state, no change by a bad one.

mod random;

use controls::{Button, Buttons, Config, ControllerState, Controls, LowPass, Source, StickResponse};
use fixed::types::{I2F14, I16F16};
use random::Random;

/// What the edges must be, kept in the plainest way: a count of every change.
#[derive(Default)]
struct Model {
    pad: u32,
    keyboard: u32,
    pressed: u32,
    released: u32,
}

impl Model {
    fn change(&mut self, pad: u32, keyboard: u32) {
        for bit in (0..17).map(|bit| 1 << bit) {
            let before = (self.pad | self.keyboard) & bit != 0;
            let now = (pad | keyboard) & bit != 0;
            if now && !before {
                self.pressed |= bit;
            }
            if before && !now {
                self.released |= bit;
            }
        }
        (self.pad, self.keyboard) = (pad, keyboard);
    }
}

fn plausible(state: &ControllerState) {
    let within = |angle: I16F16, limit: i32| (-limit..=limit).contains(&angle.ceil().to_num::<i32>());
    assert!(within(state.tilt.roll, 180) && within(state.tilt.pitch, 90), "{state:?}");
    for axis in [state.left_stick.x, state.left_stick.y, state.right_stick.x, state.right_stick.y] {
        assert!((I2F14::NEG_ONE..=I2F14::ONE).contains(&axis), "{state:?}");
    }
    assert_eq!(state.frozen, state.held.contains(Button::Cross));
}

fn random_report(random: &mut Random, buffer: &mut [u8; 80]) -> (u8, usize) {
    random.fill(buffer);
    let kind = [0x01, 0x01, 0x01, 0x02, 0x02, 0x02, 0x03, random.next() as u8][random.below(8)];
    if kind == 0x03 {
        buffer[0] &= 3;
    }
    let mut length = match kind {
        0x01 => 49,
        0x02 => 8,
        _ => 1,
    };
    match random.below(10) {
        0 => length = random.below(buffer.len()),
        1 => {}
        _ if kind == 0x01 => {
            (buffer[0], buffer[1]) = (0x01, 0x00);
            for high in [41, 43, 45] {
                buffer[high] &= 0x03;
            }
        }
        _ if kind == 0x02 => {
            for usage in &mut buffer[2..8] {
                *usage = if *usage < 0x80 { *usage & 0x3F } else { 0 };
            }
        }
        _ => {}
    }
    (kind, length)
}

#[test]
fn three_hundred_thousand_random_reports() {
    let mut random = Random::new(0x1CE_CAFE);
    let mut buffer = [0; 80];
    let (mut accepted, mut refused, mut frozen) = (0, 0, 0);
    for (low_pass, width, rate) in
        [(LowPass::Quarter, 4, 1.5), (LowPass::Off, 0, -32_000.0), (LowPass::Sixteenth, 255, 32_000.0)]
    {
        let mut controls = Controls::new(Config {
            low_pass,
            tilt_dead_zone_counts: width,
            stick_response: StickResponse::Progressive,
            key_tilt_degrees_per_frame: I16F16::from_num(rate),
        });
        let mut model = Model::default();
        for _ in 0..100_000 {
            let before = controls.state();
            let (kind, length) = random_report(&mut random, &mut buffer);
            let report = &buffer[..length];
            let result = controls.accept_frame(kind, report);
            let state = controls.state();
            plausible(&state);
            if result.is_ok() {
                accepted += 1;
                let (pad, keyboard) = (model.pad, model.keyboard);
                match (kind, report) {
                    (0x01, _) => {
                        assert!(length == 49 && report[0] == 0x01 && report[1] != 0xFF && state.pad_present);
                        model.change(u32::from_le_bytes([report[2], report[3], report[4] & 1, 0]), keyboard);
                    }
                    (0x02, _) if report[2..].iter().any(|usage| (1..=3).contains(usage)) => assert_eq!(state, before),
                    (0x02, _) => model.change(pad, key_buttons(report)),
                    (_, [1]) => model.change(0, keyboard),
                    (_, [2]) => model.change(pad, 0),
                    // The panel, which holds nothing here.
                    _ => {}
                }
                if state.frozen && before.frozen {
                    assert_eq!(state.tilt, before.tilt);
                    frozen += 1;
                }
            } else {
                refused += 1;
                assert_eq!(state, before, "a bad report changed something");
            }
            assert_eq!(state.held.bits(), model.pad | model.keyboard);
            assert_eq!((state.pressed.bits(), state.released.bits()), (model.pressed, model.released));
            if random.below(3) == 0 {
                controls.end_frame();
                (model.pressed, model.released) = (0, 0);
                plausible(&controls.state());
                assert_eq!(controls.state().pressed, Buttons::NONE);
            }
        }
        controls.disconnect(Source::DualShock3);
        controls.disconnect(Source::Keyboard);
        assert!(controls.state().held.is_empty());
    }
    assert!(accepted > 150_000 && refused > 30_000 && frozen > 20_000, "{accepted} {refused} {frozen}");
}

/// The buttons that a keyboard report holds, by a table of its own.
fn key_buttons(report: &[u8]) -> u32 {
    let button = |usage: &u8| match usage {
        0x2A => 1 << 0,
        0x09 => 1 << 1,
        0x15 => 1 << 2,
        0x28 | 0x58 => 1 << 3,
        0x0C => 1 << 4,
        0x0F => 1 << 5,
        0x0E => 1 << 6,
        0x0D => 1 << 7,
        0x20 => 1 << 8,
        0x21 => 1 << 9,
        0x1E => 1 << 10,
        0x1F => 1 << 11,
        0x2B => 1 << 12,
        0x06 => 1 << 13,
        0x2C => 1 << 14,
        0x19 => 1 << 15,
        0x0B | 0x29 | 0x38 => 1 << 16,
        _ => 0,
    };
    report[2..].iter().map(button).fold(0, |held, bit| held | bit)
}
