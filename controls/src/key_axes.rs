//! Directions that a key can push, and sets of them.

use fixed::types::I2F14;

/// Names a direction that a key pushes while it is down.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum KeyAxis {
    /// Tilts with the left side down: roll rises.
    RollLeft = 0,
    /// Tilts with the right side down: roll falls.
    RollRight = 1,
    /// Tilts with the far edge up: pitch rises.
    PitchUp = 2,
    /// Tilts with the far edge down: pitch falls.
    PitchDown = 3,
    /// Pushes the left stick to the left.
    PanLeft = 4,
    /// Pushes the left stick to the right.
    PanRight = 5,
    /// Pushes the left stick up.
    PanUp = 6,
    /// Pushes the left stick down.
    PanDown = 7,
    /// Pushes the right stick to the left.
    TurnLeft = 8,
    /// Pushes the right stick to the right.
    TurnRight = 9,
    /// Pushes the right stick up.
    ZoomIn = 10,
    /// Pushes the right stick down.
    ZoomOut = 11,
}

/// Holds a set of directions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct KeyAxes(u16);

impl KeyAxes {
    /// Puts one more direction in.
    pub(crate) fn insert(&mut self, axis: KeyAxis) {
        self.0 |= 1 << axis as u16;
    }

    /// Returns what either set has.
    pub(crate) fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Returns what this set has and the other has not.
    pub(crate) fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Returns whether the set has a direction.
    pub(crate) fn contains(self, axis: KeyAxis) -> bool {
        self.0 >> axis as u16 & 1 == 1
    }

    /// Returns 1, −1, or 0 if neither direction or both are in the set.
    pub(crate) fn balance(self, positive: KeyAxis, negative: KeyAxis) -> i32 {
        let has = |axis: KeyAxis| i32::from(self.contains(axis));
        has(positive) - has(negative)
    }

    /// Returns the same as a stick's axis.
    pub(crate) fn deflection(self, positive: KeyAxis, negative: KeyAxis) -> I2F14 {
        match self.balance(positive, negative) {
            1 => I2F14::ONE,
            -1 => I2F14::NEG_ONE,
            _ => I2F14::ZERO,
        }
    }
}
