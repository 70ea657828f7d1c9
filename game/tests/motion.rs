//! The ball's way against the equation of motion, solved in float64.

use fixed::types::I16F16;
use game::ball::RADIUS;
use game::{Ball, Number, Plate};

const GRAVITY: f64 = 9.80665;
const RESISTANCE: f64 = 0.0175;

fn ball(place: [f64; 2], velocity: [f64; 2]) -> Ball {
    Ball { place: place.map(Number::from_num), velocity: velocity.map(Number::from_num), ..Ball::START }
}

fn plate(roll: f64, pitch: f64) -> Plate {
    Plate { roll: I16F16::from_num(roll), pitch: I16F16::from_num(pitch) }
}

fn floats(vector: [Number; 2]) -> [f64; 2] {
    vector.map(Number::to_num)
}

/// What pulls along the plate and what presses onto it, of a plate whose normal is turned by both angles: worked out
/// from the three axes in space, not from the formula that the game uses.
fn gravity(plate: Plate) -> ([f64; 2], f64) {
    let [roll, pitch] = [plate.roll, plate.pitch].map(|angle| angle.to_num::<f64>().to_radians());
    // The plate's axes in space: each unit vector turned about z, then about x.
    let turned = |[x, y, z]: [f64; 3]| {
        let (x, y) = (x * roll.cos() - y * roll.sin(), x * roll.sin() + y * roll.cos());
        [x, y * pitch.cos() - z * pitch.sin(), y * pitch.sin() + z * pitch.cos()]
    };
    let down = |axis: [f64; 3]| -GRAVITY * turned(axis)[1];
    ([down([1.0, 0.0, 0.0]), down([0.0, 0.0, 1.0])], -down([0.0, 1.0, 0.0]))
}

/// The acceleration of a solid ball that rolls: 5/7 of what pulls it, less the resistance against its way.
fn acceleration(plate: Plate, velocity: [f64; 2]) -> [f64; 2] {
    let (along, onto) = gravity(plate);
    let speed = velocity[0].hypot(velocity[1]).max(1e-12);
    [0, 1].map(|axis| 5.0 / 7.0 * (along[axis] - RESISTANCE * onto * velocity[axis] / speed))
}

/// Goes a step of the game on, by Runge and Kutta's method of fourth order in many small steps.
fn exact_step(plate: Plate, place: &mut [f64; 2], velocity: &mut [f64; 2]) {
    const PARTS: u32 = 8;
    let time = 1.0 / 120.0 / f64::from(PARTS);
    let plus = |a: [f64; 2], b: [f64; 2], factor: f64| [0, 1].map(|axis| a[axis] + b[axis] * factor);
    for _ in 0..PARTS {
        let v = *velocity;
        let a1 = acceleration(plate, v);
        let v2 = plus(v, a1, time / 2.0);
        let a2 = acceleration(plate, v2);
        let v3 = plus(v, a2, time / 2.0);
        let a3 = acceleration(plate, v3);
        let v4 = plus(v, a3, time);
        let a4 = acceleration(plate, v4);
        for axis in 0..2 {
            place[axis] += time / 6.0 * (v[axis] + 2.0 * v2[axis] + 2.0 * v3[axis] + v4[axis]);
            velocity[axis] += time / 6.0 * (a1[axis] + 2.0 * a2[axis] + 2.0 * a3[axis] + a4[axis]);
        }
    }
}

/// Down a slope from rest the way is a·t²/2.
#[test]
fn down_a_slope_it_goes_as_the_textbook_says() {
    for degrees in [2.0, 5.0, 10.0, 17.0] {
        let (mut ball, plate) = (ball([0.0; 2], [0.0; 2]), plate(-degrees, 0.0));
        let angle = f64::to_radians(degrees);
        let acceleration = 5.0 / 7.0 * GRAVITY * (angle.sin() - RESISTANCE * angle.cos());
        for step in 1..=120 {
            ball.roll(plate.pull());
            let time = f64::from(step) / 120.0;
            let [x, z] = floats(ball.place);
            let exact = acceleration * time * time / 2.0;
            assert!((x - exact).abs() < 2e-4 && z == 0.0, "{degrees} degrees, {time} s: {x}, exact {exact}");
        }
    }
}

