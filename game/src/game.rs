//! A round of the game.

use crate::ball::Ball;
use crate::plate::{Plate, Steer};
use crate::rules::{self, Level};
use crate::target::{Generator, Target};
use crate::{Number, STEPS_PER_SECOND};
use fixed::types::I2F14;

/// Where a round is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// The ball is held until the player has tilted the plate, and for a moment after.
    Ready {
        /// Steps until it is let go; `None` before the first tilt.
        countdown: Option<u32>,
    },
    /// It rolls.
    Playing,
    /// It has rolled off.
    Fallen {
        /// Steps since then.
        steps: u32,
    },
    /// The time is over.
    Over,
}

/// What a step has brought.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Event {
    /// The ball was let go.
    Began,
    /// A target was reached.
    Reached {
        /// The points that it gave, combo and all.
        points: u32,
    },
    /// The ball rolled off.
    Fell,
    /// The time is over.
    Ended,
}

/// The game.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Game {
    seed: u32,
    generator: Generator,
    phase: Phase,
    plate: Plate,
    ball: Ball,
    target: Target,
    targets: u32,
    falls: u32,
    score: u32,
    best: u32,
    combo: u32,
    steps_left: u32,
}

/// A tilt that begins a round, as a part of the strongest.
const BEGINNING: I2F14 = I2F14::lit("0.25");

impl Game {
    /// Returns the game before its first round; `seed` chooses where targets appear.
    #[must_use]
    pub fn new(seed: u32) -> Self {
        let mut generator = Generator::new(seed);
        let target = generator.target(&Level::after(0), Ball::START.place);
        Self {
            seed,
            generator,
            phase: Phase::Ready { countdown: None },
            plate: Plate::LEVEL,
            ball: Ball::START,
            target,
            targets: 0,
            falls: 0,
            score: 0,
            best: 0,
            combo: 1,
            steps_left: rules::ROUND_STEPS,
        }
    }

    /// Begins another round, with other targets.
    pub fn restart(&mut self) {
        *self = Self { best: self.best, plate: self.plate, ..Self::new(self.seed.wrapping_add(1)) };
    }

    /// Goes a step on, and returns what that has brought.
    pub fn step(&mut self, steer: Steer) -> Option<Event> {
        self.plate.follow(steer, self.level().strongest);
        match self.phase {
            Phase::Ready { countdown: None } => {
                let tilted = [steer.right, steer.near].iter().any(|part| part.saturating_abs() >= BEGINNING);
                self.phase = Phase::Ready { countdown: tilted.then_some(rules::COUNTDOWN_STEPS) };
                None
            }
            Phase::Ready { countdown: Some(1..) } => {
                let countdown = self.countdown().saturating_sub(1);
                self.phase = Phase::Ready { countdown: Some(countdown) };
                None
            }
            Phase::Ready { countdown: Some(0) } => {
                self.phase = Phase::Playing;
                Some(Event::Began)
            }
            Phase::Playing => self.tick(1).or_else(|| self.play()),
            Phase::Fallen { steps } => {
                self.ball.fly();
                self.phase = if steps < rules::FALL_STEPS {
                    Phase::Fallen { steps: steps + 1 }
                } else {
                    self.ball = Ball::START;
                    Phase::Playing
                };
                self.tick(1)
            }
            Phase::Over => None,
        }
    }

    /// Takes steps from the clock, and ends the round when none is left.
    fn tick(&mut self, steps: u32) -> Option<Event> {
        self.steps_left = self.steps_left.saturating_sub(steps);
        (self.steps_left == 0).then(|| {
            self.phase = Phase::Over;
            self.best = self.best.max(self.score);
            Event::Ended
        })
    }

    /// A step of the ball on the plate.
    fn play(&mut self) -> Option<Event> {
        self.target.age = self.target.age.saturating_add(1);
        self.ball.roll(self.plate.pull());
        let half_side = self.level().half_side;
        if self.ball.place.iter().any(|part| part.saturating_abs() > half_side) {
            self.phase = Phase::Fallen { steps: 0 };
            self.combo = 1;
            self.falls += 1;
            return self.tick(rules::FALL_COST_STEPS).or(Some(Event::Fell));
        }
        self.target.is_reached(self.ball.place).then(|| {
            let points = self.target.value() * self.combo;
            self.score += points;
            let quick = self.target.age <= rules::QUICK_STEPS;
            self.combo = if quick { (self.combo + 1).min(rules::COMBO_MAXIMUM) } else { 1 };
            self.targets += 1;
            self.target = self.generator.target(&self.level(), self.ball.place);
            Event::Reached { points }
        })
    }

    /// Returns where the round is.
    #[must_use]
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// Returns how the plate lies.
    #[must_use]
    pub fn plate(&self) -> Plate {
        self.plate
    }

    /// Returns the ball.
    #[must_use]
    pub fn ball(&self) -> &Ball {
        &self.ball
    }

    /// Returns how far below its place on the plate the ball is: 0, or what it has fallen.
    #[must_use]
    pub fn depth(&self) -> Number {
        match self.phase {
            // Half of 9.80665 m/s² times the time squared; 120² steps squared are a second squared.
            Phase::Fallen { steps } => {
                const HALF_GRAVITY: Number = Number::lit("4.903325");
                let steps = i64::from(steps.min(rules::FALL_STEPS));
                Number::from_bits((i64::from(HALF_GRAVITY.to_bits()) * steps * steps / 14_400) as i32)
            }
            _ => Number::ZERO,
        }
    }

    /// Returns the target.
    #[must_use]
    pub fn target(&self) -> &Target {
        &self.target
    }

    /// Returns how hard it is now.
    #[must_use]
    pub fn level(&self) -> Level {
        Level::after(self.targets)
    }

    /// Returns how many targets were reached.
    #[must_use]
    pub fn targets(&self) -> u32 {
        self.targets
    }

    /// Returns how often the ball rolled off.
    #[must_use]
    pub fn falls(&self) -> u32 {
        self.falls
    }

    /// Returns the points of the round.
    #[must_use]
    pub fn score(&self) -> u32 {
        self.score
    }

    /// Returns the most points of a round that has ended.
    #[must_use]
    pub fn best(&self) -> u32 {
        self.best
    }

    /// Returns how many times the next target counts.
    #[must_use]
    pub fn combo(&self) -> u32 {
        self.combo
    }

    /// Returns the seconds that are left, rounded up.
    #[must_use]
    pub fn seconds_left(&self) -> u32 {
        self.steps_left.div_ceil(STEPS_PER_SECOND)
    }

    /// Returns the steps until the ball is let go.
    #[must_use]
    pub fn countdown(&self) -> u32 {
        match self.phase {
            Phase::Ready { countdown } => countdown.unwrap_or(rules::COUNTDOWN_STEPS),
            _ => 0,
        }
    }
}
