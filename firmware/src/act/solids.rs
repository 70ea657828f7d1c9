//! Several objects under a coloured light, each with its model matrix, and a camera that moves: it orbits them, or
//! flies.

use controls::ControllerState;
use fixed::types::{I2F30, I16F16, I32F32};
use geometry::{Angle, DirectionalLight, Matrix, Vector};

use super::Perform;
use super::pose::{Flight, Pose, outlook};
use super::switch::Switch;
use crate::scene::meshes::Shape;
use crate::scene::stage::{Camera, Object, Stage, lens};
use crate::style::{Manner, Style};

/// From the orbiting eye to the middle, in world units; and how far down it looks, in degrees.
const DISTANCE: I16F16 = I16F16::lit("6");
const ELEVATION: I16F16 = I16F16::lit("22");
/// Farthest that the objects reach from the middle.
const REACH: I32F32 = I32F32::lit("2.6");
/// The near plane of an eye that may go anywhere, and the far one.
const PLANES: (I32F32, I32F32) = (I32F32::lit("0.25"), I32F32::lit("20"));
/// How far the flying eye sees in the style that shows depth.
const SIGHT: I32F32 = I32F32::lit("7");
/// What the objects turn by in a frame: a turn in six seconds.
const RATE: Angle = Angle::from_bits(((1u64 << 32) / 360) as u32);

/// An evening sun, from the left in front.
const SUN: DirectionalLight = DirectionalLight {
    // A unit vector.
    direction: [I2F30::lit("-0.6"), I2F30::lit("0.64"), I2F30::lit("0.48")],
    colour: [255, 205, 140],
    diffuse: I16F16::lit("0.8"),
    ambient: I16F16::lit("0.22"),
};

/// The objects and who looks at them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Solids {
    turned: Angle,
    pose: Pose,
    flight: Flight,
    /// Flight instead of orbit.
    mode: Switch,
}

impl Solids {
    /// Their beginning.
    pub const START: Self = Self { turned: Angle::ZERO, pose: Pose::START, flight: Flight::START, mode: Switch::FIRST };

    fn camera(&self, state: &ControllerState, manner: Manner) -> Camera {
        let (near, far) = PLANES;
        if self.mode.is_on() {
            let planes = if manner.style == Style::DepthGrey { (near, SIGHT) } else { (near, far) };
            return Camera {
                view: self.flight.view(state),
                projection: lens(manner.projection, DISTANCE.into(), planes),
            };
        }
        let distance = self.pose.distance(DISTANCE);
        let planes = match manner.style {
            Style::DepthGrey => ((distance - REACH).max(near), distance + REACH),
            _ => (near, far),
        };
        let [x, y] = self.pose.pan.map(I32F32::from);
        let view = Matrix::translation([x, y, -distance]).times(&outlook(state, ELEVATION, self.pose.spin));
        Camera { view, projection: lens(manner.projection, distance, planes) }
    }
}

impl Perform for Solids {
    fn update(&mut self, state: &ControllerState) {
        self.turned = self.turned.plus(RATE);
        let flew = self.mode.is_on();
        self.mode.update(state);
        if self.mode.is_on() {
            if !flew {
                // It takes off from where it was.
                let [x, y] = self.pose.pan.map(I32F32::from);
                let away = [-x, -y, self.pose.distance(DISTANCE)];
                self.flight =
                    Flight::from_orbit(&outlook(state, ELEVATION, self.pose.spin), away, self.pose.spin, ELEVATION);
            }
            self.flight.update(state);
        } else {
            self.pose.update(state);
        }
    }

    fn centre(&mut self) {
        (self.pose, self.flight) = (Pose::START, Flight::START);
    }

    fn mode(&self) -> Option<&'static str> {
        Some(if self.mode.is_on() { "the camera flies" } else { "the camera orbits" })
    }

    fn stage(&self, state: &ControllerState, manner: Manner) -> Stage {
        let mut stage = Stage::new(self.camera(state, manner), SUN, manner.style);
        let turned = |times: u32| self.turned.times(times);
        let tilted = Matrix::rotation_x(turned(1)).times(&Matrix::rotation_z(Angle::from_bits(1 << 28)));
        for (shape, at, turn, scale) in [
            (Shape::Box, [0, -106, 0], Matrix::IDENTITY, [195, 6, 195]),
            (Shape::Ring, [0, 15, 0], Matrix::rotation_y(turned(1)).times(&tilted), [62; 3]),
            (Shape::Sphere, [0, 15, 0], Matrix::IDENTITY, [30; 3]),
            // Scaled by three different factors, and turning.
            (Shape::Sphere, [-135, -10, 30], Matrix::rotation_z(turned(2)), [26, 80, 45]),
            (Shape::Plate, [135, -10, 30], Matrix::rotation_y(turned(3)).times(&tilted), [60; 3]),
            (Shape::Box, [0, -60, -135], Matrix::rotation_y(turned(2).negated()), [50, 40, 25]),
            (Shape::Pyramid, [-130, -60, -130], Matrix::rotation_y(turned(1)), [35, 40, 35]),
            (Shape::Pyramid, [0, -70, 145], Matrix::rotation_y(turned(1).negated()), [35, 30, 35]),
        ] {
            let model = Matrix::translation(hundredths(at)).times(&turn).times(&Matrix::scaling(hundredths(scale)));
            stage = stage.with(Object::new(shape, model));
        }
        stage
    }
}

/// A vector given in hundredths.
fn hundredths(parts: [i32; 3]) -> Vector {
    parts.map(|part| I32F32::from_num(part) / 100)
}
