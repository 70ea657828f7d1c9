//! The session of the five systems that the project grows out of: what each of them showed, a few frames of each.
//!
//! Like the demonstration's it is made from formulas, so that every machine makes the same file.

use controls::{Acceleration, Button, Buttons, DualShock3Report};
use firmware::scene::Scene;
use firmware::style::Style;

use crate::session::{self, ScenePart};

const HEADER: &str = "\
# The pictures of the five systems that Halfspace grows out of, a few frames of each.
#
# Made from formulas (xtask/src/generated/seeds.rs, written by `cargo xtask generate`), not held by hand.
#
# `scene NAME` starts a scene, `scene NAME STYLE` in another style than its own. Every other line is a frame: a
# DualShock 3's report, 49 bytes in hexadecimal, or `-` for a frame without one.

";

/// Raw readings of an accelerometer at rest, and its counts for 1 g.
const REST: f64 = 511.0;
const GRAVITY: f64 = 113.0;

/// A pad in a frame.
#[derive(Default)]
pub(super) struct Hand {
    /// In degrees.
    pub(super) roll: f64,
    pub(super) pitch: f64,
    pub(super) held: Vec<Button>,
    /// Sticks, −1 to 1, right and up positive.
    pub(super) left: [f64; 2],
    pub(super) right: [f64; 2],
}

impl Hand {
    /// Returns what the pad says.
    pub(super) fn report(self) -> [u8; DualShock3Report::LENGTH] {
        // Of f64's functions only sums, products and square roots give the same everywhere: so sines come from
        // whole degrees by Bhaskara's formula, which is near enough for a hand.
        let sine = |degrees: f64| {
            let size = degrees.abs() * (180.0 - degrees.abs());
            4.0 * size / (40_500.0 - size) * degrees.signum()
        };
        let cosine = |degrees: f64| sine(90.0 - degrees.abs());
        let raw = [sine(self.roll) * cosine(self.pitch), -sine(self.pitch), -cosine(self.roll) * cosine(self.pitch)];
        let stick = |[x, y]: [f64; 2]| [x, -y].map(|way| (128.0 + way * 127.0) as u8);
        DualShock3Report {
            held: self.held.into_iter().collect::<Buttons>(),
            left_stick: stick(self.left),
            right_stick: stick(self.right),
            acceleration: Acceleration::from_raw(raw.map(|part| (REST + GRAVITY * part).round() as u16)),
            ..DualShock3Report::default()
        }
        .to_bytes()
    }
}

fn part(scene: Scene, style: Option<Style>, frames: u32, hand: impl Fn(u32) -> Hand) -> ScenePart {
    ScenePart { scene, style, frames: (0..frames).map(|frame| Some(hand(frame).report())).collect() }
}

/// Returns the buttons that are pressed in a frame: each is down in the frame that it stands beside.
fn taps(frame: u32, taps: &[(u32, Button)]) -> Vec<Button> {
    taps.iter().filter(|(at, _)| *at == frame).map(|(_, button)| *button).collect()
}

/// Returns the session's text.
pub fn text() -> String {
    let part_of = |frame: u32, frames: u32| f64::from(frame) / f64::from(frames);
    let parts = [
        // A: the plate with the matrices of 2014, tilted, then frozen.
        part(Scene::Plate, None, 12, |frame| Hand {
            roll: 4.0 * f64::from(frame.min(8)),
            pitch: 6.0 * f64::from(frame),
            held: [taps(frame, &[(0, Button::Circle)]), if frame >= 9 { vec![Button::Cross] } else { vec![] }].concat(),
            ..Hand::default()
        }),
        // B: many objects, smooth, the camera going round and nearer; then parallel.
        part(Scene::Solids, None, 20, |frame| Hand {
            held: taps(frame, &[(16, Button::Square)]),
            right: [0.5, if frame < 12 { 0.4 } else { 0.0 }],
            ..Hand::default()
        }),
        // B: flat, and the camera flies into the scene.
        part(Scene::Solids, Some(Style::Flat), 24, |frame| Hand {
            held: taps(frame, &[(1, Button::Circle)]),
            pitch: 8.0 * part_of(frame, 24),
            roll: 12.0 * part_of(frame, 24),
            right: [0.0, 1.0],
            left: [0.3, 0.0],
        }),
        // C: turned, moved and brought through the viewing plane, step by step.
        part(Scene::Wireframe, None, 31, |frame| Hand {
            held: match frame {
                0..=11 => vec![Button::Left],
                12..=15 => vec![Button::Up],
                16..=25 => vec![Button::R2],
                26 => vec![Button::Circle],
                _ => vec![Button::Down],
            },
            ..Hand::default()
        }),
        // C: what the faces hide is hidden.
        part(Scene::Wireframe, Some(Style::HiddenLines), 20, |frame| Hand {
            held: vec![if frame < 14 { Button::Right } else { Button::Down }],
            ..Hand::default()
        }),
        // D: depth as grey, and a colour a polygon.
        part(Scene::Polygons, None, 10, |frame| Hand { roll: 2.0 * f64::from(frame), ..Hand::default() }),
        part(Scene::Polygons, Some(Style::Flat), 10, |frame| Hand {
            pitch: -2.0 * f64::from(frame),
            ..Hand::default()
        }),
        // E: a triangle at a time, edge functions, many of them; flat as there, and smooth.
        part(Scene::Torus, None, 6, |_| Hand { pitch: -10.0, ..Hand::default() }),
        part(Scene::Torus, Some(Style::Smooth), 6, |_| Hand { roll: 10.0, ..Hand::default() }),
        // The model that is built in, for there is no file in memory.
        part(Scene::Model, None, 10, |frame| Hand { pitch: 2.0 * f64::from(frame), ..Hand::default() }),
        // The game that A was to be, in another style than its own, while it counts down.
        part(Scene::Game, Some(Style::Smooth), 40, |frame| Hand {
            roll: if frame < 3 { 0.0 } else { 9.0 },
            pitch: 6.0,
            ..Hand::default()
        }),
    ];
    format!("{HEADER}{}", session::format(&parts))
}

#[cfg(test)]
mod tests {
    use super::*;
    use controls::Tilt;

    #[test]
    fn the_session_reads_back_and_the_pad_tilts_as_far_as_it_says() {
        let parts = session::parse(&text()).expect("a well-formed session");
        let titles: Vec<String> = parts.iter().map(ScenePart::title).collect();
        assert_eq!(titles[0], "plate");
        assert_eq!(titles[4], "wireframe-hidden-lines");
        let tilt = |frame: usize| {
            let report = parts[0].frames[frame].expect("a report a frame");
            Tilt::from_acceleration(DualShock3Report::parse(&report).expect("a good report").acceleration)
        };
        let near = |found: fixed::types::I16F16, expected: f64| (found.to_num::<f64>() - expected).abs() < 2.0;
        assert!(near(tilt(8).roll, 32.0) && near(tilt(8).pitch, 48.0), "{:?}", tilt(8));
    }
}
