//! Which scene is shown, and how: from what the controllers say to a stage.

use core::fmt::{self, Write};

use controls::{Button, ControllerState};

use crate::act::Act;
use crate::scene::Scene;
use crate::scene::stage::Stage;
use crate::style::{Manner, Style};

/// The scene that is shown, how far it has gone, and how it is drawn.
#[derive(Debug, Clone, Copy)]
pub struct Viewer {
    scene: Scene,
    act: Act,
    manner: Manner,
}

impl Viewer {
    /// Returns the viewer at the beginning of a scene.
    pub fn new(scene: Scene) -> Self {
        let manner = Manner { style: scene.style(), ..Manner::default() };
        Self { scene, act: Act::new(scene), manner }
    }

    /// Returns the scene that is shown.
    pub fn scene(&self) -> Scene {
        self.scene
    }

    /// Returns how it is drawn.
    pub fn manner(&self) -> Manner {
        self.manner
    }

    /// Draws in another style from now on.
    pub fn set_style(&mut self, style: Style) {
        self.manner.style = style;
    }

    /// Returns which of its two modes the scene is in, if it has two.
    pub fn mode(&mut self) -> Option<&'static str> {
        self.act.perform().mode()
    }

    /// Returns the points of the game, in the scene that is one.
    pub fn score(&mut self) -> Option<u32> {
        self.act.perform().score()
    }

    /// Tells a person what has happened in the scene.
    ///
    /// # Errors
    /// The console's.
    pub fn tell(&mut self, console: &mut dyn Write) -> fmt::Result {
        self.act.perform().tell(console)
    }

    /// Takes in a frame's controls. Start and Select change the scene, which begins in its own style; Triangle
    /// changes the style, Square the projection, R3 resets and L3 centres; while the pose is frozen nothing moves.
    pub fn update(&mut self, state: &ControllerState) {
        let count = Scene::ALL.len();
        let step = usize::from(state.pressed.contains(Button::Start))
            + (count - 1) * usize::from(state.pressed.contains(Button::Select));
        if !step.is_multiple_of(count) {
            *self = Self::new(Scene::from_index((self.scene.index() + step) % count));
            return;
        }
        if state.pressed.contains(Button::Triangle) {
            self.manner.style = self.manner.style.next();
        }
        if state.pressed.contains(Button::Square) {
            self.manner.projection = self.manner.projection.other();
        }
        if state.pressed.contains(Button::R3) {
            self.act.perform().reset();
        } else if state.pressed.contains(Button::L3) {
            self.act.perform().centre();
        }
        if !state.frozen {
            self.act.perform().update(state);
        }
    }

    /// Returns what is to be drawn now, with the controller's tilt.
    pub fn stage(&mut self, state: &ControllerState) -> Stage {
        self.act.perform().stage(state, self.manner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stick_that_steers_the_game_can_be_pushed_without_ending_it() {
        let mut viewer = Viewer::new(Scene::Game);
        let frames = |viewer: &mut Viewer, count: usize, pressed: &[Button]| {
            let (pressed, held) = (pressed.iter().copied().collect(), [Button::Right].into_iter().collect());
            (0..count).for_each(|_| viewer.update(&ControllerState { pressed, held, ..ControllerState::default() }));
            let Act::Game(balancer) = &viewer.act else { panic!("the game has gone") };
            *balancer.game()
        };
        assert_eq!(frames(&mut viewer, 600, &[]).countdown(), 0, "it is played");
        assert_eq!(frames(&mut viewer, 1, &[Button::L3]).countdown(), 0);
        assert!(frames(&mut viewer, 1, &[Button::R3]).countdown() > 0, "R3 begins another round");
    }
}
