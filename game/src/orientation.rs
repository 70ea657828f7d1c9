//! Which way round the ball lies: a unit quaternion.

use fixed::types::I2F30;

use crate::ball::RADIUS;
use crate::number::Number;

/// A rotation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Orientation {
    /// The real part, then i, j, k: Q30.
    parts: [i64; 4],
}

const ONE: i64 = 1 << 30;

impl Orientation {
    /// As it was made.
    pub const START: Self = Self { parts: [ONE, 0, 0, 0] };

    /// Turns as a ball does that rolls this way on the plate.
    ///
    /// It turns about (z, 0, −x) by the way over its radius; of half that angle sine and cosine are taken as the
    /// angle and 1, and what that does to the length is taken back: off by less than 0.3 % in a step of a sixth of
    /// a radian.
    pub fn roll(&mut self, [x, z]: [Number; 2]) {
        let half = |way: Number| (i64::from(way.to_bits()) * (ONE >> 1)) / i64::from(RADIUS.to_bits());
        let (a, c) = (half(z), -half(x));
        let [w, i, j, k] = self.parts;
        let turned = [
            w - to_q30(a * i + c * k),
            i + to_q30(a * w - c * j),
            j + to_q30(c * i - a * k),
            k + to_q30(c * w + a * j),
        ];
        let length = turned.iter().map(|part| part * part).sum::<i64>().isqrt().max(1);
        self.parts = turned.map(|part| part * ONE / length);
    }

    /// Returns the rotation's matrix, by rows.
    #[must_use]
    pub fn rows(&self) -> [[I2F30; 3]; 3] {
        let [w, i, j, k] = self.parts;
        let twice = |sum: i64| I2F30::from_bits(to_q30(2 * sum) as i32);
        let rest = |sum: i64| I2F30::from_bits((ONE - to_q30(2 * sum)) as i32);
        [
            [rest(j * j + k * k), twice(i * j - w * k), twice(i * k + w * j)],
            [twice(i * j + w * k), rest(i * i + k * k), twice(j * k - w * i)],
            [twice(i * k - w * j), twice(j * k + w * i), rest(i * i + j * j)],
        ]
    }
}

/// Q60 to Q30, rounded half up.
fn to_q30(sum: i64) -> i64 {
    (sum + (1 << 29)) >> 30
}
