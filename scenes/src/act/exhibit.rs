//! One model, tilted by the controller, seen from above.

use controls::{ControllerState, Tilt};
use fixed::types::{I16F16, I32F32};
use geometry::{Angle, Matrix};

use super::Perform;
use super::pose::Pose;
use crate::scene::meshes::Shape;
use crate::scene::stage::{Camera, DAYLIGHT, Object, Stage, Subject, lens};
use crate::style::{Manner, Style};

/// A model and its pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Exhibit {
    subject: Subject,
    /// From the eye to its middle, in world units, and how far down the eye looks, in degrees.
    distance: I16F16,
    elevation: I16F16,
    /// What it turns by itself in a frame.
    rate: Angle,
    turned: Angle,
    pose: Pose,
}

/// Farthest that the models reach from their middle, in world units.
const REACH: I32F32 = I32F32::lit("1.6");

impl Exhibit {
    /// The plate at its beginning.
    pub const PLATE: Self = Self {
        subject: Subject::Shape(Shape::Plate),
        distance: I16F16::lit("3.4"),
        elevation: I16F16::lit("30"),
        rate: Angle::ZERO,
        turned: Angle::ZERO,
        pose: Pose::START,
    };
    /// The torus at its beginning, turning.
    pub const TORUS: Self = Self {
        subject: Subject::Shape(Shape::Torus),
        distance: I16F16::lit("4"),
        elevation: I16F16::lit("38"),
        rate: Angle::from_bits((1 << 31) / 90),
        ..Self::PLATE
    };
    /// The model of a mesh file at its beginning, turning.
    pub const FOUND: Self =
        Self { subject: Subject::Found, distance: I16F16::lit("3"), elevation: I16F16::lit("20"), ..Self::TORUS };

    /// Returns the projection of what lies around a point at `distance` from the eye and reaches `reach` from
    /// it, which the near plane cuts only where it all but touches the eye. Where depth is shown it has as many
    /// levels as can be: near and far planes close in on the model.
    pub fn lens(manner: Manner, distance: I32F32, reach: I32F32) -> Matrix {
        let front = (distance - reach).max(const { I32F32::lit("0.1") });
        let planes = match manner.style {
            Style::DepthGrey => (front, distance + reach),
            _ => (front.min(I32F32::ONE), I32F32::from_num(10)),
        };
        lens(manner.projection, distance, planes)
    }
}

impl Perform for Exhibit {
    fn update(&mut self, state: &ControllerState) {
        self.turned = self.turned.plus(self.rate);
        self.pose.update(state);
    }

    fn centre(&mut self) {
        self.pose = Pose::START;
    }

    fn stage(&self, state: &ControllerState, manner: Manner) -> Stage {
        let turning = Matrix::rotation_y(self.pose.spin.plus(self.turned));
        let distance = self.pose.distance(self.distance);
        let camera = Camera {
            view: self.pose.orbit(self.distance, self.elevation),
            projection: Self::lens(manner, distance, REACH),
        };
        Stage::new(camera, DAYLIGHT, manner.style).with(Object::new(self.subject, tilted(state.tilt).times(&turning)))
    }
}

/// Returns how the pad's tilt turns a model.
pub fn tilted(tilt: Tilt) -> Matrix {
    Matrix::rotation_x(Angle::from_degrees(tilt.pitch)).times(&Matrix::rotation_z(Angle::from_degrees(tilt.roll)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::style::Projection;

    #[test]
    fn what_comes_close_is_not_cut_open() {
        for (projection, style) in [Projection::Perspective, Projection::Orthographic]
            .into_iter()
            .flat_map(|projection| Style::ALL.iter().map(move |style| (projection, *style)))
        {
            for tenths in 15..80 {
                let distance = I32F32::from_num(tenths) / 10;
                let lens = Exhibit::lens(Manner { style, projection }, distance, REACH);
                // A hundredth behind the nearest that the model may reach, or that is seen.
                let nearest = (distance - REACH).max(I32F32::lit("0.1")) + I32F32::lit("0.01");
                let at = |row: usize| lens.rows[row][3] - lens.rows[row][2] * nearest;
                assert!(at(2) + at(3) > 0, "{projection:?}, {style:?}: {nearest} is cut off at {distance}");
            }
        }
    }
}
