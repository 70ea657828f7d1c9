//! The checksums that frames must have, on every machine: the demonstration's, those of the five systems and of a model
//! in memory.

use anyhow::{Context, bail};
use serde::{Deserialize, Serialize};

use crate::demo::Played;
use crate::paths::workspace_root;
use crate::picture::{self, Picture};
use crate::report::{Report, SceneReport};

/// Where the demonstration's file lies in the workspace.
pub const DEMO: &str = "host-tests/golden/demo.json";
/// Where the five systems' file lies.
pub const SEEDS: &str = "host-tests/golden/seeds.json";

/// Where the file of the model in memory lies.
pub const FOUND: &str = "host-tests/golden/model-in-memory.json";

/// All pictures on one, as the README has it.
pub const SHEET: &str = "docs/scenes.png";
/// Pictures in a row of it.
const COLUMNS: u32 = 4;

/// Folder of the five systems' pictures: the last frame of each part.
pub const PICTURES: &str = "docs/seeds";

/// Returns the last picture of each part and where it lies in the workspace.
pub fn pictures(played: &Played) -> Vec<(String, &Picture)> {
    let last = |scene: &SceneReport| {
        let picture = played.pictures.iter().rfind(|(name, ..)| *name == scene.name);
        picture.map(|(name, _, picture)| (format!("{PICTURES}/{name}.png"), picture))
    };
    played.report.scenes.iter().filter_map(last).collect()
}

/// Returns the last pictures of the five systems' parts and of the model in memory as one, a quarter as large.
///
/// # Errors
/// When there is none.
pub fn sheet(played: &Played, found: &Played) -> anyhow::Result<Picture> {
    let of_systems = pictures(played).into_iter().map(|(_, picture)| picture.halved());
    let of_model = found.pictures.last().map(|(.., picture)| picture.halved());
    let all: Vec<Picture> = of_systems.chain(of_model).collect();
    picture::sheet(&all.iter().collect::<Vec<_>>(), COLUMNS)
}

/// Frame checksums of each scene.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Golden {
    /// In the order in which they are played.
    pub scenes: Vec<GoldenScene>,
}

/// Frame checksums of a scene.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct GoldenScene {
    /// The scene, and the style if it is not its own.
    pub name: String,
    /// One for each frame, as in the report.
    pub frame_checksums: Vec<String>,
}

impl From<&Report> for Golden {
    fn from(report: &Report) -> Self {
        let scenes = report
            .scenes
            .iter()
            .map(|scene| GoldenScene { name: scene.name.clone(), frame_checksums: scene.frame_checksums.clone() });
        Self { scenes: scenes.collect() }
    }
}

impl Golden {
    /// Reads a file; `None` when there is none yet.
    ///
    /// # Errors
    /// When it is there and cannot be read.
    pub fn read(file: &str) -> anyhow::Result<Option<Self>> {
        let path = workspace_root().join(file);
        if !path.exists() {
            return Ok(None);
        }
        let text = std::fs::read_to_string(&path).with_context(|| format!("cannot read {file}"))?;
        serde_json::from_str(&text).map(Some).with_context(|| format!("{file} is malformed"))
    }

    /// Returns the scenes that a run has played too, as long as there, in the run's order.
    #[must_use]
    pub fn played_in(&self, run: &Self) -> Self {
        let same = |one: &GoldenScene, other: &GoldenScene| {
            one.name == other.name && one.frame_checksums.len() == other.frame_checksums.len()
        };
        let of = |played: &GoldenScene| self.scenes.iter().find(|scene| same(scene, played)).cloned();
        Self { scenes: run.scenes.iter().filter_map(of).collect() }
    }

    /// Writes a file.
    ///
    /// # Errors
    /// When the file system refuses.
    pub fn write(&self, file: &str) -> anyhow::Result<()> {
        let text = serde_json::to_string_pretty(self).context("cannot put the checksums into JSON")? + "\n";
        let path = workspace_root().join(file);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).with_context(|| format!("cannot make the folder of {file}"))?;
        }
        std::fs::write(path, text).with_context(|| format!("cannot write {file}"))
    }

    /// Checks that a run has these frames.
    ///
    /// # Errors
    /// The first frame that differs.
    pub fn check(&self, run: &Self) -> anyhow::Result<()> {
        for (expected, found) in self.scenes.iter().zip(&run.scenes) {
            let (name, frames) = (&expected.name, &expected.frame_checksums);
            if *name != found.name || frames.len() != found.frame_checksums.len() {
                let count = found.frame_checksums.len();
                bail!("{} has {count} frames where the golden run has {name} with {}", found.name, frames.len());
            }
            for (index, (expected, found)) in frames.iter().zip(&found.frame_checksums).enumerate() {
                if expected != found {
                    bail!("frame {index} of scene {name} has checksum {found}, the golden run has {expected}");
                }
            }
        }
        if self.scenes.len() != run.scenes.len() {
            bail!("{} scenes were played, the golden run has {}", run.scenes.len(), self.scenes.len());
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn golden(scenes: &[(&str, &[&str])]) -> Golden {
        let scene = |(name, frames): &(&str, &[&str])| GoldenScene {
            name: name.to_string(),
            frame_checksums: frames.iter().map(ToString::to_string).collect(),
        };
        Golden { scenes: scenes.iter().map(scene).collect() }
    }

    #[test]
    fn the_first_difference_is_named() {
        let one = golden(&[("plate", &["0x1", "0x2"]), ("torus", &["0x3"])]);
        let message = |scenes: &[(&str, &[&str])]| one.check(&golden(scenes)).map_err(|error| error.to_string());
        assert_eq!(message(&[("plate", &["0x1", "0x2"]), ("torus", &["0x3"])]), Ok(()));
        for (scenes, expected) in [
            (&[("plate", &["0x1", "0x9"][..]), ("torus", &["0x4"])][..], "frame 1 of scene plate has checksum 0x9"),
            (&[("plate", &["0x1"])], "plate has 1 frames where"),
            (&[("plate", &["0x1", "0x2"])], "1 scenes were played"),
            (&[("torus", &["0x1", "0x2"])], "torus has 2 frames where"),
        ] {
            let message = message(scenes).expect_err("a difference");
            assert!(message.starts_with(expected), "{message}");
        }
    }
}
