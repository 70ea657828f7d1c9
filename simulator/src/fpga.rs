//! The FPGA's design, and the seam behind which it is simulated.

pub mod faulty;
pub mod model;
#[cfg(feature = "rtl")]
pub mod rtl;
pub mod vga;

use fpga_regs::screen::{HEIGHT, Rgb332, WIDTH};

use crate::time::Clocks;

/// What a screen on the VGA connector shows: 640×480.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Screen {
    pixels: Vec<[u8; 3]>,
}

impl Screen {
    /// Width in pixels.
    pub const WIDTH: u32 = 2 * WIDTH;
    /// Height in pixels.
    pub const HEIGHT: u32 = 2 * HEIGHT;

    /// Returns a screen of red, green and blue, row 0 on top; `None` unless it has the size.
    pub fn new(pixels: Vec<[u8; 3]>) -> Option<Self> {
        (pixels.len() == (Self::WIDTH * Self::HEIGHT) as usize).then_some(Self { pixels })
    }

    /// Returns a buffer of RGB332 with every pixel doubled both ways, as the scan-out does it.
    fn doubled(buffer: &[u8]) -> Self {
        let mut pixels = Vec::with_capacity(4 * buffer.len());
        for row in buffer.chunks(WIDTH as usize) {
            let doubled: Vec<[u8; 3]> = row.iter().flat_map(|colour| [Rgb332(*colour).to_rgb888(); 2]).collect();
            pixels.extend_from_slice(&doubled);
            pixels.extend_from_slice(&doubled);
        }
        Self { pixels }
    }

    /// Returns red, green and blue of each pixel, row 0 on top.
    pub fn pixels(&self) -> &[[u8; 3]] {
        &self.pixels
    }
}

/// The rasterizer in the FPGA, with its own clock.
pub trait Fpga {
    /// Reads the word at a byte offset of the register agent.
    fn read(&mut self, offset: u32, now: Clocks) -> u32;

    /// Writes the word at a byte offset of the register agent.
    fn write(&mut self, offset: u32, value: u32, now: Clocks);

    /// Writes a word to the FIFO's aperture and returns for how long the bus was held.
    fn push(&mut self, word: u32, now: Clocks) -> Clocks;

    /// Runs up to now, or not yet where it need not be looked at.
    fn advance(&mut self, now: Clocks);

    /// Returns when the processor should look again, at the latest.
    fn next_event(&self, now: Clocks) -> Clocks;

    /// Returns the interrupt line.
    fn interrupt(&self) -> bool;

    /// Returns how many frames were shown since power-on: swaps that took place.
    fn frames_shown(&self) -> u64;

    /// Returns what the screen shows: the last whole frame that was looked at, or `None` before there was one.
    fn screen(&mut self) -> Option<Screen>;

    /// Looks at the screen until one that is whole, and shows the last frame, has been scanned out; returns when
    /// that is.
    fn scanned_out(&mut self, now: Clocks) -> Clocks {
        now
    }

    /// Resets the design, as the processor's reset does.
    fn reset(&mut self, now: Clocks);
}
