//! The numbers that the game is played in.

use fixed::types::I8F24;

/// A length in metres, a speed in metres a second, or a part of one: Q8.24, −128 up to 128.
pub type Number = I8F24;

/// Returns a product, rounded half up; it must lie in a [`Number`]'s range.
#[must_use]
pub fn product(a: Number, b: Number) -> Number {
    let product = i64::from(a.to_bits()) * i64::from(b.to_bits());
    Number::from_bits(((product + (1 << 23)) >> 24) as i32)
}

/// Returns `a · part/whole`, rounded towards zero: never longer than `a` where the part is no larger than the
/// whole. A `whole` of 0 gives 0.
#[must_use]
pub fn share(a: Number, part: Number, whole: Number) -> Number {
    let product = i64::from(a.to_bits()) * i64::from(part.to_bits());
    Number::from_bits(product.checked_div(whole.to_bits().into()).unwrap_or(0) as i32)
}

/// Returns a vector's length, rounded down; both parts must be within ±90.
#[must_use]
pub fn length([x, z]: [Number; 2]) -> Number {
    let square = |part: Number| i64::from(part.to_bits()) * i64::from(part.to_bits());
    Number::from_bits((square(x) + square(z)).isqrt() as i32)
}

/// Returns `a − b`.
#[must_use]
pub fn between(a: [Number; 2], b: [Number; 2]) -> [Number; 2] {
    [a[0] - b[0], a[1] - b[1]]
}
