//! One transformation twice: in `f64`, and as the code under test makes it.
//!
//! Both come from the same `f64` numbers, so that what the integer side loses by rounding them
//! counts as its error.

use fixed::types::{I4F28, I32F32};
use geometry::mesh::Position;
use geometry::{Angle, Matrix};

use crate::float_matrix::{FloatMatrix, Vector};

/// A transformation in both worlds.
#[derive(Debug, Clone, Copy)]
pub struct Twin {
    /// In `f64`.
    pub exact: FloatMatrix,
    /// In `geometry`'s numbers.
    pub fixed: Matrix,
}

impl Twin {
    /// The transformation that changes nothing.
    pub const IDENTITY: Self = Self { exact: FloatMatrix::IDENTITY, fixed: Matrix::IDENTITY };

    /// Returns a shift.
    pub fn translation(offset: Vector) -> Self {
        Self { exact: FloatMatrix::translation(offset), fixed: Matrix::translation(vector(offset)) }
    }

    /// Returns a change of size.
    pub fn scaling(factors: Vector) -> Self {
        Self { exact: FloatMatrix::scaling(factors), fixed: Matrix::scaling(vector(factors)) }
    }

    /// Returns a rotation about axis 0 (x), 1 (y) or 2 (z).
    pub fn rotation(axis: usize, radians: f64) -> Self {
        let mut direction = [0.0; 3];
        direction[axis] = 1.0;
        let make = [Matrix::rotation_x, Matrix::rotation_y, Matrix::rotation_z][axis];
        Self { exact: FloatMatrix::rotation(direction, radians), fixed: make(angle(radians)) }
    }

    /// Returns a perspective projection.
    pub fn perspective(field_of_view_radians: f64, aspect: f64, near: f64, far: f64) -> Self {
        Self {
            exact: FloatMatrix::perspective(field_of_view_radians, aspect, near, far),
            fixed: Matrix::perspective(angle(field_of_view_radians), number(aspect), number(near), number(far)),
        }
    }

    /// Returns a parallel projection of a box.
    pub fn orthographic(x: [f64; 2], y: [f64; 2], depth: [f64; 2]) -> Self {
        let pair = |[low, high]: [f64; 2]| (number(low), number(high));
        Self {
            exact: FloatMatrix::orthographic(x, y, depth),
            fixed: Matrix::orthographic(pair(x), pair(y), pair(depth)),
        }
    }

    /// Returns a view; `None` where there is none.
    pub fn look_at(eye: Vector, target: Vector, up: Vector) -> Option<Self> {
        let fixed = Matrix::look_at(vector(eye), vector(target), vector(up))?;
        Some(Self { exact: FloatMatrix::look_at(eye, target, up), fixed })
    }

    /// Returns the product: first `right`, then `self`.
    #[must_use]
    pub fn times(&self, right: &Self) -> Self {
        Self { exact: self.exact.times(&right.exact), fixed: self.fixed.times(&right.fixed) }
    }
}

/// Returns the nearest Q32.32 number.
pub fn number(value: f64) -> I32F32 {
    I32F32::from_num(value)
}

/// Returns the nearest Q32.32 vector.
pub fn vector(value: Vector) -> geometry::Vector {
    value.map(number)
}

/// Returns the nearest angle.
pub fn angle(radians: f64) -> Angle {
    let turns = radians / std::f64::consts::TAU;
    Angle::from_bits(((turns - turns.floor()) * 4_294_967_296.0).round() as u64 as u32)
}

/// Returns the nearest position, or `None` if it is out of range.
///
/// Positions are quantised where they enter the project: [`exact_position`] is what a reference
/// starts from.
pub fn position(point: Vector) -> Option<Position> {
    let bits = point.map(|part| (part * f64::from(1 << 28)).round());
    let fits = bits.iter().all(|part| (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(part));
    fits.then(|| bits.map(|part| I4F28::from_bits(part as i32)))
}

/// Returns a position as it is.
pub fn exact_position(position: &Position) -> Vector {
    position.map(|part| f64::from(part.to_bits()) / f64::from(1 << 28))
}
