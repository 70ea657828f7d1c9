//! Matrices in `f64`, and the view that fits a model into the picture.

use fixed::types::I32F32;
use geometry::{Angle, Matrix};

/// A 4×4 matrix for column vectors, by rows.
pub type Matrix64 = [[f64; 4]; 4];

/// The picture's width over its height.
const ASPECT: f64 = 4.0 / 3.0;
/// Cotangent of 22.5°, half of the vertical field of view.
const COTANGENT: f64 = 2.414_213_562_373_095;
/// 1/sin 22.5°: from this far a unit sphere just fits; and a little air around it.
const DISTANCE: f64 = 2.613_125_929_752_753 * 1.04;
/// Near and far plane before and behind the middle: the unit sphere, and a little more.
const DEPTH: f64 = 1.02;

/// The view that shows all of a model from the front: its bounding box's middle in the middle, and
/// whatever way it is turned, inside the picture. Field of view 45°.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    centre: [f64; 3],
    /// From the centre to the farthest position.
    radius: f64,
    rotation: Matrix64,
}

impl Fit {
    /// Returns the fit of positions that are turned by `degrees` about the x axis, then the y
    /// axis, then the z axis; the axes stay where they are.
    pub fn new(positions: &[[f64; 3]], degrees: [f64; 3]) -> Self {
        let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        for position in positions {
            for axis in 0..3 {
                bounds[0][axis] = bounds[0][axis].min(position[axis]);
                bounds[1][axis] = bounds[1][axis].max(position[axis]);
            }
        }
        let centre = [0, 1, 2].map(|axis| bounds[0][axis] / 2.0 + bounds[1][axis] / 2.0);
        let centre = centre.map(|part| if part.is_finite() { part } else { 0.0 });
        // Of a unit, so that squares neither overflow nor vanish.
        let unit = [0, 1, 2].map(|axis| bounds[1][axis] - centre[axis]).into_iter().fold(0.0, f64::max);
        let distance = |position: &[f64; 3]| {
            [0, 1, 2].map(|axis| (position[axis] - centre[axis]) / unit).iter().map(|part| part * part).sum::<f64>()
        };
        let largest = positions.iter().map(distance).fold(0.0, f64::max);
        let radius = unit * largest.sqrt();
        let radius = if radius > 0.0 { radius } else { 1.0 };
        let [x, y, z] = degrees.map(sin_cos);
        let rotation = times(&rotation(z, 0, 1), &times(&rotation(y, 2, 0), &rotation(x, 1, 2)));
        Self { centre, radius, rotation }
    }

    /// Returns the way from the file's coordinates to clip space.
    pub fn model_to_clip(&self) -> Matrix64 {
        let mut to_unit = identity();
        for (axis, (row, centre)) in to_unit.iter_mut().zip(self.centre).enumerate() {
            row[axis] = 1.0 / self.radius;
            row[3] = -centre / self.radius;
        }
        let mut view = self.rotation;
        view[2][3] = -DISTANCE;
        times(&perspective(DISTANCE - DEPTH, DISTANCE + DEPTH), &times(&view, &to_unit))
    }

    /// Returns the rotation alone.
    pub fn rotation_matrix(&self) -> Matrix {
        Matrix { rows: self.rotation.map(|row| row.map(I32F32::saturating_from_num)) }
    }
}

/// Returns the way to clip space of a view through a window in a plane across z: what is between the plane and
/// the eye is cut off, the window fills the picture.
pub fn of_window(view: &models::View) -> Matrix64 {
    /// No position of 16 bits is as far away from an eye of 16 bits.
    const FAR: f64 = 64.0;
    let models::View { eye, plane, window: [low, high] } = *view;
    let near = eye[2] - plane;
    // w is the distance from the eye along z. On the plane, x is eye − near/w · (eye − x), y likewise.
    let w = [0.0, 0.0, -1.0, eye[2]];
    let across = |axis: usize| {
        let mut projected = [0.0, 0.0, -eye[axis], eye[axis] * plane];
        projected[axis] = near;
        let (sum, width) = (low[axis] + high[axis], high[axis] - low[axis]);
        [0, 1, 2, 3].map(|column| (2.0 * projected[column] - sum * w[column]) / width)
    };
    let (scale, offset) = ((FAR + near) / (FAR - near), -2.0 * FAR * near / (FAR - near));
    let depth = [0.0, 0.0, scale * w[2], scale * w[3] + offset];
    [across(0), across(1), depth, w]
}

fn identity() -> Matrix64 {
    let mut matrix = [[0.0; 4]; 4];
    for (index, row) in matrix.iter_mut().enumerate() {
        row[index] = 1.0;
    }
    matrix
}

