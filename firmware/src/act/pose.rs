//! How far sticks and keys have turned, moved and zoomed a model, or flown the eye.

use controls::ControllerState;
use fixed::types::{I2F14, I16F16, I32F32};
use geometry::matrix::dot;
use geometry::{Angle, Matrix, Vector};

/// How near and far zooming goes, as multiples of the scene's own distance.
const ZOOM_RANGE: (I16F16, I16F16) = (I16F16::lit("0.5"), I16F16::lit("1.8"));
/// What a fully pushed stick changes the zoom by in a frame.
const ZOOM_RATE: I16F16 = I16F16::lit("0.02");
/// What a fully pushed stick moves the model by in a frame, in world units.
const PAN_RATE: I16F16 = I16F16::lit("0.04");
/// How far the model can be moved from the middle.
const PAN_LIMIT: I16F16 = I16F16::lit("2.5");
/// What a fully pushed stick turns by in a frame: 3°.
const TURN_RATE: u32 = (3u64 * (1 << 32) / 360) as u32;

/// What sticks and keys have moved.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pose {
    /// About the upright axis.
    pub spin: Angle,
    /// The distance, as a multiple of the scene's own.
    pub zoom: I16F16,
    /// To the right and up, in world units.
    pub pan: [I16F16; 2],
}

impl Pose {
    /// Nothing moved.
    pub const START: Self = Self { spin: Angle::ZERO, zoom: I16F16::ONE, pan: [I16F16::ZERO; 2] };

    /// Moves by a frame's sticks and keys.
    pub fn update(&mut self, state: &ControllerState) {
        self.spin = self.spin.plus(turned_by(state.turn()));
        let rate = |stick: I2F14, rate: I16F16| I16F16::from_num(stick).saturating_mul(rate);
        self.zoom = (self.zoom - rate(state.zoom(), ZOOM_RATE)).clamp(ZOOM_RANGE.0, ZOOM_RANGE.1);
        for (pan, stick) in self.pan.iter_mut().zip([state.pan().x, state.pan().y]) {
            *pan = (*pan + rate(stick, PAN_RATE)).clamp(-PAN_LIMIT, PAN_LIMIT);
        }
    }

    /// Returns the distance of a camera whose own is `distance`.
    pub fn distance(&self, distance: I16F16) -> I32F32 {
        I32F32::from(distance.saturating_mul(self.zoom))
    }

    /// Returns the camera above the middle, looking down on it by `elevation` degrees.
    pub fn orbit(&self, distance: I16F16, elevation: I16F16) -> Matrix {
        let [x, y] = self.pan.map(I32F32::from);
        Matrix::translation([x, y, -self.distance(distance)]).times(&Matrix::rotation_x(Angle::from_degrees(elevation)))
    }
}

/// How near a fully pushed stick flies in a frame, in world units.
const FLIGHT_RATE: I32F32 = I32F32::lit("0.05");
/// How far the flying eye may go from the middle, in any axis.
const FLIGHT_LIMIT: I32F32 = I32F32::lit("8");

/// An eye that flies: sticks move it the way that it looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Flight {
    eye: Vector,
    heading: Angle,
    /// How far down it looks with a level pad, in degrees.
    decline: I16F16,
}

impl Flight {
    /// In front of the middle, looking at it.
    pub const START: Self =
        Self { eye: [I32F32::ZERO, I32F32::ZERO, I32F32::lit("5")], heading: Angle::ZERO, decline: I16F16::ZERO };

    /// Returns the eye of an orbit: its view turns by `outlook` and then moves by −`away`; it heads by `heading` and
    /// looks down by `decline` degrees.
    pub fn from_orbit(outlook: &Matrix, away: Vector, heading: Angle, decline: I16F16) -> Self {
        Self { eye: turned_back(outlook, away), heading, decline }
    }

    /// Moves by a frame's sticks and keys.
    pub fn update(&mut self, state: &ControllerState) {
        self.heading = self.heading.plus(turned_by(state.turn()));
        let rate = |stick: I2F14| I32F32::from(stick).saturating_mul(FLIGHT_RATE);
        let step = [rate(state.pan().x), rate(state.pan().y), -rate(state.zoom())];
        let step = turned_back(&self.outlook(state), step);
        for (eye, step) in self.eye.iter_mut().zip(step) {
            *eye = eye.saturating_add(step).clamp(-FLIGHT_LIMIT, FLIGHT_LIMIT);
        }
    }

    /// Returns its view, with the controller's tilt: pitch looks up and down, roll banks.
    pub fn view(&self, state: &ControllerState) -> Matrix {
        self.outlook(state).times(&Matrix::translation(self.eye.map(I32F32::saturating_neg)))
    }

    fn outlook(&self, state: &ControllerState) -> Matrix {
        outlook(state, self.decline, self.heading)
    }
}

/// Returns how an eye is turned that heads by `heading` and looks down by `decline` degrees, with the controller's
/// tilt.
pub fn outlook(state: &ControllerState, decline: I16F16, heading: Angle) -> Matrix {
    Matrix::rotation_z(Angle::from_degrees(state.tilt.roll).negated())
        .times(&Matrix::rotation_x(Angle::from_degrees(decline.saturating_sub(state.tilt.pitch))))
        .times(&Matrix::rotation_y(heading))
}

/// A vector turned by the opposite of a rotation.
fn turned_back(rotation: &Matrix, vector: Vector) -> Vector {
    [0, 1, 2].map(|axis| dot([0, 1, 2].map(|row: usize| rotation.rows[row][axis]), vector))
}

/// Returns the angle that a stick turns by in a frame.
pub fn turned_by(stick: I2F14) -> Angle {
    Angle::from_bits(((i64::from(stick.to_bits()) * i64::from(TURN_RATE)) >> 14) as u32)
}
