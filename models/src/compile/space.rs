//! Where a model's coordinates lie, and the numbers that stand for them.

use super::CompileError;

/// Magnitudes of the largest coordinate that are kept as they are; others are scaled by a power of two.
const KEPT: std::ops::Range<f64> = 0.0625..7.99;
/// What others are scaled to: 2 to 4, as log₂ of the upper end.
const SCALED_LOG2: i32 = 2;
/// Units of a coordinate.
const ONE: f64 = (1 << 28) as f64;

/// The way from a model's coordinates to a file's numbers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Space {
    centre: [f64; 3],
    /// What a coordinate is multiplied by to give units of 2⁻²⁸.
    factor: f64,
    pub(super) offset: [i32; 3],
    pub(super) step: [u32; 3],
    pub(super) scale_log2: i16,
}

impl Space {
    /// Returns the space of a model's positions.
    pub(super) fn new(positions: &[[f64; 3]], scale_to_fit: bool) -> Result<Self, CompileError> {
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for position in positions {
            low = [0, 1, 2].map(|axis| low[axis].min(position[axis]));
            high = [0, 1, 2].map(|axis| high[axis].max(position[axis]));
        }
        let largest = low.iter().chain(&high).fold(0.0f64, |largest, part| largest.max(part.abs()));
        if largest > 1e100 || (largest > 0.0 && largest < 1e-100) {
            return Err(CompileError::Size { largest });
        }
        let (centre, scale, scale_log2) = if scale_to_fit {
            let centre = [0, 1, 2].map(|axis| low[axis] / 2.0 + high[axis] / 2.0);
            let radius = radius(positions, centre);
            (centre, if radius > 0.0 { 1.0 / radius } else { 1.0 }, 0)
        } else if largest == 0.0 || KEPT.contains(&largest) {
            ([0.0; 3], 1.0, 0)
        } else {
            let scale_log2 = largest.log2().floor() as i32 + 1 - SCALED_LOG2;
            ([0.0; 3], f64::from(-scale_log2).exp2(), scale_log2 as i16)
        };
        let factor = scale * ONE;
        let unit = |axis: usize, part: f64| (part - centre[axis]) * factor;
        let offset = [0, 1, 2].map(|axis| unit(axis, low[axis]).floor());
        // Rounded up, so that the last number reaches the highest coordinate.
        let step = [0, 1, 2].map(|axis| ((unit(axis, high[axis]) - offset[axis]) / f64::from(u16::MAX)).ceil());
        Ok(Self {
            centre,
            factor,
            offset: offset.map(|part| part as i32),
            step: step.map(|part| part as u32),
            scale_log2,
        })
    }

    /// Returns a position's numbers.
    pub(super) fn numbers(&self, position: [f64; 3]) -> [u16; 3] {
        [0, 1, 2].map(|axis| {
            let units = (position[axis] - self.centre[axis]) * self.factor - f64::from(self.offset[axis]);
            (units / f64::from(self.step[axis].max(1))).round() as u16
        })
    }

    /// Returns how far a coordinate may be off, in the model's units: half a step.
    pub(super) fn error_bound(&self) -> f64 {
        let step = self.step.iter().max().copied().unwrap_or(0);
        f64::from(step.max(1)) / 2.0 / self.factor
    }
}

fn radius(positions: &[[f64; 3]], centre: [f64; 3]) -> f64 {
    let side = |position: &[f64; 3]| [0, 1, 2].map(|axis| position[axis] - centre[axis]);
    // Of a unit, so that squares neither overflow nor vanish.
    let unit = positions.iter().flat_map(side).fold(0.0f64, |unit, part| unit.max(part.abs()));
    let square = |position: &[f64; 3]| side(position).iter().map(|part| (part / unit) * (part / unit)).sum::<f64>();
    if unit > 0.0 { unit * positions.iter().map(square).fold(0.0, f64::max).sqrt() } else { 0.0 }
}
