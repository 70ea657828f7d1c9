//! OpenGL's matrices and the viewport in `f64`, from the formulas of its reference pages.

use fpga_regs::screen::{HEIGHT, WIDTH};

/// A vector of three.
pub type Vector = [f64; 3];

/// A 4×4 matrix for column vectors, stored by rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FloatMatrix(pub [[f64; 4]; 4]);

/// A point on the screen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScreenPoint {
    /// To the right, in pixels.
    pub x: f64,
    /// Down, in pixels.
    pub y: f64,
    /// 0 (near) to 65,535 (far).
    pub depth: f64,
}

impl FloatMatrix {
    /// The matrix that changes nothing.
    pub const IDENTITY: Self =
        Self([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]);

    /// Returns glTranslate's matrix.
    pub fn translation([x, y, z]: Vector) -> Self {
        Self([[1.0, 0.0, 0.0, x], [0.0, 1.0, 0.0, y], [0.0, 0.0, 1.0, z], [0.0, 0.0, 0.0, 1.0]])
    }

    /// Returns glScale's matrix.
    pub fn scaling([x, y, z]: Vector) -> Self {
        Self([[x, 0.0, 0.0, 0.0], [0.0, y, 0.0, 0.0], [0.0, 0.0, z, 0.0], [0.0, 0.0, 0.0, 1.0]])
    }

