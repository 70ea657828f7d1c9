//! The model that stands for all that are found in memory: a knot, whose pictures are golden on every machine.

use anyhow::Context;
use firmware::scene::Scene;
use models::compile::{Options, compile};

use crate::model;
use crate::paths::workspace_root;
use crate::session::ScenePart;

/// Where it comes from.
pub const SOURCE: &str = "assets/knot.glb";
/// Where its last frame's picture lies.
pub const PICTURE: &str = "docs/seeds/model-in-memory.png";
/// Frames; it turns by itself.
const FRAMES: usize = 20;

/// Returns the mesh file.
///
/// # Errors
/// When the model cannot be read.
pub fn file() -> anyhow::Result<Vec<u8>> {
    let model = model::read(&workspace_root().join(SOURCE))?;
    Ok(compile(&model, &Options::default()).with_context(|| format!("cannot use {SOURCE}"))?.bytes)
}

/// Returns the scene that shows it.
pub fn parts() -> Vec<ScenePart> {
    vec![ScenePart { scene: Scene::Model, style: None, frames: vec![None; FRAMES] }]
}
