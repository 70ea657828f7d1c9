//! What holds in every game, whatever the player does.

use fixed::types::I2F14;
use game::rules::{self, Level};
use game::{Ball, Event, Game, Number, Phase, Plate, Steer};

/// Xorshift of 64 bits (Marsaglia 2003).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// Any number that the type holds.
    fn part(&mut self) -> I2F14 {
        I2F14::from_bits(self.next() as i16)
    }

    fn steer(&mut self) -> Steer {
        Steer { right: self.part(), near: self.part() }
    }
}

fn size(vector: [Number; 2]) -> f64 {
    vector[0].to_num::<f64>().hypot(vector[1].to_num())
}

/// Steers to the target: pushes towards it, and against the way that the ball goes.
fn chase(game: &Game) -> Steer {
    let (ball, target) = (game.ball(), game.target());
    let push = |axis: usize| {
        let way = target.place[axis].to_num::<f64>() - ball.place[axis].to_num::<f64>();
        I2F14::from_num((2.2 * way - 1.8 * ball.velocity[axis].to_num::<f64>()).clamp(-1.0, 1.0))
    };
    Steer { right: push(0), near: push(1) }
}

/// Plays a round to its end, and returns what happened.
fn play(game: &mut Game, mut steer: impl FnMut(&Game) -> Steer) -> Vec<Event> {
    let mut events = Vec::new();
    for _ in 0..2 * rules::ROUND_STEPS {
        let next = steer(game);
        events.extend(game.step(next));
        if game.phase() == Phase::Over {
            break;
        }
    }
    events
}

#[test]
fn on_a_level_plate_the_speed_never_grows_and_ends() {
    let mut random = Random(1);
    for _ in 0..200 {
        let velocity = [0; 2].map(|_| Number::from_bits((random.next() as i32) >> 5));
        let mut ball = Ball { velocity, ..Ball::START };
        let mut steps = 0;
        while ball.velocity != Ball::START.velocity {
            let before = ball.velocity;
            ball.roll(Plate::LEVEL.pull());
            for (now, before) in ball.velocity.into_iter().zip(before) {
                assert!(now.saturating_abs() <= before.saturating_abs() && now.signum() * before.signum() >= 0);
            }
            steps += 1;
            assert!(steps < 12_000, "it rolls for ever");
        }
    }
}

/// On a plate that stays as it is, height and motion together lose what resistance takes and gain nothing.
#[test]
fn on_a_slope_it_never_gains_more_than_it_falls() {
    let mut random = Random(2);
    for _ in 0..100 {
        let mut angle = || fixed::types::I16F16::from_num((random.next() % 34) as i32 - 17);
        let plate = Plate { roll: angle(), pitch: angle() };
        let pull = plate.pull();
        let mut ball = Ball { velocity: [Number::from_num(0.7), Number::from_num(-0.4)], ..Ball::START };
        // Per mass: 7/10 v² for rolling, and g times the height.
        let energy = |ball: &Ball| {
            let fallen: f64 =
                (0..2).map(|axis| ball.place[axis].to_num::<f64>() * pull.along[axis].to_num::<f64>()).sum();
            0.7 * size(ball.velocity).powi(2) - 9.80665 * fallen
        };
        for _ in 0..200 {
            let before = energy(&ball);
            ball.roll(pull);
            assert!(energy(&ball) <= before + 2e-6, "{plate:?}: {} after {before}", energy(&ball));
        }
    }
}

#[test]
fn the_same_steps_give_the_same_game_and_another_seed_another() {
    let run = |seed: u32| {
        let (mut game, mut random) = (Game::new(seed), Random(3));
        (0..20_000).for_each(|_| _ = game.step(random.steer()));
        game
    };
    assert_eq!(run(7), run(7));
    let first = |seed: u32| Game::new(seed).target().place;
    let mut places: Vec<_> = (0..100).map(|seed| first(seed).map(Number::to_bits)).collect();
    places.sort_unstable();
    places.dedup();
    assert_eq!(places.len(), 100);
}

/// 400,000 steps of nonsense. Sums and products are checked for overflow in this build.
#[test]
fn nothing_leaves_its_bounds_whatever_the_player_does() {
    for (seed, hold) in [(1, 1), (2, 7), (3, 60), (4, 400)] {
        let (mut game, mut random) = (Game::new(seed), Random(4 + u64::from(seed)));
        let mut steer = Steer::default();
        let (mut falls, mut rounds) = (0, 0);
        for step in 0..100_000u32 {
            if step % hold == 0 {
                steer = random.steer();
            }
            let before = game;
            let event = game.step(steer);
            let (ball, level) = (game.ball(), game.level());
            assert!(game.seconds_left() <= 60 && game.seconds_left() <= before.seconds_left());
            assert!((1..=rules::COMBO_MAXIMUM).contains(&game.combo()));
            // After a restart a plate that was tilted more strongly comes back.
            let tilts = |game: &Game| [game.plate().roll.abs(), game.plate().pitch.abs()];
            for (now, before) in tilts(&game).into_iter().zip(tilts(&before)) {
                assert!(now <= level.strongest.max(before));
            }
            assert!(size(ball.velocity) < 8.0, "{ball:?}");
            assert!(size(ball.place) < 12.0 && game.depth() >= 0 && game.depth() < 5, "{ball:?}");
            if game.phase() == Phase::Playing {
                assert!(ball.place.iter().all(|part| part.abs() <= Level::after(0).half_side));
            }
            let target = game.target();
            assert!(target.place.iter().all(|part| part.abs() + target.radius < level.half_side));
            for row in ball.orientation.rows() {
                let length: f64 = row.iter().map(|part| part.to_num::<f64>().powi(2)).sum();
                assert!((length - 1.0).abs() < 1e-6, "{row:?}");
            }
            falls += u32::from(event == Some(Event::Fell));
            if game.phase() == Phase::Over {
                rounds += 1;
                game.restart();
            }
        }
        assert!(rounds >= 10 && (falls >= 10 || hold < 60), "{falls} falls in {rounds} rounds");
    }
}

