//! Model, view and projection matrices.
//!
//! Elements are Q32.32 ([`I32F32`]): enough range for any scene and enough fraction that a
//! product of several matrices is still exact where the vertex path can see it. A product of
//! matrices is worked out a few times a frame, so it can afford 128-bit sums; a vertex cannot,
//! and gets a [`ScreenTransform`](crate::ScreenTransform). What does the 128-bit sums is not inlined: it is large.

use fixed::types::I32F32;

use crate::angle::Angle;

/// A point or direction, Q32.32.
pub type Vector = [I32F32; 3];

/// A 4×4 matrix for column vectors, Q32.32, stored by rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Matrix {
    /// The rows, top one first.
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    pub rows: [[I32F32; 4]; 4],
}

const ONE: I32F32 = I32F32::ONE;
const ZERO: I32F32 = I32F32::ZERO;

impl Matrix {
    /// The matrix that changes nothing.
    pub const IDENTITY: Self = Self {
        rows: [[ONE, ZERO, ZERO, ZERO], [ZERO, ONE, ZERO, ZERO], [ZERO, ZERO, ONE, ZERO], [ZERO, ZERO, ZERO, ONE]],
    };

    /// Returns the matrix that moves by `offset`.
    pub fn translation(offset: Vector) -> Self {
        let mut matrix = Self::IDENTITY;
        for (row, offset) in matrix.rows.iter_mut().zip(offset) {
            row[3] = offset;
        }
        matrix
    }

    /// Returns the matrix that scales each axis by its factor.
    pub fn scaling(factors: Vector) -> Self {
        let mut matrix = Self::IDENTITY;
        for (axis, factor) in factors.into_iter().enumerate() {
            matrix.rows[axis][axis] = factor;
        }
        matrix
    }

    /// Returns the rotation about the x axis, counter-clockwise seen from its positive end.
    pub fn rotation_x(angle: Angle) -> Self {
        Self::rotation(angle, 1, 2)
    }

    /// Returns the rotation about the y axis, counter-clockwise seen from its positive end.
    pub fn rotation_y(angle: Angle) -> Self {
        Self::rotation(angle, 2, 0)
    }

    /// Returns the rotation about the z axis, counter-clockwise seen from its positive end.
    pub fn rotation_z(angle: Angle) -> Self {
        Self::rotation(angle, 0, 1)
    }

    /// The rotation that turns axis `from` towards axis `to`.
    fn rotation(angle: Angle, from: usize, to: usize) -> Self {
        let (sine, cosine) = angle.sin_cos();
        let (sine, cosine) = (I32F32::from(sine), I32F32::from(cosine));
        let mut matrix = Self::IDENTITY;
        matrix.rows[from][from] = cosine;
        matrix.rows[from][to] = -sine;
        matrix.rows[to][from] = sine;
        matrix.rows[to][to] = cosine;
        matrix
    }

    /// Returns OpenGL's perspective projection.
    ///
    /// `field_of_view` is the vertical angle, above 0 and below a half turn; `aspect` is width
    /// over height; `near` and `far` are distances, 0 < `near` < `far`. Quotients are rounded
    /// half up and saturate, so a parameter out of range gives a useless matrix, not a panic.
    pub fn perspective(field_of_view: Angle, aspect: I32F32, near: I32F32, far: I32F32) -> Self {
        let (sine, cosine) = Angle::from_bits(field_of_view.to_bits() / 2).sin_cos();
        let cotangent = divide(cosine.into(), sine.into());
        let mut rows = [[ZERO; 4]; 4];
        rows[0][0] = divide(cotangent, aspect);
        rows[1][1] = cotangent;
        [rows[2], rows[3]] = depth_rows(near, far);
        Self { rows }
    }

    /// Returns OpenGL's orthographic projection of a box: `x` and `y` are its (low, high) ends,
    /// `depth` its (near, far) distances along −z.
    ///
    /// An empty box gives a useless matrix, not a panic.
    pub fn orthographic(x: (I32F32, I32F32), y: (I32F32, I32F32), depth: (I32F32, I32F32)) -> Self {
        let mut matrix = Self::IDENTITY;
        let axes = [x, y, (depth.0.saturating_neg(), depth.1.saturating_neg())];
        for (axis, (low, high)) in axes.into_iter().enumerate() {
            let size = high.saturating_sub(low);
            matrix.rows[axis][axis] = divide(I32F32::from_num(2), size);
            matrix.rows[axis][3] = divide(high.saturating_add(low).saturating_neg(), size);
        }
        matrix
    }

    /// Returns OpenGL's frustum: a perspective through a window in the near plane. `x` and `y` are the
    /// window's (low, high) ends there, `depth` the (near, far) planes' distances, 0 < near < far.
    ///
    /// An empty window gives a useless matrix, not a panic.
    pub fn frustum(x: (I32F32, I32F32), y: (I32F32, I32F32), (near, far): (I32F32, I32F32)) -> Self {
        let mut rows = [[ZERO; 4]; 4];
        for (row, (low, high)) in [x, y].into_iter().enumerate() {
            let size = high.saturating_sub(low);
            rows[row][row] = divide(near.saturating_mul_int(2), size);
            rows[row][2] = divide(high.saturating_add(low), size);
        }
        [rows[2], rows[3]] = depth_rows(near, far);
        Self { rows }
    }

