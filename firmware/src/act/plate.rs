//! The plate, tilted by the pad; in its second mode as the system did that tilted it first.

use controls::ControllerState;
use geometry::Culling;

use super::exhibit::Exhibit;
use super::switch::Switch;
use super::{Perform, columbia};
use crate::scene::meshes::Shape;
use crate::scene::stage::{FULL_LIGHT, Object, Stage};
use crate::style::Manner;

/// The plate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Plate {
    exhibit: Exhibit,
    mode: Switch,
}

impl Plate {
    /// Its beginning.
    pub const START: Self = Self { exhibit: Exhibit::PLATE, mode: Switch::FIRST };
}

impl Perform for Plate {
    fn update(&mut self, state: &ControllerState) {
        self.mode.update(state);
        self.exhibit.update(state);
    }

    fn centre(&mut self) {
        self.exhibit.centre();
    }

    fn mode(&self) -> Option<&'static str> {
        Some(if self.mode.is_on() { "matrices of 2014" } else { "seen from above" })
    }

    fn stage(&self, state: &ControllerState, manner: Manner) -> Stage {
        if !self.mode.is_on() {
            return self.exhibit.stage(state, manner);
        }
        // Three blues, unlit. The screen's rows turned over make it its own mirror image, in which fronts are
        // backs; so all faces are drawn, as there, and depth decides.
        let plate = Object { culling: Culling::None, ..Object::new(Shape::Plate, columbia::tilted(state.tilt)) };
        Stage::new(columbia::camera(), FULL_LIGHT, manner.style).with(plate)
    }
}
