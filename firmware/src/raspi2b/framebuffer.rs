//! The display: the GPU's framebuffer, twice as high as the screen, so that one half shows while
//! the other is drawn.

use super::mailbox::{Mailbox, MailboxError};
use crate::software_fpga::{DISPLAY_HEIGHT, DISPLAY_WIDTH, Display};
use core::fmt;
use core::ptr::NonNull;

const SET_PHYSICAL_SIZE: u32 = 0x4_8003;
const SET_VIRTUAL_SIZE: u32 = 0x4_8004;
const SET_DEPTH: u32 = 0x4_8005;
const SET_PIXEL_ORDER: u32 = 0x4_8006;
const SET_VIRTUAL_OFFSET: u32 = 0x4_8009;
const ALLOCATE_BUFFER: u32 = 0x4_0001;
const PITCH: u32 = 0x4_0008;

/// Red in the high bits: a pixel's bytes lie in memory as blue, green, red, 0.
const BLUE_FIRST: u32 = 0;
/// The processor's address of a bus address: the upper two bits choose the GPU's cache.
const BUS_ADDRESS_MASK: u32 = 0x3FFF_FFFF;
/// Pixels in a row in memory. The GPU heeds an offset only when what it moves over is larger than the
/// screen both ways.
const VIRTUAL_WIDTH: usize = DISPLAY_WIDTH + 16;
/// Rows of both halves.
const VIRTUAL_HEIGHT: usize = 2 * DISPLAY_HEIGHT;
const BYTES_PER_PIXEL: usize = 4;

/// Half the framebuffer.
type Half = [u32; VIRTUAL_WIDTH * DISPLAY_HEIGHT];

/// Why there is no display.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum FramebufferError {
    /// The GPU did not answer.
    Mailbox(MailboxError),
    /// It gave another screen than was asked for.
    Shape {
        /// Pixels of the screen, then of both halves, wide and high.
        size: [u32; 4],
        /// Bits of a pixel.
        depth: u32,
        /// Bytes from a row to the next.
        pitch: u32,
    },
    /// It gave memory that does not lie in its own part of the SDRAM.
    Place {
        /// First byte.
        address: u32,
        /// Bytes.
        size: u32,
    },
}

impl From<MailboxError> for FramebufferError {
    fn from(error: MailboxError) -> Self {
        Self::Mailbox(error)
    }
}

impl fmt::Display for FramebufferError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Mailbox(error) => error.fmt(formatter),
            Self::Shape { size: [width, height, virtual_width, virtual_height], depth, pitch } => write!(
                formatter,
                "the GPU gave a screen of {width}x{height} in {virtual_width}x{virtual_height} pixels of {depth} bits, \
                 {pitch} bytes a row, not {DISPLAY_WIDTH}x{DISPLAY_HEIGHT} in {VIRTUAL_WIDTH}x{VIRTUAL_HEIGHT} of 32"
            ),
            Self::Place { address, size } => {
                write!(formatter, "the GPU gave a framebuffer of {size} bytes at {address:#010x}, outside its memory")
            }
        }
    }
}

impl core::error::Error for FramebufferError {}

/// A display of 640 × 480 pixels, each 0x00RRGGBB.
pub struct Framebuffer {
    mailbox: Mailbox,
    halves: [NonNull<Half>; 2],
    back: usize,
}

// SAFETY: the display owns its memory and its device.
unsafe impl Send for Framebuffer {}

impl Framebuffer {
    /// Asks the GPU for the screen, and clears both halves.
    ///
    /// # Errors
    /// [`FramebufferError`]; nothing shows then.
    ///
    /// # Safety
    /// The GPU's memory, `gpu_memory`, is mapped so that the GPU sees what is stored there, and
    /// nothing else uses the framebuffer that it gives.
    pub unsafe fn new(mut mailbox: Mailbox, gpu_memory: core::ops::Range<usize>) -> Result<Self, FramebufferError> {
        let (width, height) = (DISPLAY_WIDTH as u32, DISPLAY_HEIGHT as u32);
        let (mut physical, mut both) = ([width, height], [VIRTUAL_WIDTH as u32, VIRTUAL_HEIGHT as u32]);
        let (mut depth, mut pitch) = ([8 * BYTES_PER_PIXEL as u32], [0]);
        // In: the alignment; out: address and size.
        let mut buffer = [4096, 0];
        mailbox.exchange([
            (SET_PHYSICAL_SIZE, &mut physical),
            (SET_VIRTUAL_SIZE, &mut both),
            (SET_VIRTUAL_OFFSET, &mut [0, 0]),
            (SET_DEPTH, &mut depth),
            (SET_PIXEL_ORDER, &mut [BLUE_FIRST]),
            (ALLOCATE_BUFFER, &mut buffer),
            (PITCH, &mut pitch),
        ])?;
        let size = [physical[0], physical[1], both[0], both[1]];
        let wanted = [width, height, VIRTUAL_WIDTH as u32, VIRTUAL_HEIGHT as u32];
        if size != wanted || depth != [32] || pitch != [(VIRTUAL_WIDTH * BYTES_PER_PIXEL) as u32] {
            return Err(FramebufferError::Shape { size, depth: depth[0], pitch: pitch[0] });
        }
        let [address, size] = [buffer[0] & BUS_ADDRESS_MASK, buffer[1]];
        let (first, length) = (address as usize, 2 * size_of::<Half>());
        let fits = gpu_memory.contains(&first) && gpu_memory.end - first >= length && size as usize >= length;
        let half = |index: usize| {
            NonNull::new(core::ptr::with_exposed_provenance_mut::<Half>(first))
                .filter(|_| fits && first.is_multiple_of(BYTES_PER_PIXEL))
                // SAFETY: `fits` says that both halves lie in the memory.
                .map(|first| unsafe { first.add(index) })
                .ok_or(FramebufferError::Place { address, size })
        };
        let halves = [half(0)?, half(1)?];
        for half in halves {
            // SAFETY: the GPU gave the memory, the caller mapped it; all-zero words are pixels.
            unsafe { half.write_bytes(0, 1) };
        }
        Ok(Self { mailbox, halves, back: 1 })
    }
}

impl Display for Framebuffer {
    const STRIDE: usize = VIRTUAL_WIDTH;

    fn back(&mut self) -> &mut [u32] {
        // SAFETY: `new` got the memory for this display alone, it is all pixels, and the borrow of
        // `self` keeps a second reference away.
        unsafe { self.halves[self.back].as_mut() }
    }

    /// Shows the back half. A GPU that does not answer keeps the other one on the screen.
    fn present(&mut self) {
        let mut offset = [0, (self.back * DISPLAY_HEIGHT) as u32];
        if self.mailbox.exchange([(SET_VIRTUAL_OFFSET, &mut offset)]).is_ok() {
            self.back = 1 - self.back;
        }
    }
}
