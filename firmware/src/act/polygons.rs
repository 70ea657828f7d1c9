//! Convex polygons of five, six and twelve corners that cut through one another; depth decides at each pixel.

use controls::ControllerState;
use fixed::types::{I16F16, I32F32};
use geometry::{Angle, Matrix};

use super::Perform;
use super::exhibit::{Exhibit, tilted};
use super::pose::Pose;
use crate::scene::meshes::Shape;
use crate::scene::stage::{Camera, DAYLIGHT, Object, Stage};
use crate::style::Manner;

/// The polygons and their pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Polygons {
    turned: Angle,
    pose: Pose,
}

const DISTANCE: I16F16 = I16F16::lit("3.8");
const ELEVATION: I16F16 = I16F16::lit("20");
/// Farthest corner from the middle: near and far planes close in on the model, so that all greys are used.
const REACH: I32F32 = I32F32::lit("1.45");
/// What they turn by in a frame: a turn in eight seconds.
const RATE: Angle = Angle::from_bits(((1u64 << 32) / 480) as u32);

impl Polygons {
    /// Their beginning.
    pub const START: Self = Self { turned: Angle::ZERO, pose: Pose::START };
}

impl Perform for Polygons {
    fn update(&mut self, state: &ControllerState) {
        self.turned = self.turned.plus(RATE);
        self.pose.update(state);
    }

    fn centre(&mut self) {
        self.pose = Pose::START;
    }

    fn stage(&self, state: &ControllerState, manner: Manner) -> Stage {
        let camera = Camera {
            view: self.pose.orbit(DISTANCE, ELEVATION),
            projection: Exhibit::lens(manner, self.pose.distance(DISTANCE), REACH),
        };
        let all = tilted(state.tilt).times(&Matrix::rotation_y(self.pose.spin.plus(self.turned)));

        let eighth = Angle::from_bits(1 << 29);
        let lying = Matrix::rotation_z(eighth).times(&Matrix::rotation_x(self.turned));
        Stage::new(camera, DAYLIGHT, manner.style)
            .with(Object::new(
                Shape::Dodecahedron,
                all.times(&Matrix::scaling(const { [I32F32::lit("0.85"), I32F32::lit("0.85"), I32F32::lit("0.85")] })),
            ))
            .with(Object::new(
                Shape::Prism,
                all.times(&lying)
                    .times(&Matrix::scaling(const { [I32F32::lit("0.3"), I32F32::lit("1.35"), I32F32::lit("0.3")] })),
            ))
            .with(Object::new(
                Shape::Disc,
                all.times(&Matrix::rotation_x(eighth))
                    .times(&Matrix::scaling(const { [I32F32::lit("1.2"), I32F32::lit("0.05"), I32F32::lit("1.2")] })),
            ))
    }
}
