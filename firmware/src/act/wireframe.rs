//! Lines, turned, moved and brought nearer step by step.
//!
//! As in "Wireframe Simulator" (MIT 6.111): the eye stays and looks through a window in a plane, the viewing
//! plane; the object moves behind it. What comes in front of the plane is dropped, a line that crosses it is
//! cut there: the viewing plane is the projection's near plane, and the window its extent. Keys ask for steps;
//! one is done a frame, the first that was asked for.

use controls::{ControllerState, Request};
use fixed::types::I32F32;
use geometry::matrix::{cross, dot, normalise, subtract};
use geometry::{Angle, Matrix};

use super::Perform;
use super::switch::Switch;
use crate::scene::meshes::Shape;
use crate::scene::stage::{Camera, DAYLIGHT, Object, Stage};
use crate::style::{Manner, Projection};

/// What a step turns by. Its cosine is 0.99951171875, 2,047/2,048.
pub const TURN: Angle = Angle::from_bits(21_362_284);
/// What a step moves by, to a side, up or down.
pub const PAN: I32F32 = I32F32::lit("0.0625");
/// What a step brings nearer.
pub const ZOOM: I32F32 = I32F32::lit("0.125");
/// How far the object can be moved from its place, in any axis.
const REACH: I32F32 = I32F32::lit("10");
/// From the eye to the far plane: behind all that moves.
const FAR: I32F32 = I32F32::lit("24");

/// Where the eye is, and the window that it looks through.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Window {
    /// The eye.
    pub eye: [I32F32; 3],
    /// z of the viewing plane, below the eye's.
    pub plane: I32F32,
    /// Low and high end in x, in the plane; the screen's left and right edge.
    pub x: (I32F32, I32F32),
    /// Low and high end in y; the screen's lower and upper edge.
    pub y: (I32F32, I32F32),
}

impl Window {
    /// The scene's own.
    pub const OWN: Self = Self {
        eye: [I32F32::ZERO, I32F32::lit("0.25"), I32F32::lit("4")],
        plane: I32F32::lit("1.5"),
        x: (I32F32::lit("-1"), I32F32::ONE),
        y: (I32F32::lit("-0.75"), I32F32::lit("0.75")),
    };

    /// Returns the camera.
    ///
    /// In parallel projection the window is as much larger as it is in perspective at z = 0.
    pub fn camera(&self, projection: Projection) -> Camera {
        let near = self.eye[2].saturating_sub(self.plane);
        let seen = |(low, high): (I32F32, I32F32), eye: I32F32| (low.saturating_sub(eye), high.saturating_sub(eye));
        let (x, y) = (seen(self.x, self.eye[0]), seen(self.y, self.eye[1]));
        let projection = match projection {
            Projection::Perspective => Matrix::frustum(x, y, (near, FAR)),
            Projection::Orthographic => {
                let times = self.eye[2].checked_div(near).unwrap_or(I32F32::ONE);
                let larger = |(low, high): (I32F32, I32F32)| (low.saturating_mul(times), high.saturating_mul(times));
                Matrix::orthographic(larger(x), larger(y), (near, FAR))
            }
        };
        Camera { view: Matrix::translation(self.eye.map(I32F32::saturating_neg)), projection }
    }
}

/// The object's pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wireframe {
    /// Every step so far.
    pose: Matrix,
    /// Arrows move instead of turning.
    mode: Switch,
}

impl Wireframe {
    /// The beginning.
    pub const START: Self = Self { pose: Matrix::IDENTITY, mode: Switch::FIRST };

    /// Does a step: turns about the origin, or moves.
    fn step(&mut self, request: Request) {
        let step = match (request, self.mode.is_on()) {
            (Request::Nearer, _) => Matrix::translation([I32F32::ZERO, I32F32::ZERO, ZOOM]),
            (Request::Farther, _) => Matrix::translation([I32F32::ZERO, I32F32::ZERO, -ZOOM]),
            (Request::Left, false) => Matrix::rotation_y(TURN.negated()),
            (Request::Right, false) => Matrix::rotation_y(TURN),
            (Request::Up, false) => Matrix::rotation_x(TURN.negated()),
            (Request::Down, false) => Matrix::rotation_x(TURN),
            (Request::Left, true) => Matrix::translation([-PAN, I32F32::ZERO, I32F32::ZERO]),
            (Request::Right, true) => Matrix::translation([PAN, I32F32::ZERO, I32F32::ZERO]),
            (Request::Up, true) => Matrix::translation([I32F32::ZERO, PAN, I32F32::ZERO]),
            (Request::Down, true) => Matrix::translation([I32F32::ZERO, -PAN, I32F32::ZERO]),
        };
        self.pose = rigid(&step.times(&self.pose));
    }
}

/// A pose whose axes have the length 1 again and are at right angles, however many steps it came from; and which
/// is not farther off than it may be.
fn rigid(pose: &Matrix) -> Matrix {
    let axis = |row: usize| [pose.rows[row][0], pose.rows[row][1], pose.rows[row][2]];
    let right = normalise(axis(0)).unwrap_or_default();
    let along = dot(axis(1), right);
    let up = normalise(subtract(axis(1), right.map(|part| part.saturating_mul(along)))).unwrap_or_default();
    let mut rigid = *pose;
    for (row, axis) in rigid.rows.iter_mut().zip([right, up, cross(right, up)]) {
        row[..3].copy_from_slice(&axis);
        row[3] = row[3].clamp(-REACH, REACH);
    }
    rigid
}

impl Perform for Wireframe {
    fn update(&mut self, state: &ControllerState) {
        self.mode.update(state);
        if let Some(request) = state.asked {
            self.step(request);
        }
    }

    fn centre(&mut self) {
        self.pose = Matrix::IDENTITY;
    }

    fn mode(&self) -> Option<&'static str> {
        Some(if self.mode.is_on() { "arrows move" } else { "arrows turn" })
    }

    fn stage(&self, _: &ControllerState, manner: Manner) -> Stage {
        let camera = Window::OWN.camera(manner.projection);
        Stage::new(camera, DAYLIGHT, manner.style).with(Object::new(Shape::House, self.pose))
    }
}
