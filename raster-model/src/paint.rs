//! The colour of a triangle's pixels.

use fpga_regs::packet::{Channels, GouraudTriangle};
use fpga_regs::screen::{COLOUR_FRACTION_BITS, Rgb332, dithered};

/// What gives each pixel its colour, moved along with the edges and the depth.
pub(crate) trait Paint: Copy {
    /// Moves `pixels` to the right.
    fn go_right(&mut self, pixels: usize);
    /// Moves one row down.
    fn go_down(&mut self);
    /// Returns the colour here, which is pixel (`x`, `y`) of the screen and has that depth.
    fn colour(&self, x: usize, y: usize, depth: u16) -> u8;
}

/// The same colour everywhere.
impl Paint for Rgb332 {
    #[inline(always)]
    fn go_right(&mut self, _: usize) {}

    #[inline(always)]
    fn go_down(&mut self) {}

    #[inline(always)]
    fn colour(&self, _: usize, _: usize, _: u16) -> u8 {
        self.0
    }
}

/// A plane in each channel, dithered. Sums are modulo 2³², of which the low 21 bits are looked at.
#[derive(Clone, Copy)]
pub(crate) struct Planes {
    here: [i32; 3],
    step_x: [i32; 3],
    step_y: [i32; 3],
}

impl From<&GouraudTriangle> for Planes {
    fn from(triangle: &GouraudTriangle) -> Self {
        Self { here: triangle.colour.0, step_x: triangle.colour_step_x.0, step_y: triangle.colour_step_y.0 }
    }
}

impl Paint for Planes {
    #[inline(always)]
    fn go_right(&mut self, pixels: usize) {
        for (channel, step) in self.here.iter_mut().zip(self.step_x) {
            *channel = channel.wrapping_add(step.wrapping_mul(pixels as i32));
        }
    }

    #[inline(always)]
    fn go_down(&mut self) {
        for (channel, step) in self.here.iter_mut().zip(self.step_y) {
            *channel = channel.wrapping_add(step);
        }
    }

    #[inline(always)]
    fn colour(&self, x: usize, y: usize, _: u16) -> u8 {
        dithered(self.here.map(saturated), x as u32, y as u32).0
    }
}

/// The depth as grey, the farther the darker, dithered.
#[derive(Clone, Copy)]
pub(crate) struct DepthGrey;

impl Paint for DepthGrey {
    fn go_right(&mut self, _: usize) {}

    fn go_down(&mut self) {}

    fn colour(&self, x: usize, y: usize, depth: u16) -> u8 {
        dithered([!((depth >> 8) as u8); 3], x as u32, y as u32).0
    }
}

/// A channel's 8 bits: 0…255 are themselves, what lies above or below by less than 128 saturates.
#[inline(always)]
fn saturated(channel: i32) -> u8 {
    let unused = 32 - Channels::BITS;
    match (channel as u32) << unused >> unused >> COLOUR_FRACTION_BITS {
        whole @ 0..256 => whole as u8,
        256..384 => u8::MAX,
        _ => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::saturated;

    #[test]
    fn a_channel_saturates_just_outside_its_range() {
        for whole in 0..512 {
            let expected = match whole {
                0..256 => whole as u8,
                256..384 => 255,
                _ => 0,
            };
            for more in [0, 1, 0xfff, 1 << 21, -1 << 21] {
                assert_eq!(saturated((whole << 12) + more), expected, "{whole} and {more}");
            }
        }
    }
}