    /// Returns glRotate's matrix: about a unit axis, by Rodrigues' formula.
    pub fn rotation(axis: Vector, radians: f64) -> Self {
        let (sine, cosine) = radians.sin_cos();
        let [x, y, z] = axis;
        let rest = 1.0 - cosine;
        Self([
            [x * x * rest + cosine, x * y * rest - z * sine, x * z * rest + y * sine, 0.0],
            [y * x * rest + z * sine, y * y * rest + cosine, y * z * rest - x * sine, 0.0],
            [z * x * rest - y * sine, z * y * rest + x * sine, z * z * rest + cosine, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ])
    }

    /// Returns glFrustum's matrix for gluPerspective's parameters.
    pub fn perspective(field_of_view_radians: f64, aspect: f64, near: f64, far: f64) -> Self {
        let top = near * (field_of_view_radians / 2.0).tan();
        let right = top * aspect;
        Self([
            [near / right, 0.0, 0.0, 0.0],
            [0.0, near / top, 0.0, 0.0],
            [0.0, 0.0, -(far + near) / (far - near), -2.0 * far * near / (far - near)],
            [0.0, 0.0, -1.0, 0.0],
        ])
    }

    /// Returns glOrtho's matrix.
    pub fn orthographic([left, right]: [f64; 2], [bottom, top]: [f64; 2], [near, far]: [f64; 2]) -> Self {
        Self([
            [2.0 / (right - left), 0.0, 0.0, -(right + left) / (right - left)],
            [0.0, 2.0 / (top - bottom), 0.0, -(top + bottom) / (top - bottom)],
            [0.0, 0.0, -2.0 / (far - near), -(far + near) / (far - near)],
            [0.0, 0.0, 0.0, 1.0],
        ])
    }

    /// Returns gluLookAt's matrix.
    pub fn look_at(eye: Vector, target: Vector, up: Vector) -> Self {
        let forward = unit([0, 1, 2].map(|axis| target[axis] - eye[axis]));
        let side = unit(cross(forward, up));
        let upward = cross(side, forward);
        let row = |axis: Vector| [axis[0], axis[1], axis[2], 0.0];
        let turned = Self([row(side), row(upward), row(forward.map(|part| -part)), [0.0, 0.0, 0.0, 1.0]]);
        turned.times(&Self::translation(eye.map(|part| -part)))
    }

    /// Returns the product `self · right`: first `right`, then `self`.
    #[must_use]
    pub fn times(&self, right: &Self) -> Self {
        let element = |row: usize, column: usize| (0..4).map(|index| self.0[row][index] * right.0[index][column]).sum();
        Self([0, 1, 2, 3].map(|row| [0, 1, 2, 3].map(|column| element(row, column))))
    }

    /// Returns where the matrix takes a point: x, y, z, w.
    pub fn apply(&self, [x, y, z]: Vector) -> [f64; 4] {
        self.0.map(|row| row[0] * x + row[1] * y + row[2] * z + row[3])
    }

    /// Returns the inverse, by Gauss and Jordan, or `None` for a singular matrix.
    pub fn inverse(&self) -> Option<Self> {
        let (mut left, mut right) = (self.0, Self::IDENTITY.0);
        for column in 0..4 {
            let pivot = (column..4).max_by(|a, b| left[*a][column].abs().total_cmp(&left[*b][column].abs()))?;
            left.swap(column, pivot);
            right.swap(column, pivot);
            let by = left[column][column];
            if by == 0.0 {
                return None;
            }
            left[column] = left[column].map(|element| element / by);
            right[column] = right[column].map(|element| element / by);
            for row in (0..4).filter(|row| *row != column) {
                let factor = left[row][column];
                for index in 0..4 {
                    left[row][index] -= factor * left[column][index];
                    right[row][index] -= factor * right[column][index];
                }
            }
        }
        Some(Self(right))
    }
}

/// Returns the screen's point of a point in clip space.
pub fn viewport([x, y, z, w]: [f64; 4]) -> ScreenPoint {
    let (x, y, z) = (x / w, y / w, z / w);
    ScreenPoint {
        x: (x + 1.0) / 2.0 * f64::from(WIDTH),
        y: (1.0 - y) / 2.0 * f64::from(HEIGHT),
        depth: (z + 1.0) / 2.0 * 65_535.0,
    }
}

/// Returns the vector product.
pub fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Returns the scalar product.
pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Returns the vector of length 1 in the same direction.
pub fn unit(vector: Vector) -> Vector {
    let length = dot(vector, vector).sqrt();
    vector.map(|part| part / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_corners_of_a_frustum_go_to_the_corners_of_the_screen() {
        let matrix = FloatMatrix::perspective(std::f64::consts::FRAC_PI_2, 2.0, 0.5, 8.0);
        for (point, expected) in [([-1.0, 0.5, -0.5], [0.0, 0.0, 0.0]), ([16.0, -8.0, -8.0], [320.0, 240.0, 65_535.0])]
        {
            let seen = viewport(matrix.apply(point));
            for (found, expected) in [seen.x, seen.y, seen.depth].into_iter().zip(expected) {
                assert!((found - expected).abs() < 1e-9, "{seen:?}");
            }
        }
    }

    #[test]
    fn looking_at_a_point_brings_it_to_the_negative_z_axis_and_up_upwards() {
        let view = FloatMatrix::look_at([3.0, 4.0, 5.0], [3.0, 4.0, -2.0], [0.0, 1.0, 0.0]);
        let near = |found: [f64; 4], expected: [f64; 4]| found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(near(view.apply([3.0, 4.0, -2.0]), [0.0, 0.0, -7.0, 1.0]));
        assert!(near(view.apply([4.0, 6.0, 5.0]), [1.0, 2.0, 0.0, 1.0]));
    }

    #[test]
    fn an_inverse_undoes_its_matrix() {
        let matrix = FloatMatrix::perspective(1.0, 1.3, 0.1, 20.0)
            .times(&FloatMatrix::look_at([1.0, 2.0, 3.0], [-4.0, 0.5, 0.0], [0.0, 0.0, 1.0]))
            .times(&FloatMatrix::rotation(unit([1.0, 2.0, -1.0]), 2.0));
        let product = matrix.times(&matrix.inverse().expect("the matrix is regular"));
        for row in 0..4 {
            for column in 0..4 {
                assert!((product.0[row][column] - FloatMatrix::IDENTITY.0[row][column]).abs() < 1e-9);
            }
        }
        assert_eq!(FloatMatrix([[0.0; 4]; 4]).inverse(), None);
    }
}
