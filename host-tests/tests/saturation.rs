//! Numbers out of range: nothing panics (tests check overflow), nothing wraps, and whatever comes
//! out keeps the promises that setup makes to the hardware.

use std::panic::{RefUnwindSafe, UnwindSafe, catch_unwind};

use fixed::types::{I2F30, I4F28, I16F16, I32F32};
use fpga_regs::screen::GUARD_BAND;
use geometry::mesh::Position;
use geometry::{Angle, Culling, DirectionalLight, Matrix, ObjectLight, Vector, Winding};
use host_tests::collect::{Drawn, draw_faces};
use host_tests::rng::Rng;
use host_tests::twin::{Twin, position};

const EXTREMES: [I32F32; 9] = [
    I32F32::MIN,
    I32F32::MAX,
    I32F32::ZERO,
    I32F32::ONE,
    I32F32::NEG_ONE,
    I32F32::DELTA,
    I32F32::from_bits(-1),
    I32F32::from_bits(i64::MIN + 1),
    I32F32::from_bits(1 << 62),
];

fn extreme(rng: &mut Rng) -> I32F32 {
    match rng.below(3) {
        0 => I32F32::from_bits((rng.bits() as i64) >> rng.below(64)),
        _ => rng.pick(&EXTREMES),
    }
}

fn extreme_matrix(rng: &mut Rng) -> Matrix {
    Matrix { rows: [[(); 4]; 4].map(|row| row.map(|()| extreme(rng))) }
}

fn extreme_position(rng: &mut Rng) -> Position {
    [0; 3].map(|_| match rng.below(3) {
        0 => I4F28::from_bits(rng.word() as i32),
        _ => rng.pick(&[I4F28::MIN, I4F28::MAX, I4F28::ZERO, I4F28::DELTA, I4F28::ONE]),
    })
}

fn assert_bounded(drawn: &[Drawn], what: &Matrix) {
    for it in drawn {
        for corner in it.corners {
            assert!(corner.x.abs() <= GUARD_BAND && corner.y.abs() <= GUARD_BAND, "{corner:?} of {what:?}");
            assert!((0..=65_535).contains(&corner.depth), "{corner:?} of {what:?}");
        }
        // 2²⁴: see the table in `fpga_regs::packet`.
        assert!(it.triangle.shape.edges.iter().all(|edge| edge.abs() <= 1 << 24), "{it:?} of {what:?}");
    }
}

fn draw_soup(rng: &mut Rng, positions: &[Position], matrix: &Matrix) -> usize {
    let faces: Vec<[u32; 3]> = (0..20).map(|_| [0; 3].map(|_| rng.below(positions.len() as u32))).collect();
    let winding = rng.pick(&[Winding::Clockwise, Winding::CounterClockwise]);
    let (drawn, statistics) = draw_faces(positions, &faces, winding, matrix, Culling::None);
    assert_bounded(&drawn, matrix);
    assert_eq!(statistics.drawn as usize, drawn.len());
    drawn.len()
}

#[test]
fn matrices_of_extreme_elements_draw_something_bounded_or_nothing() {
    let mut rng = Rng(51);
    let mut drawn = 0;
    for _ in 0..20_000 {
        let positions: Vec<Position> = (0..12).map(|_| extreme_position(&mut rng)).collect();
        let matrix = extreme_matrix(&mut rng);
        drawn += draw_soup(&mut rng, &positions, &matrix);
    }
    println!("{drawn} triangles");
    assert!(drawn > 1_000, "only {drawn} triangles: the test tests nothing");
}

/// The eye within a mesh that reaches up to 10⁸ times as far as the near plane: the smallest w
/// that is divided by comes before the near plane then.
#[test]
fn a_near_plane_as_near_as_can_be_keeps_the_guard_band() {
    let mut rng = Rng(52);
    let mut drawn = 0;
    for _ in 0..3_000 {
        let near = rng.logarithmic(1e-7, 1e-2);
        let view = Twin::rotation(0, rng.between(0.0, 6.3)).times(&Twin::rotation(1, rng.between(0.0, 6.3)));
        let matrix = Twin::perspective(rng.between(0.2, 2.9), 4.0 / 3.0, near, rng.logarithmic(0.1, 1e4)).times(&view);
        let spread = rng.logarithmic(1e-6, 7.9);
        let positions: Vec<Position> = (0..12)
            .map(|_| {
                let size = if rng.once_in(4) { 7.9 } else { spread };
                position(rng.point(size)).expect("in range")
            })
            .collect();
        drawn += draw_soup(&mut rng, &positions, &matrix.fixed);
    }
    println!("{drawn} triangles");
    assert!(drawn > 5_000, "only {drawn} triangles: the test tests nothing");
}

