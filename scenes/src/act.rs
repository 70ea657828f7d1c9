//! What the scenes do: each has its state, which controls move and which makes a [`Stage`].
//!
//! | module | scenes |
//! | --- | --- |
//! | [`exhibit`] | one model that the pad tilts: the torus, the model of a mesh file |
//! | [`plate`] | the plate, and as the system showed it that tilted it first: [`columbia`] |
//! | [`tunnel`] | a ride through the torus |
//! | [`solids`] | several objects under a coloured light; a camera that orbits or flies |
//! | [`wireframe`] | lines, turned and moved by steps |
//! | [`polygons`] | polygons that cut through one another |
//! | [`balancer`] | the game |
//! | [`pose`] | what sticks and keys move in these |
//! | [`switch`] | which of its two modes a scene is in |

use core::fmt::{self, Write};

use controls::ControllerState;

use crate::scene::Scene;
use crate::scene::stage::Stage;
use crate::style::Manner;

pub mod balancer;
pub mod columbia;
pub mod exhibit;
pub mod plate;
pub mod polygons;
pub mod pose;
pub mod solids;
pub mod switch;
pub mod tunnel;
pub mod wireframe;

use balancer::Balancer;
use exhibit::Exhibit;
use plate::Plate;
use polygons::Polygons;
use solids::Solids;
use tunnel::Tunnel;
use wireframe::Wireframe;

/// What a scene does.
pub trait Perform {
    /// Goes one frame on, moved by the controls. Not called while the pose is frozen.
    fn update(&mut self, state: &ControllerState);

    /// Takes everything that sticks and keys have moved back to its beginning.
    fn centre(&mut self);

    /// Does the same for one who wants the tilt level, too; a scene that can be begun anew is.
    fn reset(&mut self) {
        self.centre();
    }

    /// Returns which of its two modes the scene is in, if it has two.
    fn mode(&self) -> Option<&'static str> {
        None
    }

    /// Returns the points of the game, in the scene that is one.
    fn score(&self) -> Option<u32> {
        None
    }

    /// Tells a person what has happened since it was called last, if the scene has anything to tell.
    ///
    /// # Errors
    /// The console's.
    fn tell(&mut self, _console: &mut dyn Write) -> fmt::Result {
        Ok(())
    }

    /// Returns what there is to draw, in this manner.
    fn stage(&self, state: &ControllerState, manner: Manner) -> Stage;
}

/// The scene that is played.
#[derive(Debug, Clone, Copy)]
pub enum Act {
    /// The plate.
    Plate(Plate),
    /// The torus.
    Torus(Exhibit),
    /// The tunnel.
    Tunnel(Tunnel),
    /// Several objects.
    Solids(Solids),
    /// Lines.
    Wireframe(Wireframe),
    /// Polygons.
    Polygons(Polygons),
    /// The model of a mesh file.
    Model(Exhibit),
    /// The game.
    Game(Balancer),
}

impl Act {
    /// Returns the beginning of a scene.
    pub fn new(scene: Scene) -> Self {
        match scene {
            Scene::Plate => Self::Plate(Plate::START),
            Scene::Torus => Self::Torus(Exhibit::TORUS),
            Scene::Tunnel => Self::Tunnel(Tunnel::new()),
            Scene::Solids => Self::Solids(Solids::START),
            Scene::Wireframe => Self::Wireframe(Wireframe::START),
            Scene::Polygons => Self::Polygons(Polygons::START),
            Scene::Model => Self::Model(Exhibit::FOUND),
            Scene::Game => Self::Game(Balancer::new()),
        }
    }

    /// Returns what the scene does.
    pub fn perform(&mut self) -> &mut dyn Perform {
        match self {
            Self::Plate(plate) => plate,
            Self::Torus(exhibit) | Self::Model(exhibit) => exhibit,
            Self::Tunnel(tunnel) => tunnel,
            Self::Solids(solids) => solids,
            Self::Wireframe(wireframe) => wireframe,
            Self::Polygons(polygons) => polygons,
            Self::Game(balancer) => balancer,
        }
    }
}
