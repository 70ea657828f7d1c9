//! Plate, ball and targets as objects.

use fixed::types::{I16F16, I32F32};
use game::ball::RADIUS;
use game::{Game, Number, Phase, Plate};
use geometry::{Angle, Matrix};

use crate::scene::meshes::Shape;
use crate::scene::stage::{Camera, Object, Stage, lens};
use crate::style::{Manner, Style};

/// From the eye to the plate's middle, and how far down it looks, in degrees.
const DISTANCE: I32F32 = I32F32::lit("3.8");
const ELEVATION: I16F16 = I16F16::lit("52");
/// How far below the screen's middle the plate's is: the signs want room above it.
const LOWER: I32F32 = I32F32::lit("0.06");
/// Near and far planes; where depth is shown they close in on the plate.
const PLANES: (I32F32, I32F32) = (I32F32::lit("1"), I32F32::lit("10"));
const PLANES_OF_DEPTH: (I32F32, I32F32) = (I32F32::lit("2.7"), I32F32::lit("4.9"));

/// Heights above the plate of what lies on it, one above the other, times [`lift`].
const SHADOW: I32F32 = I32F32::lit("0.004");
const HOOP: I32F32 = I32F32::lit("0.008");
const SPOT: I32F32 = I32F32::lit("0.012");
const COMBO: I32F32 = I32F32::lit("0.02");
/// Where the light throws the ball's shadow, in its radii, to the right and to the near edge.
const CAST: [I32F32; 2] = [I32F32::lit("0.45"), I32F32::lit("-0.6")];
/// Height of the digit on a target, in the target's radii.
const DIGIT: I32F32 = I32F32::lit("0.42");

/// Returns how many times as high lies what lies on the plate: higher than lines are drawn in front of the faces that
/// they border, and high enough to be another grey.
fn lift(style: Style) -> i64 {
    match style {
        Style::HiddenLines => 3,
        Style::DepthGrey => 12,
        _ => 1,
    }
}

/// Returns the planes between which all is seen.
pub fn planes(manner: Manner) -> (I32F32, I32F32) {
    if manner.style == Style::DepthGrey { PLANES_OF_DEPTH } else { PLANES }
}

/// Returns the camera, which does not move.
pub fn camera(manner: Manner) -> Camera {
    let view = Matrix::translation([I32F32::ZERO, -LOWER, -DISTANCE])
        .times(&Matrix::rotation_x(Angle::from_degrees(ELEVATION)));
    Camera { view, projection: lens(manner.projection, DISTANCE, planes(manner)) }
}

/// Returns what takes eye space back to world space.
pub fn out_of_the_eye() -> Matrix {
    Matrix::rotation_x(Angle::from_degrees(ELEVATION).negated()).times(&Matrix::translation([
        I32F32::ZERO,
        LOWER,
        DISTANCE,
    ]))
}

/// Returns half the height of the picture, in world units, at a distance from the eye of 1 in perspective; and at
/// any distance in parallel projection.
pub fn half_height(manner: Manner, distance: I32F32) -> I32F32 {
    /// tan 22.5°.
    const TANGENT: I32F32 = I32F32::lit("0.41421356");
    TANGENT
        * match manner.projection {
            crate::style::Projection::Perspective => distance,
            crate::style::Projection::Orthographic => DISTANCE,
        }
}

/// Adds the game's objects.
pub fn add(game: &Game, stage: &mut Stage, style: Style) {
    let tilted = tilted(game.plate());
    let side = I32F32::from(game.level().half_side);
    let mut place = |shape: Shape, [x, z]: [Number; 2], height: I32F32, scale: I32F32, turned: &Matrix| {
        let model = tilted
            .times(&Matrix::translation([x.into(), height, z.into()]))
            .times(turned)
            .times(&Matrix::scaling([scale; 3]));
        // There is room for all of them.
        let _ = stage.objects.push(Object::new(shape, model));
    };
    const MIDDLE: [Number; 2] = [Number::ZERO; 2];
    let level = Matrix::scaling([side, I32F32::ONE, side]);
    let [shadow, hoop, spot, combo] = [SHADOW, HOOP, SPOT, COMBO].map(|height| height * lift(style));
    place(Shape::Board, MIDDLE, I32F32::ZERO, I32F32::ONE, &level);

    let (ball, target) = (game.ball(), game.target());
    let (radius, reach) = (I32F32::from(RADIUS), I32F32::from(target.radius));
    let fallen = matches!(game.phase(), Phase::Fallen { .. });
    if !fallen {
        let [x, z] = [0, 1].map(|axis: usize| ball.place[axis] + Number::from_num(CAST[axis] * radius));
        // Beyond the rim nothing throws it back.
        let limit = game.level().half_side - RADIUS;
        place(Shape::Shadow, [x.clamp(-limit, limit), z.clamp(-limit, limit)], shadow, radius, &Matrix::IDENTITY);
    }
    place(Shape::Hoop, target.place, hoop, reach, &Matrix::IDENTITY);
    // What it is worth is how large its middle is.
    let worth = I32F32::from_num(target.value()) / 130;
    place(Shape::Spot, target.place, spot, reach * worth, &Matrix::IDENTITY);
    if let Some(digit) = Shape::DIGITS.get(game.combo() as usize).filter(|_| game.combo() > 1) {
        let lying = Matrix::rotation_x(Angle::QUARTER.negated());
        place(*digit, target.place, combo, reach * DIGIT, &lying);
    }
    let height = radius - I32F32::from(game.depth());
    place(Shape::Ball, ball.place, height, radius, &turned(game));
}

/// Returns how the plate turns what lies on it.
fn tilted(plate: Plate) -> Matrix {
    let [roll, pitch] = [plate.roll, plate.pitch].map(Angle::from_degrees);
    Matrix::rotation_x(pitch).times(&Matrix::rotation_z(roll))
}

/// Returns which way round the ball lies.
fn turned(game: &Game) -> Matrix {
    let mut matrix = Matrix::IDENTITY;
    for (row, turned) in matrix.rows.iter_mut().zip(game.ball().orientation.rows()) {
        for (element, part) in row.iter_mut().zip(turned) {
            *element = part.into();
        }
    }
    matrix
}