fn times(left: &Matrix64, right: &Matrix64) -> Matrix64 {
    left.map(|row| [0, 1, 2, 3].map(|column| (0..4).map(|index| row[index] * right[index][column]).sum()))
}

/// The rotation that turns axis `from` towards axis `to`.
fn rotation((sine, cosine): (f64, f64), from: usize, to: usize) -> Matrix64 {
    let mut matrix = identity();
    matrix[from][from] = cosine;
    matrix[from][to] = -sine;
    matrix[to][from] = sine;
    matrix[to][to] = cosine;
    matrix
}

/// Sine and cosine by the geometry's own table, exact to 2⁻²⁹: the same on every machine, which
/// the C library's are not.
fn sin_cos(degrees: f64) -> (f64, f64) {
    let turns = (degrees % 360.0) / 360.0;
    let units = (turns * 4_294_967_296.0).round() as i64;
    let (sine, cosine) = Angle::from_bits(units as u32).sin_cos();
    (sine.to_num(), cosine.to_num())
}

/// OpenGL's perspective.
fn perspective(near: f64, far: f64) -> Matrix64 {
    let mut matrix = [[0.0; 4]; 4];
    matrix[0][0] = COTANGENT / ASPECT;
    matrix[1][1] = COTANGENT;
    matrix[2][2] = (far + near) / (near - far);
    matrix[2][3] = 2.0 * far * near / (near - far);
    matrix[3][2] = -1.0;
    matrix
}

/// Largest element's magnitude after scaling: from 2^22 up to 2^23.
const LARGEST_LOG2: i32 = 23;

/// Returns a model-to-clip matrix for positions that are stored 2^-`scale_log2` times as large as
/// in the file: that factor goes into the columns of x, y and z.
///
/// Then all 16 elements are multiplied by one power of two. Clip coordinates are homogeneous:
/// (x, y, z, w) and (kx, ky, kz, kw) are the same point for every k above 0, and a power of two
/// rounds nothing. So the largest element uses most of Q32.32's integer bits, and rounding to its
/// 32 fraction bits costs less than a double's own precision.
pub fn to_matrix(model_to_clip: &Matrix64, scale_log2: i32) -> Matrix {
    let largest = |matrix: &Matrix64| matrix.iter().flatten().fold(0.0f64, |largest, part| largest.max(part.abs()));
    // First to around 1 each, so that no product of a huge factor overflows or a tiny one vanishes.
    let offsets = model_to_clip.map(|row| row[3].abs()).into_iter().fold(0.0, f64::max);
    let linear = model_to_clip.iter().flat_map(|row| &row[..3]).fold(0.0f64, |largest, part| largest.max(part.abs()));
    if linear.max(offsets) == 0.0 {
        return Matrix { rows: [[I32F32::ZERO; 4]; 4] };
    }
    let exponent = |value: f64| if value > 0.0 { value.log2().floor() as i32 } else { i32::MIN / 4 };
    let top = (exponent(linear) + scale_log2).max(exponent(offsets));
    let scaled = model_to_clip.map(|row| {
        [0, 1, 2, 3].map(|column| times_power_of_two(row[column], if column < 3 { scale_log2 - top } else { -top }))
    });
    // `log2` may be off by one at a power of two: settled by the elements themselves.
    let shift = LARGEST_LOG2 - 1 - exponent(largest(&scaled)).clamp(-2, 2);
    Matrix { rows: scaled.map(|row| row.map(|part| I32F32::saturating_from_num(times_power_of_two(part, shift)))) }
}