    /// Returns the view from `eye` towards `target`, with `up` upwards on screen.
    ///
    /// Returns `None` when `eye` and `target` are one point or `up` points along the view.
    pub fn look_at(eye: Vector, target: Vector, up: Vector) -> Option<Self> {
        let backward = normalise(subtract(eye, target))?;
        let right = normalise(cross(up, backward))?;
        let upward = cross(right, backward).map(I32F32::saturating_neg);
        let axes = [right, upward, backward];
        let mut matrix = Self::IDENTITY;
        for (row, axis) in matrix.rows.iter_mut().zip(axes) {
            row[..3].copy_from_slice(&axis);
            row[3] = dot(axis, eye).saturating_neg();
        }
        Some(matrix)
    }

    /// Returns the product `self · right`: first `right`, then `self`.
    ///
    /// Each element is a sum in 128 bits, rounded once, half up, and saturated.
    #[must_use]
    pub fn times(&self, right: &Self) -> Self {
        let mut rows = [[ZERO; 4]; 4];
        for (row, left) in rows.iter_mut().zip(&self.rows) {
            for (column, element) in row.iter_mut().enumerate() {
                *element = sum_of_products((0..4).map(|index| (left[index], right.rows[index][column])));
            }
        }
        Self { rows }
    }
}

/// The rows z and w of a projection in which what is farther is smaller.
#[inline(never)]
fn depth_rows(near: I32F32, far: I32F32) -> [[I32F32; 4]; 2] {
    let depth = near.saturating_sub(far);
    // 2·far·near/(near − far), with one rounding.
    let product = i128::from(far.to_bits()) * i128::from(near.to_bits());
    let offset = saturate(round_quotient(product.saturating_mul(2), i128::from(depth.to_bits())));
    [[ZERO, ZERO, divide(far.saturating_add(near), depth), offset], [ZERO, ZERO, -ONE, ZERO]]
}

/// Returns the scalar product: summed in 128 bits, rounded once, half up, saturated.
#[inline(never)]
pub fn dot(a: Vector, b: Vector) -> I32F32 {
    sum_of_products(a.into_iter().zip(b))
}

/// Returns the vector product; each part is rounded once, half up, and saturates.
#[inline(never)]
pub fn cross(a: Vector, b: Vector) -> Vector {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| sum_of_products([(a[i], b[j]), (a[j].saturating_neg(), b[i])].into_iter()))
}

/// Returns `a − b`, saturated.
pub fn subtract(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|axis| a[axis].saturating_sub(b[axis]))
}

/// Returns the vector of length 1 in the same direction, each part within 2⁻²⁹, or `None` for zero.
#[inline(never)]
pub fn normalise(vector: Vector) -> Option<Vector> {
    let parts = vector.map(I32F32::to_bits);
    let largest = parts.iter().map(|part| part.unsigned_abs()).max()?;
    if largest == 0 {
        return None;
    }
    // Shifted so that the largest part has 30 bits: the squares' sum then fits in 62.
    let shift = largest.leading_zeros() as i32 - 34;
    let parts = parts.map(|part| if shift >= 0 { part << shift } else { part >> -shift });
    let length = parts.iter().map(|part| part * part).sum::<i64>().isqrt();
    Some(parts.map(|part| I32F32::from_bits((part << 32) / length)))
}

fn sum_of_products(pairs: impl Iterator<Item = (I32F32, I32F32)>) -> I32F32 {
    let sum = pairs.fold(0, |sum, (a, b)| add_product(sum, a, b));
    saturate((sum + (1 << 29)) >> 30)
}

/// Adds a product to a sum, both Q62.
#[inline(never)]
fn add_product(sum: i128, a: I32F32, b: I32F32) -> i128 {
    sum + ((i128::from(a.to_bits()) * i128::from(b.to_bits())) >> 2)
}

/// `numerator/denominator`, rounded half up and saturated; a zero denominator saturates too.
#[inline(never)]
fn divide(numerator: I32F32, denominator: I32F32) -> I32F32 {
    saturate(round_quotient(i128::from(numerator.to_bits()) << 32, i128::from(denominator.to_bits())))
}

/// The quotient, rounded half up; a zero denominator gives the largest number of the right sign.
#[inline(never)]
fn round_quotient(numerator: i128, denominator: i128) -> i128 {
    let (numerator, denominator) = match denominator {
        0 => return numerator.signum() * i128::MAX,
        ..0 => (numerator.saturating_neg(), -denominator),
        _ => (numerator, denominator),
    };
    let (quotient, rest) = (numerator.div_euclid(denominator), numerator.rem_euclid(denominator));
    quotient + i128::from(rest >= denominator - rest)
}

fn saturate(bits: i128) -> I32F32 {
    I32F32::from_bits(bits.clamp(i128::from(i64::MIN), i128::from(i64::MAX)) as i64)
}
