//! What each key does, as the console tells it.

use core::fmt::{self, Write};

use crate::scene::Scene;

/// What holds in every scene.
const EVERYWHERE: &str = "\
keys             pad           board           what
Enter Backspace  Start Select  SW1 SW0 + KEYs  next scene, the one before
Tab              Triangle      SW4 + KEY0      next style: flat, smooth, wireframe, hidden lines, depth as grey
V                Square        SW4 + KEY1      perspective or orthographic
C (2 held)       Circle (R1)   SW4 + KEY2 (SW3)  the scene's other mode
arrows           tilt          KEYs            tilt
W A S D          left stick    SW0 + KEYs      move
Q E, + -         right stick   SW1 + KEYs      turn, nearer and farther
Space            Cross         SW2             freezes while held
R, F             R3, L3        SW1 SW0 + KEYs  level, centre
H ?              PS            SW4 + KEY3      this legend";

/// Tells what each key does, and what is special in a scene.
///
/// # Errors
/// The console's.
pub fn tell(scene: Scene, console: &mut impl Write) -> fmt::Result {
    writeln!(console, "{EVERYWHERE}")?;
    tell_scene(scene, console)
}

/// Tells what a scene is and what its keys do.
///
/// # Errors
/// The console's.
pub fn tell_scene(scene: Scene, console: &mut impl Write) -> fmt::Result {
    writeln!(console, "scene: {}\n  {}", scene.name(), about(scene))
}

fn about(scene: Scene) -> &'static str {
    match scene {
        Scene::Plate => "tilt it with the pad or the arrows; C: with the matrices of the system that tilted it first",
        Scene::Torus => "4,096 triangles",
        Scene::Tunnel => "the torus from inside",
        Scene::Solids => {
            "objects under an evening sun; C: the camera orbits, or flies: + - on and back, Q E to the sides"
        }
        Scene::Wireframe => {
            "arrows or D-pad turn the house, a step each; C: move it; + - (R2 L2) bring it to the viewing plane"
        }
        Scene::Polygons => {
            "polygons of 5, 6 and 12 corners cut through one another; Tab: depth as grey, or their colours"
        }
        Scene::Model => "the mesh file that was found in memory, or a knot",
        Scene::Game => {
            "tilt the plate: arrows, W A S D, a stick or the pad. Roll over the targets and not off; quick ones count \
             more and more. Space: pause; R: another round"
        }
    }
}
