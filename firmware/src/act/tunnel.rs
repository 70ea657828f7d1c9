//! A ride through the torus: its tube is all around the eye, and faces cross the near plane.

use controls::ControllerState;
use fixed::types::{I2F30, I16F16, I32F32};
use geometry::{Angle, Culling, DirectionalLight, Matrix};

use super::Perform;
use super::pose::Pose;
use crate::scene::meshes::{Shape, TORUS_RADIUS};
use crate::scene::stage::{Camera, Object, Stage, perspective};
use crate::style::Manner;

/// What the ride goes on by in a frame.
const RATE: Angle = Angle::from_bits((1 << 31) / 180);

/// Where in the tube the eye is, and which way it looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tunnel {
    travelled: Angle,
    pose: Pose,
}

impl Tunnel {
    /// Returns the ride's beginning.
    pub fn new() -> Self {
        Self { travelled: Angle::ZERO, pose: Pose::START }
    }

    /// The camera inside the tube, looking along it.
    fn ride(&self) -> Matrix {
        let moved = |axis: usize| I32F32::from(self.pose.pan[axis]) / 10;
        // The tube turns round the eye, which stays on the z axis looking along −x.
        Matrix::rotation_y(Angle::QUARTER.negated())
            .times(&Matrix::translation([I32F32::ZERO, -moved(1), -I32F32::from(TORUS_RADIUS) - moved(0)]))
            .times(&Matrix::rotation_y(self.travelled))
    }
}

impl Default for Tunnel {
    fn default() -> Self {
        Self::new()
    }
}

impl Perform for Tunnel {
    fn update(&mut self, state: &ControllerState) {
        self.travelled = self.travelled.plus(RATE);
        self.pose.update(state);
    }

    fn centre(&mut self) {
        self.pose = Pose::START;
    }

    fn stage(&self, state: &ControllerState, manner: Manner) -> Stage {
        let view = Matrix::rotation_z(Angle::from_degrees(state.tilt.roll).negated());
        let view = view.times(&Matrix::rotation_x(Angle::from_degrees(state.tilt.pitch).negated()));
        let view = view.times(&Matrix::rotation_y(self.pose.spin)).times(&self.ride());
        let (near, far) = (I32F32::from_num(0.1), I32F32::from_num(4));
        // A tube has no outside: a parallel projection would show nothing.
        let camera = Camera { view, projection: perspective(const { I16F16::lit("75") }, near, far) };
        // The tube is seen from its back.
        let tube = Object { culling: Culling::None, ..Object::new(Shape::Torus, Matrix::IDENTITY) };
        Stage::new(camera, headlamp(&view), manner.style).with(tube)
    }
}

/// Light from the eye.
fn headlamp(view: &Matrix) -> DirectionalLight {
    // The view's third row: backwards, in world space.
    let [x, y, z, _] = view.rows[2];
    DirectionalLight {
        direction: [x, y, z].map(I2F30::saturating_from_num),
        colour: [255; 3],
        diffuse: const { I16F16::lit("0.7") },
        ambient: const { I16F16::lit("0.4") },
    }
}
