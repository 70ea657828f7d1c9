//! What there is to look at.
//!
//! | module | what it holds |
//! | --- | --- |
//! | [`found`] | the model of a mesh file |
//! | [`meshes`] | the shapes that scenes put together |
//! | [`stage`] | one frame of a scene: objects, camera, light |
//!
//! What a scene does from frame to frame stands in [`act`](crate::act).

pub mod found;
pub mod meshes;
mod plate;
pub mod stage;

use crate::style::Style;

/// A scene of the viewer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scene {
    /// The plate, tilted by the controller.
    Plate,
    /// A closed mesh of 4,096 triangles, turning.
    Torus,
    /// The same mesh from inside its tube: all around the eye, faces cross the near plane.
    Tunnel,
    /// Several objects, each with its model matrix, under a coloured light; a camera that orbits or flies.
    Solids,
    /// Lines, turned and moved by steps behind a viewing plane.
    Wireframe,
    /// Convex polygons of many corners that cut through one another.
    Polygons,
    /// The model of a mesh file: the one that was found in memory, or the one that is built in.
    Model,
    /// The Ultimate Ball Balancer: a ball on the plate, targets, a clock.
    Game,
}

impl Scene {
    /// All scenes, in the order in which Start goes through them.
    pub const ALL: &'static [Scene] = &[
        Scene::Plate,
        Scene::Torus,
        Scene::Tunnel,
        Scene::Solids,
        Scene::Wireframe,
        Scene::Polygons,
        Scene::Model,
        Scene::Game,
    ];

    /// Returns the scene's name.
    pub fn name(self) -> &'static str {
        match self {
            Scene::Plate => "plate",
            Scene::Torus => "torus",
            Scene::Tunnel => "tunnel",
            Scene::Solids => "solids",
            Scene::Wireframe => "wireframe",
            Scene::Polygons => "polygons",
            Scene::Model => "model",
            Scene::Game => "game",
        }
    }

    /// Returns the style that the scene begins in.
    pub fn style(self) -> Style {
        match self {
            Scene::Plate | Scene::Torus | Scene::Tunnel | Scene::Game => Style::Flat,
            Scene::Solids | Scene::Model => Style::Smooth,
            Scene::Wireframe => Style::Wire,
            Scene::Polygons => Style::DepthGrey,
        }
    }

    /// Returns the scene of a number, the last one if it is too large.
    pub fn from_index(index: usize) -> Self {
        Self::ALL.get(index).copied().unwrap_or(Scene::Game)
    }

    /// Returns the scene's number.
    pub fn index(self) -> usize {
        self as usize
    }
}
