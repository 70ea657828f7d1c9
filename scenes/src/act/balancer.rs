//! The Ultimate Ball Balancer: the game, steered by pad, sticks or keys.
//!
//! | module | what it holds |
//! | --- | --- |
//! | [`steering`] | what pad, sticks and keys say, as the game wants it |
//! | [`scenery`] | plate, ball and targets as objects |
//! | [`signs`] | digits in front of it all |

pub mod scenery;
pub mod signs;
pub mod steering;

use core::fmt::{self, Write};

use controls::ControllerState;
use game::{Event, Game, Phase, STEPS_PER_SECOND};

use super::Perform;
use crate::scene::stage::{DAYLIGHT, Stage};
use crate::style::Manner;

/// Frames in a second, as a display shows them.
const FRAMES_PER_SECOND: u32 = 60;
/// Steps of the game in a frame.
const STEPS: usize = (STEPS_PER_SECOND / FRAMES_PER_SECOND) as usize;
/// Where the first round's targets come from; so the first one is the same for everybody.
const SEED: u32 = 2014;

/// The game.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Balancer {
    game: Game,
    /// What the last frame's steps have brought.
    news: [Option<Event>; STEPS],
}

impl Balancer {
    /// Returns the game before its first round.
    #[must_use]
    pub fn new() -> Self {
        Self { game: Game::new(SEED), news: [None; STEPS] }
    }

    /// Returns the game.
    #[must_use]
    pub fn game(&self) -> &Game {
        &self.game
    }
}

impl Default for Balancer {
    fn default() -> Self {
        Self::new()
    }
}

impl Perform for Balancer {
    fn update(&mut self, state: &ControllerState) {
        let steer = steering::steer(state);
        self.news = [(); STEPS].map(|()| self.game.step(steer));
    }

    /// Does nothing: the stick that is pushed for it steers.
    fn centre(&mut self) {}

    /// Begins another round.
    fn reset(&mut self) {
        self.game.restart();
    }

    fn score(&self) -> Option<u32> {
        Some(self.game.score())
    }

    fn tell(&mut self, console: &mut dyn Write) -> fmt::Result {
        let game = &self.game;
        for event in core::mem::take(&mut self.news).into_iter().flatten() {
            match event {
                Event::Began => writeln!(console, "game: go")?,
                Event::Reached { points } => {
                    let (score, combo, left) = (game.score(), game.combo(), game.seconds_left());
                    writeln!(console, "game: +{points}, score {score}; the next counts {combo} times; {left} s left")?;
                }
                Event::Fell => writeln!(console, "game: off the plate; {} s left", game.seconds_left())?,
                Event::Ended => {
                    let (score, targets, falls, best) = (game.score(), game.targets(), game.falls(), game.best());
                    writeln!(
                        console,
                        "game: over: score {score}, {targets} targets, {falls} falls; best {best}; R: again"
                    )?;
                }
            }
        }
        Ok(())
    }

    fn stage(&self, _: &ControllerState, manner: Manner) -> Stage {
        let mut stage = Stage::new(scenery::camera(manner), DAYLIGHT, manner.style);
        scenery::add(&self.game, &mut stage, manner.style);
        let signs = signs::Signs::new(manner);
        match self.game.phase() {
            Phase::Ready { .. } => signs.count(&mut stage, self.game.countdown().div_ceil(STEPS_PER_SECOND / 2)),
            Phase::Over => signs.total(&mut stage, self.game.score()),
            Phase::Playing | Phase::Fallen { .. } => signs.score(&mut stage, self.game.score()),
        }
        signs.time(&mut stage, self.game.seconds_left());
        stage
    }
}
