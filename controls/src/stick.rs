//! Sticks, and how their way becomes their effect.

use core::f32::consts::FRAC_PI_2;
use fixed::types::I2F14;
use micromath::F32Ext;

/// Holds where a stick is. Each axis runs from −1 to 1, both ends included: that is why it is
/// `I2F14` and not `I1F15`, which ends one unit short of 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stick {
    /// Positive to the right.
    pub x: I2F14,
    /// Positive away from the player: up.
    pub y: I2F14,
}

impl Stick {
    /// At rest.
    pub const CENTRE: Self = Self { x: I2F14::ZERO, y: I2F14::ZERO };

    /// Reads the two bytes of a stick: 0 is left or top, 0xFF right or bottom.
    #[must_use]
    pub fn from_raw([x, y]: [u8; 2], response: StickResponse) -> Self {
        Self { x: response.axis(x), y: -response.axis(y) }
    }

    /// Adds up two sticks, each axis up to ±1.
    pub(crate) fn merged(self, other: Self) -> Self {
        let sum = |one: I2F14, two| one.saturating_add(two).clamp(I2F14::NEG_ONE, I2F14::ONE);
        Self { x: sum(self.x, other.x), y: sum(self.y, other.y) }
    }
}

#[cfg(feature = "defmt")]
impl defmt::Format for Stick {
    fn format(&self, formatter: defmt::Formatter<'_>) {
        let [x, y] = [self.x, self.y].map(I2F14::to_bits);
        defmt::write!(formatter, "Stick {{ {}, {} }}/16384", x, y);
    }
}

/// Names the curve from a stick's way to its effect.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum StickResponse {
    /// The effect is the way.
    Linear,
    /// The effect is 1 − cos(way · 90°): fine near the centre (a tenth of the way has an eightieth of
    /// the effect), fast at the ends, without a step anywhere.
    #[default]
    Progressive,
}

impl StickResponse {
    /// A stick at rest reads from 0x79 to 0x85; those are all 0.
    const REST_LOW: u8 = 0x79;
    const REST_HIGH: u8 = 0x85;

    /// Converts one byte of a stick: 0 is −1, 0xFF is 1, and no byte gives less than a lower one.
    fn axis(self, raw: u8) -> I2F14 {
        if raw < Self::REST_LOW {
            -self.effect(Self::REST_LOW - raw, Self::REST_LOW)
        } else {
            self.effect(raw.saturating_sub(Self::REST_HIGH), u8::MAX - Self::REST_HIGH)
        }
    }

    /// Converts a way out of all that there is. The ends are exact; between them `micromath`'s cosine,
    /// off by up to 0.002, is good enough. (Its power is not: it is off by 0.12 here.)
    fn effect(self, way: u8, whole: u8) -> I2F14 {
        match way {
            0 => I2F14::ZERO,
            _ if way >= whole => I2F14::ONE,
            _ => {
                let part = f32::from(way) / f32::from(whole);
                let effect = match self {
                    Self::Linear => part,
                    Self::Progressive => 1.0 - F32Ext::cos(part * FRAC_PI_2),
                };
                I2F14::checked_from_num(effect).unwrap_or(I2F14::ONE).min(I2F14::ONE)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Stick, StickResponse};
    use fixed::types::I2F14;

    const BOTH: [StickResponse; 2] = [StickResponse::Linear, StickResponse::Progressive];

    #[test]
    fn the_ends_are_exact_and_rest_is_zero() {
        for response in BOTH {
            assert_eq!(response.axis(0), -1);
            assert_eq!(response.axis(255), 1);
            for raw in 0x79..=0x85 {
                assert_eq!(response.axis(raw), 0, "{raw:#04x}");
            }
        }
    }

    #[test]
    fn it_rises_with_every_byte_outside_the_rest() {
        for response in BOTH {
            for raw in 1..=255_u8 {
                let (before, here) = (response.axis(raw - 1), response.axis(raw));
                if (0x7A..=0x85).contains(&raw) {
                    assert_eq!(before, here);
                } else {
                    assert!(before < here, "{response:?} {raw:#04x}: {before} then {here}");
                }
            }
        }
    }

    #[test]
    fn it_follows_the_curve() {
        for raw in 0..=255_u8 {
            let way = match raw {
                0..0x79 => f64::from(raw) / 121.0 - 1.0,
                0x79..=0x85 => 0.0,
                _ => (f64::from(raw) - 133.0) / 122.0,
            };
            let off = |response: StickResponse, exact: f64| (response.axis(raw).to_num::<f64>() - exact).abs();
            assert!(off(StickResponse::Linear, way) < 1e-4, "{raw:#04x}");
            let curve = (1.0 - (way * core::f64::consts::FRAC_PI_2).cos()).copysign(way);
            assert!(off(StickResponse::Progressive, curve) < 2e-3, "{raw:#04x}");
        }
    }

    #[test]
    fn right_and_up_are_positive() {
        let stick = Stick::from_raw([0xFF, 0x00], StickResponse::Progressive);
        assert_eq!(stick, Stick { x: I2F14::ONE, y: I2F14::ONE });
    }

    #[test]
    fn two_sticks_make_no_more_than_one() {
        let corner = Stick { x: I2F14::ONE, y: I2F14::NEG_ONE };
        assert_eq!(corner.merged(corner), corner);
        let back = Stick { x: -corner.x, y: -corner.y };
        assert_eq!(corner.merged(back), Stick::CENTRE);
    }
}