#[test]
fn a_matrix_of_zeros_draws_nothing() {
    let mut rng = Rng(53);
    let zero = Matrix { rows: [[I32F32::ZERO; 4]; 4] };
    let positions: Vec<Position> = (0..12).map(|_| extreme_position(&mut rng)).collect();
    assert_eq!(draw_soup(&mut rng, &positions, &zero), 0);
}

#[test]
fn an_empty_mesh_draws_nothing() {
    let (drawn, statistics) = draw_faces(&[], &[], Winding::Clockwise, &Matrix::IDENTITY, Culling::None);
    assert_eq!((drawn.len(), statistics.vertices, statistics.submitted), (0, 0, 0));
}

#[test]
fn a_product_saturates_on_its_own_side() {
    let scaled = |factor: I32F32| Matrix::scaling([factor; 3]);
    let big = I32F32::from_num(100_000);
    assert_eq!(scaled(big).times(&scaled(big)).rows[1][1], I32F32::MAX);
    assert_eq!(scaled(big).times(&scaled(-big)).rows[1][1], I32F32::MIN);
    assert_eq!(scaled(I32F32::MIN).times(&scaled(I32F32::MIN)).rows[2][2], I32F32::MAX);
    let mut rng = Rng(54);
    for _ in 0..5_000 {
        let (left, right) = (extreme_matrix(&mut rng), extreme_matrix(&mut rng));
        let product = left.times(&right);
        // In f64, which has range enough: each element is the sum cut to the range, nearly.
        for row in 0..4 {
            for column in 0..4 {
                let float = |value: I32F32| value.to_num::<f64>();
                let sum: f64 = (0..4).map(|i| float(left.rows[row][i]) * float(right.rows[i][column])).sum();
                let greatest: f64 =
                    (0..4).map(|i| (float(left.rows[row][i]) * float(right.rows[i][column])).abs()).sum();
                let expected = sum.clamp(float(I32F32::MIN), float(I32F32::MAX));
                let error = (float(product.rows[row][column]) - expected).abs();
                assert!(error <= 1e-9 + greatest * 1e-15, "{left:?} times {right:?}, element {row}, {column}");
            }
        }
    }
}

/// Calls `make` with random extreme arguments and names the first that it panics on.
fn never_panics<T: core::fmt::Debug + Clone + UnwindSafe>(
    seed: u64,
    arguments: impl Fn(&mut Rng) -> T,
    make: impl Fn(T) + RefUnwindSafe,
) {
    let mut rng = Rng(seed);
    let mut given = (0..20_000).map(|_| arguments(&mut rng));
    let failure = given.find(|given| {
        let given = given.clone();
        catch_unwind(|| make(given)).is_err()
    });
    assert!(failure.is_none(), "panics on {failure:?}");
}

#[test]
fn a_perspective_of_any_parameters_is_a_matrix() {
    never_panics(
        55,
        |rng| (Angle::from_bits(rng.word()), extreme(rng), extreme(rng), extreme(rng)),
        |(angle, aspect, near, far)| {
            Matrix::perspective(angle, aspect, near, far);
            Matrix::perspective(Angle::ZERO, aspect, near, far);
        },
    );
}

#[test]
fn a_parallel_projection_of_any_box_is_a_matrix() {
    never_panics(
        56,
        |rng| [(); 3].map(|()| (extreme(rng), extreme(rng))),
        |[x, y, depth]| {
            Matrix::orthographic(x, y, depth);
        },
    );
}

#[test]
fn a_view_from_anywhere_to_anywhere_is_a_matrix_or_none() {
    never_panics(
        57,
        |rng| [(); 3].map(|()| -> Vector { [(); 3].map(|()| extreme(rng)) }),
        |[eye, target, up]| {
            Matrix::look_at(eye, target, up);
        },
    );
}

#[test]
fn a_light_in_any_space_is_no_more_than_full() {
    never_panics(
        58,
        |rng| {
            let direction = [(); 3].map(|()| I2F30::from_bits(rng.word() as i32));
            let [diffuse, ambient] = [(); 2].map(|()| I16F16::from_bits(rng.word() as i32));
            let normal = [(); 3].map(|()| rng.pick(&[i16::MIN, i16::MAX, 0, 16_384]));
            (DirectionalLight { direction, colour: [255; 3], diffuse, ambient }, extreme_matrix(rng), normal)
        },
        |(light, model, normal)| {
            let [red, green, blue] = ObjectLight::new(&light, &model).intensity(normal).colour([255, 100, 0]);
            assert!(red >= green && green <= 100 && blue == 0);
        },
    );
}
