//! The recorded game: a player made of formulas plays a round of The Ultimate Ball Balancer with a pad.
//!
//! The player sees the game as it stands and tilts the pad towards the target and against the ball's speed. It
//! rests a little with Cross held and is careless once, so that a pause and a fall are in the record.

use controls::{Button, Report};
use firmware::act::Perform;
use firmware::act::balancer::Balancer;
use firmware::intake::Intake;
use firmware::scene::Scene;
use game::{Game, Phase};

use super::seeds::Hand;
use crate::session::{self, ScenePart};

const HEADER: &str = "\
# A round of The Ultimate Ball Balancer, played with a DualShock 3.
#
# A program holds the pad (xtask/src/generated/game.rs, written by `cargo xtask generate`): it tilts towards the
# target and against the ball's speed, pauses once and is careless once.
#
# Every line after `scene` is a frame: the report that comes before it, 49 bytes in hexadecimal, or `-` for a frame
# without one.

";

/// Frames from one report to the next: the player's hand moves 20 times a second.
const REPORT_FRAMES: u32 = 3;
/// Most frames of a round, with all its pauses.
const FRAMES_MAXIMUM: u32 = 5_000;
/// Frames in which the round's end is looked at.
const END_FRAMES: u32 = 30;
/// While Cross is held.
const PAUSE: std::ops::Range<u32> = 330..360;
/// While the player looks away and leans to the right.
const CARELESS: std::ops::Range<u32> = 1_500..1_575;

/// Returns the session's text.
pub fn text() -> String {
    let (mut intake, mut balancer) = (Intake::new(), Balancer::new());
    let mut frames = Vec::new();
    let mut last = FRAMES_MAXIMUM;
    for frame in 0..FRAMES_MAXIMUM {
        let report = frame.is_multiple_of(REPORT_FRAMES).then(|| hand(frame, balancer.game()).report());
        frames.push(report);
        if let Some(report) = &report {
            // It is well-formed; a test reads all of them.
            let _ = intake.accept(Report::DualShock3(report));
        }
        let state = intake.state();
        if !state.frozen {
            balancer.update(&state);
        }
        intake.end_frame();
        if balancer.game().phase() == Phase::Over {
            last = last.min(frame + END_FRAMES);
        }
        if frame == last {
            break;
        }
    }
    format!("{HEADER}{}", session::format(&[ScenePart { scene: Scene::Game, style: None, frames }]))
}

/// What the player does with the pad.
fn hand(frame: u32, game: &Game) -> Hand {
    let held = if PAUSE.contains(&frame) { vec![Button::Cross] } else { vec![] };
    let (ball, target) = (game.ball(), game.target());
    let [right, near] = match game.phase() {
        // Looks at the level plate, then begins.
        Phase::Ready { .. } => [if (20..40).contains(&frame) { 0.5 } else { 0.0 }, 0.0],
        Phase::Fallen { .. } | Phase::Over => [0.0; 2],
        Phase::Playing if CARELESS.contains(&frame) => [1.0, -0.2],
        Phase::Playing => [0, 1].map(|axis: usize| {
            let way = target.place[axis].to_num::<f64>() - ball.place[axis].to_num::<f64>();
            (1.3 * way - 1.1 * ball.velocity[axis].to_num::<f64>()).clamp(-1.0, 1.0)
        }),
    };
    Hand { roll: -30.0 * right, pitch: 30.0 * near, held, ..Hand::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_player_scores_pauses_falls_and_plays_to_the_end() {
        let parts = session::parse(&text()).expect("a well-formed session");
        let (mut intake, mut balancer) = (Intake::new(), Balancer::new());
        let mut console = String::new();
        let mut frozen = 0;
        for report in &parts[0].frames {
            if let Some(report) = report {
                intake.accept(Report::DualShock3(report)).expect("a good report");
            }
            let state = intake.state();
            frozen += u32::from(state.frozen);
            if !state.frozen {
                balancer.update(&state);
            }
            balancer.tell(&mut console).expect("a string takes all");
            intake.end_frame();
        }
        println!("{console}");
        let game = balancer.game();
        assert_eq!((game.phase(), frozen), (Phase::Over, PAUSE.len() as u32));
        assert!(game.targets() >= 15 && game.falls() == 1, "{} targets, {} falls", game.targets(), game.falls());
    }
}
