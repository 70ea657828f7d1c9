//! The demonstration session of the demonstration.
//!
//! It is made from the formulas below, in integers and in sums and products of `f64`, so that
//! every machine makes the same file.

use controls::{Acceleration, Button, Buttons, DualShock3Report};
use firmware::scene::Scene;
use fixed::types::{I16F16, I24F8};
use geometry::Angle;

use crate::session::{self, ScenePart};

const HEADER: &str = "\
# What a DualShock 3 says while somebody looks at the three scenes of the demonstration.
#
# Nobody held a pad for this: the file is synthesised from formulas (xtask/src/generated/session.rs,
# written by `cargo xtask generate`), with a count or so of noise on the accelerometer as real ones
# have it. The reports have the layout of real ones and go the same way through the firmware.
#
# `scene NAME` starts a scene. Every other line is a frame: the report that comes before it, 49 bytes
# in hexadecimal, or `-` for a frame without one.

";

/// Where the pad is at a frame, in degrees; in between it moves smoothly.
struct Key {
    frame: u32,
    roll: f64,
    pitch: f64,
}

const fn key(frame: u32, roll: f64, pitch: f64) -> Key {
    Key { frame, roll, pitch }
}

/// Level, to the left, to the right, level, nod; then Cross is held while the pad goes on.
const PLATE: &[Key] = &[
    key(4, 0.0, 0.0),
    key(18, 45.0, 0.0),
    key(22, 45.0, 0.0),
    key(42, -45.0, 0.0),
    key(46, -45.0, 0.0),
    key(54, 0.0, 0.0),
    key(60, 0.0, 30.0),
    key(70, -10.0, -30.0),
    key(86, 40.0, 10.0),
    key(95, 0.0, 0.0),
];
const PLATE_FRAMES: u32 = 96;
/// While Cross is held the picture stays as it is.
const FREEZE: std::ops::Range<u32> = 70..84;

const TORUS: &[Key] = &[key(0, 0.0, 0.0), key(12, 20.0, 8.0), key(30, -20.0, -8.0), key(44, 0.0, 0.0)];
const TORUS_FRAMES: u32 = 48;
/// The right stick's way from its centre while it turns the torus.
const TORUS_STICK: i32 = 90;

const TUNNEL: &[Key] =
    &[key(0, 0.0, 0.0), key(15, 12.0, 5.0), key(32, -14.0, -6.0), key(48, 8.0, 4.0), key(58, 0.0, 0.0)];
const TUNNEL_FRAMES: u32 = 60;

/// Returns the session's text.
pub fn text() -> String {
    let mut noise = Noise(0x2014_0001);
    let mut part = |scene, frames, keys: &[Key], touch: &dyn Fn(u32, &mut DualShock3Report)| {
        let frames = (0..frames).map(|frame| {
            let (roll, pitch) = pose(keys, f64::from(frame));
            let acceleration = gravity(roll, pitch, &mut noise);
            let mut report = DualShock3Report { acceleration, ..DualShock3Report::default() };
            touch(frame, &mut report);
            Some(report.to_bytes())
        });
        ScenePart { scene, style: None, frames: frames.collect() }
    };
    let plate = part(Scene::Plate, PLATE_FRAMES, PLATE, &|frame, report| {
        if FREEZE.contains(&frame) {
            report.held = Buttons::from(Button::Cross);
        }
    });
    let torus = part(Scene::Torus, TORUS_FRAMES, TORUS, &|frame, report| {
        // Out to the right and back, in a straight line each.
        let half = TORUS_FRAMES as i32 / 2;
        let way = (half - (frame as i32 - half).abs()) * TORUS_STICK / half;
        report.right_stick[0] = (0x80 + way) as u8;
    });
    let tunnel = part(Scene::Tunnel, TUNNEL_FRAMES, TUNNEL, &|_, _| {});
    format!("{HEADER}{}", session::format(&[plate, torus, tunnel]))
}

/// Roll and pitch at a frame, in degrees.
fn pose(keys: &[Key], frame: f64) -> (f64, f64) {
    let (Some(first), Some(last)) = (keys.first(), keys.last()) else { return (0.0, 0.0) };
    for pair in keys.windows(2) {
        let (from, to) = (f64::from(pair[0].frame), f64::from(pair[1].frame));
        if (from..to).contains(&frame) {
            let part = (frame - from) / (to - from);
            let smooth = part * part * (3.0 - 2.0 * part);
            let between = |a: f64, b: f64| a + (b - a) * smooth;
            return (between(pair[0].roll, pair[1].roll), between(pair[0].pitch, pair[1].pitch));
        }
    }
    let end = if frame < f64::from(first.frame) { first } else { last };
    (end.roll, end.pitch)
}

/// What the accelerometer of a pad at rest reads, with noise.
fn gravity(roll: f64, pitch: f64, noise: &mut Noise) -> Acceleration {
    let sin_cos = |degrees: f64| {
        let (sine, cosine) = Angle::from_degrees(I16F16::from_num(degrees)).sin_cos();
        (sine.to_num::<f64>(), cosine.to_num::<f64>())
    };
    let ((roll_sine, roll_cosine), (pitch_sine, pitch_cosine)) = (sin_cos(roll), sin_cos(pitch));
    let counts = f64::from(Acceleration::COUNTS_PER_G);
    let [x, y, z] = [roll_sine * pitch_cosine, pitch_sine, roll_cosine * pitch_cosine]
        .map(|part| I24F8::from_num(part * counts + noise.next()));
    Acceleration { x, y, z }
}

/// Noise of about a count: xorshift of 32 bits (Marsaglia 2003).
struct Noise(u32);

impl Noise {
    /// Returns a number from −1 up to 1.
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        f64::from(self.0 >> 16) / 32_768.0 - 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_session_reads_back_and_does_what_it_should() {
        let parts = session::parse(&text()).expect("a well-formed session");
        let names: Vec<&str> = parts.iter().map(|part| part.scene.name()).collect();
        assert_eq!(names, ["plate", "torus", "tunnel"]);
        let reports: Vec<DualShock3Report> = parts[0]
            .frames
            .iter()
            .map(|frame| DualShock3Report::parse(&frame.expect("a report a frame")).expect("a good report"))
            .collect();
        let tilts: Vec<controls::Tilt> =
            reports.iter().map(|report| controls::Tilt::from_acceleration(report.acceleration)).collect();
        assert!(tilts.iter().any(|tilt| tilt.roll > 44) && tilts.iter().any(|tilt| tilt.roll < -44));
        assert!(tilts.iter().any(|tilt| tilt.pitch > 28) && tilts.iter().any(|tilt| tilt.pitch < -28));
        let frozen = reports.iter().filter(|report| report.held.contains(Button::Cross)).count();
        assert_eq!(frozen, FREEZE.len());
        assert!(tilts[FREEZE.end as usize].roll - tilts[FREEZE.start as usize].roll > 40, "the pad moves meanwhile");
    }
}
