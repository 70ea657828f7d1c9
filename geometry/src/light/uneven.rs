//! Light that is coloured, or falls on an object that is scaled unevenly.

use super::{DIRECTION_BITS, DOT_BITS, Intensity};
use crate::matrix::Matrix;
use crate::reciprocal::reciprocal;

/// By what part of their squares' sum, as a power of two, the axes of an evenly scaled object may
/// differ in length, and be askew.
const EVEN_BITS: u32 = 12;
/// Bits of the largest element of the matrix that turns normals.
const NORMAL_MATRIX_BITS: u32 = 30;
/// Bits of the largest part of a normal that it has turned.
const TURNED_BITS: u32 = 15;

/// A light that is coloured, or in world space with the way that an object's normals get there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct UnevenLight {
    /// Its channels' parts of full white, Q16.16.
    colour: [u32; 3],
    /// Q4.28, and half a 256th.
    ambient: i32,
    way: Way,
}

/// Where normals and light meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Way {
    /// In the object's own space: it is scaled evenly. Towards the light, Q18.14, times the diffuse intensity.
    Object([i32; 3]),
    /// In world space, for an object that is scaled unevenly.
    World {
        /// Towards the light, Q18.14, times the diffuse intensity.
        direction: [i32; 3],
        /// Rows of the matrix that turns normals, of any scale, below 2³⁰.
        normals: [[i64; 3]; 3],
    },
}

impl UnevenLight {
    /// Returns the light if it is coloured, or if the model matrix does more than turn, move and
    /// scale evenly. `local` and `world` point towards it in these spaces.
    pub(super) fn new(colour: [u8; 3], local: [i32; 3], world: [i32; 3], ambient: i32, model: &Matrix) -> Option<Self> {
        let columns = [0, 1, 2].map(|axis| [0, 1, 2].map(|row: usize| i128::from(model.rows[row][axis].to_bits())));
        let even = is_even(&columns);
        if colour == [255; 3] && even {
            return None;
        }
        let way = if even { Way::Object(local) } else { Way::World { direction: world, normals: normals(columns) } };
        Some(Self { colour: colour.map(|channel| (u32::from(channel) * 65_536 + 127) / 255), ambient, way })
    }

    /// Returns a lit colour, rounded half up.
    #[inline(never)]
    pub(crate) fn lit(&self, normal: [i16; 3], colour: [u8; 3]) -> [u8; 3] {
        let diffuse = match &self.way {
            Way::Object(direction) => dot(normal.map(i32::from), direction).max(0),
            Way::World { direction, normals } => diffuse(normal, direction, normals),
        };
        [0, 1, 2].map(|channel| {
            let light = ((u64::from(diffuse as u32) * u64::from(self.colour[channel])) >> 16) as i32 + self.ambient;
            let [lit, ..] = Intensity((light >> (DOT_BITS - 8)).min(256) as u32).colour([colour[channel]; 3]);
            lit
        })
    }
}

/// Returns the matrix that turns the normals of an object with these axes, by rows.
#[inline(never)]
fn normals([a, b, c]: [[i128; 3]; 3]) -> [[i64; 3]; 3] {
    // Normals turn by the inverse's transpose: but for the determinant, the matrix of cofactors,
    // whose columns are the cross products of the model's other two. A mirror's determinant is
    // negative, and turns them round.
    let cofactors = [cross(b, c), cross(c, a), cross(a, b)];
    // Of the determinant only the sign counts; its terms are Q96 and need not fit.
    let mirrored = sign_of_dot(cofactors[0], a) < 0;
    let largest = cofactors.as_flattened().iter().map(|part| part.unsigned_abs()).max().unwrap_or(0);
    let shift = (u128::BITS - largest.leading_zeros()).saturating_sub(NORMAL_MATRIX_BITS);
    let element = |row: usize, column: usize| {
        let part = (cofactors[column][row] >> shift) as i64;
        if mirrored { -part } else { part }
    };
    [0, 1, 2].map(|row| [0, 1, 2].map(|column| element(row, column)))
}

/// Returns the cosine between a normal and the light, times the diffuse intensity, Q28, 0 or more.
fn diffuse(normal: [i16; 3], direction: &[i32; 3], normals: &[[i64; 3]; 3]) -> i32 {
    // Below 2³⁰ · 2¹⁵ · 3.
    let turned = normals.map(|row| row.iter().zip(normal).map(|(a, b)| a * i64::from(b)).sum::<i64>());
    let largest = turned.iter().map(|part| part.unsigned_abs()).max().unwrap_or(0);
    if largest == 0 {
        return 0;
    }
    // 15 bits each, so that the squares' sum fits in 32.
    let shift = 64 - TURNED_BITS as i32 - largest.leading_zeros() as i32;
    let turned = turned.map(|part| (if shift >= 0 { part >> shift } else { part << -shift }) as i32);
    let cosine = dot(turned, direction);
    if cosine <= 0 {
        return 0;
    }
    let square: u32 = turned.iter().map(|part| (part * part) as u32).sum();
    // Of 15 or 16 bits, so that the cosine is within 2⁻¹⁴ of its own size.
    let length = square.isqrt();
    let normalising = length.leading_zeros();
    // 2⁶¹ over the length, less 2^normalising; the cosine times the length is Q14 and is to be Q28 without it.
    let over_length = u64::from(reciprocal(length << normalising).unsigned_abs());
    ((u64::from(cosine as u32) * over_length) >> (61 - (DOT_BITS - DIRECTION_BITS) - normalising)) as i32
}

/// The scalar product; of vectors of 15 bits and of a length of 2¹⁴ it fits.
fn dot(a: [i32; 3], b: &[i32; 3]) -> i32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Whether three axes are equally long and at right angles to one another, not mirrored.
fn is_even(columns: &[[i128; 3]; 3]) -> bool {
    let dot = |a: &[i128; 3], b: &[i128; 3]| -> i128 { a.iter().zip(b).map(|(a, b)| product(a >> 2, b >> 2)).sum() };
    let [a, b, c] = columns;
    let squares = [dot(a, a), dot(b, b), dot(c, c)];
    let allowed = squares.iter().sum::<i128>() >> EVEN_BITS;
    let level = |x: i128, y: i128| (x - y).abs() <= allowed;
    level(squares[0], squares[1])
        && level(squares[1], squares[2])
        && [dot(a, b), dot(b, c), dot(c, a)].into_iter().all(|askew| askew.abs() <= allowed)
        && sign_of_dot(cross(*b, *c), *a) > 0
}

#[inline(never)]
fn cross([ax, ay, az]: [i128; 3], [bx, by, bz]: [i128; 3]) -> [i128; 3] {
    // Elements have 64 bits; two bits less each keep the difference in 128.
    let product = |a: i128, b: i128| product(a >> 1, b >> 1);
    [product(ay, bz) - product(az, by), product(az, bx) - product(ax, bz), product(ax, by) - product(ay, bx)]
}

/// A product in 128 bits: large, so that it is there once.
#[inline(never)]
fn product(a: i128, b: i128) -> i128 {
    a * b
}

/// The sign of a dot product of a vector of products with one of elements.
#[inline(never)]
fn sign_of_dot(products: [i128; 3], elements: [i128; 3]) -> i32 {
    let largest = products.iter().map(|part| part.unsigned_abs()).max().unwrap_or(0);
    // 62 bits times 64, three of them.
    let shift = (u128::BITS - largest.leading_zeros()).saturating_sub(60);
    let sum: i128 = products.iter().zip(elements).map(|(a, b)| product(a >> shift, b)).sum();
    sum.signum() as i32
}
