//! The memory that the device draws in, lent by the caller.

use core::fmt;

use fpga_regs::packet::Packet;
use fpga_regs::screen::PIXELS;

/// A colour buffer: [`PIXELS`] bytes of RGB332, row 0 on top, each row from left to right.
pub(crate) type Colours = [u8; PIXELS];
/// The depth buffer: [`PIXELS`] depths in the same order, 0 near, 65,535 far.
pub(crate) type Depths = [u16; PIXELS];

/// Fewest words that a FIFO has: the driver refuses a device with fewer.
pub(crate) const FIFO_WORDS_MIN: usize = 2 * Packet::MAX_WORDS;
/// Most words that CAPABILITIES can name.
pub(crate) const FIFO_WORDS_MAX: usize = u16::MAX as usize;

/// A buffer that is not of the size the device needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum SizeError {
    /// A colour buffer does not hold a screen's pixels.
    Colour {
        /// Which one: 0 or 1.
        buffer: usize,
        /// Its length in bytes.
        found: usize,
    },
    /// The depth buffer does not hold a screen's pixels.
    Depth {
        /// Its length in depths.
        found: usize,
    },
    /// The FIFO is too small for the driver or too large for CAPABILITIES.
    Fifo {
        /// Its length in words.
        found: usize,
    },
}

impl fmt::Display for SizeError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Colour { buffer, found } => {
                write!(out, "colour buffer {buffer} has {found} bytes: lend one of {PIXELS}")
            }
            Self::Depth { found } => write!(out, "depth buffer has {found} depths: lend one of {PIXELS}"),
            Self::Fifo { found } => {
                write!(out, "FIFO has {found} words: lend one of {FIFO_WORDS_MIN} to {FIFO_WORDS_MAX}")
            }
        }
    }
}

impl core::error::Error for SizeError {}

/// Two colour buffers, of which one shows, and the depth buffer.
///
/// Buffer 0 shows at first. What the buffers hold is kept until a packet changes it.
pub struct Memory<'a> {
    colours: [&'a mut Colours; 2],
    depths: &'a mut Depths,
    front: usize,
}

impl<'a> Memory<'a> {
    /// Takes two colour buffers of [`PIXELS`] bytes and a depth buffer of [`PIXELS`] depths.
    ///
    /// # Errors
    /// [`SizeError::Colour`] or [`SizeError::Depth`] when a buffer has another length.
    pub fn new(colour: [&'a mut [u8]; 2], depth: &'a mut [u16]) -> Result<Self, SizeError> {
        let [first, second] = colour;
        let colours = [sized(first, 0)?, sized(second, 1)?];
        let found = depth.len();
        let depths = depth.try_into().map_err(|_| SizeError::Depth { found })?;
        Ok(Self { colours, depths, front: 0 })
    }

    /// Returns which buffer shows: 0 or 1.
    pub fn front_index(&self) -> usize {
        self.front
    }

    /// Returns the colours of the buffer that shows.
    pub fn front(&self) -> &[u8] {
        &self.colours[self.front][..]
    }

    /// Returns the colours of the buffer that is drawn to.
    pub fn back(&self) -> &[u8] {
        &self.colours[1 - self.front][..]
    }

    /// Returns the depths.
    pub fn depth(&self) -> &[u16] {
        &self.depths[..]
    }

    /// Returns what is drawn to: the back buffer and the depth buffer.
    pub(crate) fn target(&mut self) -> (&mut Colours, &mut Depths) {
        (self.colours[1 - self.front], self.depths)
    }

    /// Makes the back buffer the front one.
    pub(crate) fn swap(&mut self) {
        self.front = 1 - self.front;
    }
}

impl fmt::Debug for Memory<'_> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.debug_struct("Memory").field("front", &self.front).finish_non_exhaustive()
    }
}

fn sized(colour: &mut [u8], buffer: usize) -> Result<&mut Colours, SizeError> {
    let found = colour.len();
    colour.try_into().map_err(|_| SizeError::Colour { buffer, found })
}
