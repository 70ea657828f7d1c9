//! What the scenes do: each has its state, which controls move and which makes a [`Stage`].
//!
//! | module | scenes |
//! | --- | --- |
//! | [`exhibit`] | one model that the pad tilts: the plate, the torus |
//! | [`tunnel`] | a ride through the torus |
//! | [`pose`] | what sticks and keys move in these |

use controls::ControllerState;

use crate::scene::Scene;
use crate::scene::stage::Stage;
use crate::style::Manner;

pub mod exhibit;
pub mod pose;
pub mod tunnel;

use exhibit::Exhibit;
use tunnel::Tunnel;

/// What a scene does.
pub trait Perform {
    /// Goes one frame on, moved by the controls. Not called while the pose is frozen.
    fn update(&mut self, state: &ControllerState);

    /// Takes everything that sticks and keys have moved back to its beginning.
    fn centre(&mut self);

    /// Returns what there is to draw, in this manner.
    fn stage(&self, state: &ControllerState, manner: Manner) -> Stage;
}

/// The scene that is played.
#[derive(Debug, Clone, Copy)]
pub enum Act {
    /// The plate or the torus.
    Exhibit(Exhibit),
    /// The tunnel.
    Tunnel(Tunnel),
}

impl Act {
    /// Returns the beginning of a scene.
    pub fn new(scene: Scene) -> Self {
        match scene {
            Scene::Plate => Self::Exhibit(Exhibit::PLATE),
            Scene::Torus => Self::Exhibit(Exhibit::TORUS),
            Scene::Tunnel => Self::Tunnel(Tunnel::new()),
        }
    }

    /// Returns what the scene does.
    pub fn perform(&mut self) -> &mut dyn Perform {
        match self {
            Self::Exhibit(exhibit) => exhibit,
            Self::Tunnel(tunnel) => tunnel,
        }
    }
}