/// `value` · 2^`power`, in two steps, as 2^`power` alone may be beyond a double.
fn times_power_of_two(value: f64, power: i32) -> f64 {
    let half = power / 2;
    value * 2.0f64.powi(half) * 2.0f64.powi(power - half)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn apply(matrix: &Matrix64, [x, y, z]: [f64; 3]) -> [f64; 4] {
        matrix.map(|row| row[0] * x + row[1] * y + row[2] * z + row[3])
    }

    #[test]
    fn a_fit_puts_every_position_into_the_picture() {
        for (offset, size) in [(0.0, 1.0), (1e6, 0.5), (-3e-7, 1e-8), (5e80, 1e79)] {
            let positions: Vec<[f64; 3]> =
                (0..8).map(|corner| [0, 1, 2].map(|axis| offset + size * f64::from(corner >> axis & 1))).collect();
            for degrees in [[0.0; 3], [20.0, -30.0, 0.0], [725.0, 1e9, -45.5]] {
                let matrix = Fit::new(&positions, degrees).model_to_clip();
                let mut farthest = 0.0f64;
                for position in &positions {
                    let [x, y, z, w] = apply(&matrix, *position);
                    assert!(w > 0.0 && [x, y, z].iter().all(|part| part.abs() <= w), "{offset} {size} {degrees:?}");
                    farthest = farthest.max((x / w).abs()).max((y / w).abs());
                }
                assert!(farthest > 0.4, "{offset} {size}: it fills {farthest}");
            }
        }
    }

    #[test]
    fn a_window_shows_what_the_seed_s_formula_puts_into_it() {
        let view = models::View { eye: [0.5, 1.0, 4.0], plane: 1.0, window: [[-2.0, -1.0], [3.0, 2.5]] };
        let matrix = of_window(&view);
        for position in [[0.0, 0.0, 0.0], [1.5, -2.0, -7.0], [-3.0, 2.25, 1.0], [0.5, 1.0, -16.0]] {
            let [x, y, z, w] = apply(&matrix, position);
            // As the report has it: x on the plane = x_e − (z_e − a)/(z_e − z)·(x_e − x).
            let on_plane =
                |axis: usize| view.eye[axis] - (4.0 - 1.0) / (4.0 - position[2]) * (view.eye[axis] - position[axis]);
            let inside = |axis: usize| {
                (on_plane(axis) - view.window[0][axis]) / (view.window[1][axis] - view.window[0][axis]) * 2.0 - 1.0
            };
            assert!((x / w - inside(0)).abs() < 1e-12 && (y / w - inside(1)).abs() < 1e-12, "{position:?}");
            // The plane is the near one.
            assert!((position[2] == 1.0) == ((z / w + 1.0).abs() < 1e-12) && z / w < 1.0, "{position:?} {z} {w}");
        }
    }

    #[test]
    fn rotations_go_x_then_y_then_z_about_fixed_axes() {
        let turned = |degrees, position: [f64; 3]| {
            let [x, y, z, _] = apply(&Fit::new(&[[1.0; 3]], degrees).rotation, position);
            [x, y, z].map(|part| (part * 1e6).round() / 1e6)
        };
        assert_eq!(turned([90.0, 0.0, 0.0], [0.0, 1.0, 0.0]), [0.0, 0.0, 1.0]);
        assert_eq!(turned([0.0, 90.0, 0.0], [0.0, 0.0, 1.0]), [1.0, 0.0, 0.0]);
        assert_eq!(turned([0.0, 0.0, 90.0], [1.0, 0.0, 0.0]), [0.0, 1.0, 0.0]);
        // x brings y to z, y brings that to x, z brings that to y.
        assert_eq!(turned([90.0, 90.0, 90.0], [0.0, 1.0, 0.0]), [0.0, 1.0, 0.0]);
    }

    #[test]
    fn a_single_point_and_no_point_have_a_finite_view() {
        for positions in [&[][..], &[[3.0; 3]]] {
            let matrix = Fit::new(positions, [0.0; 3]).model_to_clip();
            assert!(matrix.iter().flatten().all(|part| part.is_finite()));
        }
    }

    #[test]
    fn scaling_keeps_every_element_s_share() {
        let matrix = Fit::new(&[[-1.0; 3], [3.0, 2.0, 1.0]], [10.0, 20.0, 30.0]).model_to_clip();
        for power in [-400, -30, 0, 1, 7, 300] {
            let whole = matrix.map(|row| row.map(|part| part * 2.0f64.powi(power)));
            for scale_log2 in [-20, -1, 0, 5, 40] {
                let found = to_matrix(&whole, scale_log2).rows.map(|row| row.map(|part| part.to_num::<f64>()));
                let expected = whole.map(|row| {
                    [0, 1, 2, 3]
                        .map(|column| times_power_of_two(row[column], if column < 3 { scale_log2 } else { 0 } - power))
                });
                let largest =
                    |matrix: &Matrix64| matrix.iter().flatten().fold(0.0f64, |most, part| most.max(part.abs()));
                assert!((2.0f64.powi(20)..=2.0f64.powi(24)).contains(&largest(&found)), "{}", largest(&found));
                let factor = largest(&found) / largest(&expected);
                let power = factor.log2();
                assert!((power - power.round()).abs() < 1e-12, "a factor of {factor} is no power of two");
                for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
                    assert!((found - expected * factor).abs() <= 2.0f64.powi(-33) + found.abs() * 1e-15);
                }
            }
        }
    }

    #[test]
    fn a_matrix_of_zeros_stays_one() {
        assert_eq!(to_matrix(&[[0.0; 4]; 4], 3).rows, [[I32F32::ZERO; 4]; 4]);
    }
}