#[test]
fn nothing_begins_until_the_plate_is_tilted() {
    let mut game = Game::new(1);
    (0..10_000).for_each(|_| assert_eq!(game.step(Steer { right: I2F14::lit("0.2"), ..Steer::default() }), None));
    assert_eq!((game.phase(), game.ball()), (Phase::Ready { countdown: None }, &Ball::START));
    game.step(Steer { near: I2F14::NEG_ONE, ..Steer::default() });
    let began = (1..1_000).find(|_| game.step(Steer::default()) == Some(Event::Began));
    assert_eq!(began, Some(rules::COUNTDOWN_STEPS + 1));
}

#[test]
fn a_ball_that_rolls_off_costs_time_and_combo_and_comes_back() {
    let mut game = Game::new(1);
    let (mut fell, mut left) = (None, 0);
    for step in 0..6_000 {
        let left_before = left;
        left = game.seconds_left();
        match game.step(Steer { right: I2F14::ONE, near: I2F14::ZERO }) {
            Some(Event::Fell) => {
                fell = Some(step);
                assert!(matches!(game.phase(), Phase::Fallen { .. }));
                assert!(left_before - game.seconds_left() >= 2);
                assert!(size(game.ball().velocity) > 1.0 && game.combo() == 1 && game.falls() == 1);
                break;
            }
            other => assert!(fell.is_none() && !matches!(other, Some(Event::Ended))),
        }
    }
    let fell = fell.expect("it rolls off");
    assert!(fell > 120, "not at once");
    let mut depth = Number::ZERO;
    for _ in 0..=rules::FALL_STEPS {
        assert!(game.depth() >= depth);
        depth = game.depth();
        game.step(Steer::default());
    }
    assert_eq!((game.phase(), game.ball()), (Phase::Playing, &Ball::START));
    assert!(depth > 4, "it falls {depth} m in a second");
}

#[test]
fn a_player_who_chases_targets_scores_and_it_gets_harder() {
    for seed in 0..20 {
        let mut game = Game::new(seed);
        let mut targets = vec![];
        let events = play(&mut game, |game| {
            targets.push(game.targets());
            if matches!(game.phase(), Phase::Ready { .. }) {
                Steer { right: I2F14::ONE, near: I2F14::ZERO }
            } else {
                chase(game)
            }
        });
        assert_eq!((events.first(), events.last()), (Some(&Event::Began), Some(&Event::Ended)));
        let points: u32 =
            events.iter().map(|event| if let Event::Reached { points } = event { *points } else { 0 }).sum();
        assert_eq!((game.score(), game.best()), (points, points));
        println!("seed {seed}: {} targets, {} falls, {points} points", game.targets(), game.falls());
        assert!(game.targets() >= 12, "seed {seed}: {} targets", game.targets());
        let (first, last) = (Level::after(0), game.level());
        assert!(last.half_side < first.half_side && last.target_radius < first.target_radius);
        assert!(last.strongest > first.strongest);
        game.restart();
        assert_eq!((game.score(), game.best(), game.phase()), (0, points, Phase::Ready { countdown: None }));
    }
}

#[test]
fn a_quick_target_is_worth_more_and_raises_the_combo() {
    let mut game = Game::new(5);
    let mut expected_combo = 1;
    let mut seen = [false; 2];
    let mut last_event = 0;
    for step in 0..rules::ROUND_STEPS {
        let (combo, before) = (game.combo(), *game.target());
        let begin = Steer { right: I2F14::ONE, near: I2F14::ZERO };
        // Dawdles in the second half.
        let dawdles = step > rules::ROUND_STEPS / 2 && step - last_event < 4 * 120;
        let steer = match game.phase() {
            Phase::Ready { .. } => begin,
            _ if dawdles => hover(&game),
            _ => chase(&game),
        };
        match game.step(steer) {
            Some(Event::Reached { points }) => {
                last_event = step;
                let age = before.age + 1;
                let value = 100 - 80 * age.min(720) / 720;
                assert_eq!(points, value * combo, "at the age of {age} steps");
                let quick = age <= 360;
                seen[usize::from(quick)] = true;
                expected_combo = if quick { (expected_combo + 1).min(5) } else { 1 };
                assert_eq!(game.combo(), expected_combo);
            }
            Some(Event::Fell) => expected_combo = 1,
            Some(Event::Ended) => break,
            _ => {}
        }
    }
    assert_eq!(seen, [true; 2], "slow and quick targets");
}

/// Steers to the middle.
fn hover(game: &Game) -> Steer {
    let push = |axis: usize| {
        let ball = game.ball();
        let wanted = -1.5 * ball.place[axis].to_num::<f64>() - 1.8 * ball.velocity[axis].to_num::<f64>();
        I2F14::from_num(wanted.clamp(-1.0, 1.0))
    };
    Steer { right: push(0), near: push(1) }
}