/// Left down is negative roll's opposite, far edge up rolls it to the near edge; in a corner it goes both ways.
#[test]
fn it_rolls_the_way_that_the_plate_leans() {
    for (roll, pitch, signs) in
        [(5.0, 0.0, [-1.0, 0.0]), (-5.0, 0.0, [1.0, 0.0]), (0.0, 5.0, [0.0, 1.0]), (5.0, -5.0, [-1.0, -1.0])]
    {
        let mut ball = ball([0.0; 2], [0.0; 2]);
        (0..10).for_each(|_| ball.roll(plate(roll, pitch).pull()));
        let found = floats(ball.velocity).map(|part| if part == 0.0 { 0.0 } else { part.signum() });
        assert_eq!(found, signs, "roll {roll}, pitch {pitch}");
    }
}

/// Curved ways on a plate that turns all the time.
#[test]
fn on_a_plate_that_turns_it_follows_the_equation_of_motion() {
    let mut worst = 0.0f64;
    for run in 0..40 {
        let of = |salt: u32| f64::from((run * 13 + salt).wrapping_mul(2_654_435_761) >> 8) / f64::from(1 << 24) - 0.5;
        let mut ball = ball([of(1), of(2)], [2.0 * of(3), 2.0 * of(4)]);
        let (mut place, mut velocity) = (floats(ball.place), floats(ball.velocity));
        for step in 0..240 {
            let time = f64::from(step) / 120.0;
            let plate = plate(
                16.0 * ((1.0 + of(5)) * 3.0 * time + 9.0 * of(6)).sin(),
                16.0 * ((1.0 + of(7)) * 2.0 * time + 9.0 * of(8)).cos(),
            );
            ball.roll(plate.pull());
            exact_step(plate, &mut place, &mut velocity);
            for (found, exact) in floats(ball.place).into_iter().zip(place) {
                worst = worst.max((found - exact).abs());
            }
        }
    }
    assert!(worst < 2e-3, "{worst} m off after two seconds");
    println!("at most {:.3} mm off after two seconds", worst * 1e3);
}

#[test]
fn on_a_slope_of_less_than_a_degree_it_stays_and_on_a_steeper_one_it_goes() {
    for (degrees, moves) in [(0.0, false), (0.9, false), (-0.9, false), (1.1, true), (-1.1, true)] {
        for plate in [plate(degrees, 0.0), plate(0.0, degrees)] {
            let mut ball = ball([0.0; 2], [0.0; 2]);
            (0..1_200).for_each(|_| ball.roll(plate.pull()));
            assert_eq!(ball.place != Ball::START.place, moves, "{degrees} degrees");
        }
    }
}

#[test]
fn after_its_girth_it_lies_as_before() {
    let girth = 2.0 * std::f64::consts::PI * RADIUS.to_num::<f64>();
    for (velocity, axis) in [([1.0, 0.0], [0, 1]), ([0.0, -1.5], [2, 1]), ([-0.4, 0.3], [0, 1])] {
        let mut ball = ball([0.0; 2], velocity);
        let speed = velocity[0].hypot(velocity[1]);
        let mut quarter_seen = false;
        loop {
            let before = ball;
            // Uphill or down, just so that it neither gains nor loses.
            ball.fly();
            let way = [0, 1].map(|axis| ball.place[axis] - before.place[axis]);
            ball.orientation.roll(way);
            let gone = floats(ball.place)[0].hypot(floats(ball.place)[1]);
            let rows = ball.orientation.rows().map(|row| row.map(|part| part.to_num::<f64>()));
            if !quarter_seen && gone >= girth / 4.0 {
                quarter_seen = true;
                // What was on top is in front: the way that it rolls.
                let front = [0, 1].map(|axis: usize| rows[axis * 2][1] * speed / velocity_part(velocity, axis));
                for (axis, part) in front.into_iter().enumerate() {
                    let expected = if velocity[axis] == 0.0 { 0.0 } else { 1.0 };
                    assert!((part - expected).abs() < 0.05, "{velocity:?}: {front:?}");
                }
            }
            if gone >= girth {
                let [here, there] = axis;
                assert!((rows[here][here] - 1.0).abs() < 0.02 && (rows[there][there] - 1.0).abs() < 0.02, "{rows:?}");
                break;
            }
        }
        assert!(quarter_seen);
    }
}

/// A part of a velocity to divide by; 1 for one that is 0.
fn velocity_part(velocity: [f64; 2], axis: usize) -> f64 {
    if velocity[axis] == 0.0 { 1.0 } else { velocity[axis] }
}
