//! The FPGA's design, and the seam behind which it is simulated.

use crate::time::Clocks;

/// The rasterizer in the FPGA, with its own clock.
pub trait Fpga {
    /// Reads the word at a byte offset of the register agent.
    fn read(&mut self, offset: u32, now: Clocks) -> u32;

    /// Writes the word at a byte offset of the register agent.
    fn write(&mut self, offset: u32, value: u32, now: Clocks);

    /// Writes a word to the FIFO's aperture and returns for how long the bus was held.
    fn push(&mut self, word: u32, now: Clocks) -> Clocks;

    /// Runs up to now.
    fn advance(&mut self, now: Clocks);

    /// Returns when the processor should look again, at the latest.
    fn next_event(&self, now: Clocks) -> Clocks;

    /// Returns the interrupt line.
    fn interrupt(&self) -> bool;

    /// Returns how many frames were shown since power-on: swaps that took place.
    fn frames_shown(&self) -> u64;

    /// Returns what shows: RGB332, row 0 on top.
    fn front(&mut self) -> Vec<u8>;

    /// Resets the design, as the processor's reset does.
    fn reset(&mut self);
}
