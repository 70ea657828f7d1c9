//! The software model as a [`Port`].

use fpga_regs::Port;
use fpga_regs::registers::Register;
use fpga_regs::screen::{PIXELS, Rgb332, WIDTH};
use raster_model::{Device, Memory, SizeError, picture_checksum};

use super::display::{DISPLAY_WIDTH, Display};

/// Words of the model's FIFO: what the FPGA has, too.
const FIFO_WORDS: usize = 1024;

/// Memory for the model; large, so a static.
pub struct ModelMemory {
    colour: [[u8; PIXELS]; 2],
    depth: [u16; PIXELS],
    fifo: [u32; FIFO_WORDS],
}

impl ModelMemory {
    /// Empty memory, for a static.
    pub const fn new() -> Self {
        Self { colour: [[0; PIXELS]; 2], depth: [0; PIXELS], fifo: [0; FIFO_WORDS] }
    }
}

impl Default for ModelMemory {
    fn default() -> Self {
        Self::new()
    }
}

/// A [`Port`] on the software model. Whenever a swap took place, what is now in front is doubled
/// to the display, as the FPGA's VGA output does it.
pub struct ModelPort<D> {
    device: Device<'static>,
    display: D,
    frames_shown: u32,
}

impl<D: Display> ModelPort<D> {
    /// Returns the port on a model in `memory` that shows on `display`.
    ///
    /// # Errors
    /// [`SizeError`] if the memory had not the screen's size, which its type rules out.
    pub fn new(memory: &'static mut ModelMemory, display: D) -> Result<Self, SizeError> {
        let [first, second] = &mut memory.colour;
        let memory_of_device = Memory::new([first, second], &mut memory.depth)?;
        Ok(Self { device: Device::new(memory_of_device, &mut memory.fifo)?, display, frames_shown: 0 })
    }

    /// Returns the checksum of the picture that shows.
    pub fn checksum(&self) -> u32 {
        picture_checksum(self.device.front())
    }

    fn show(&mut self) {
        let rows = self.display.back().chunks_exact_mut(2 * D::STRIDE);
        for (pair, source) in rows.zip(self.device.front().chunks_exact(WIDTH as usize)) {
            let (upper, lower) = pair.split_at_mut(D::STRIDE);
            let (upper, lower) = (&mut upper[..DISPLAY_WIDTH], &mut lower[..DISPLAY_WIDTH]);
            for (pixels, colour) in upper.as_chunks_mut::<2>().0.iter_mut().zip(source) {
                *pixels = [COLOURS[usize::from(*colour)]; 2];
            }
            lower.copy_from_slice(upper);
        }
        self.display.present();
    }
}

/// Each RGB332 colour as the display wants it: 0x00RRGGBB.
static COLOURS: [u32; 256] = {
    let mut colours = [0; 256];
    let mut index = 0;
    while index < colours.len() {
        let [red, green, blue] = Rgb332(index as u8).to_rgb888();
        colours[index] = u32::from_be_bytes([0, red, green, blue]);
        index += 1;
    }
    colours
};

impl<D: Display> Port for ModelPort<D> {
    fn read(&mut self, register: Register) -> u32 {
        Port::read(&mut self.device, register)
    }

    fn write(&mut self, register: Register, value: u32) {
        Port::write(&mut self.device, register, value);
    }

    fn push(&mut self, words: &[u32]) {
        Port::push(&mut self.device, words);
        let shown = self.device.counters().frames_shown;
        if shown != self.frames_shown {
            self.frames_shown = shown;
            self.show();
        }
    }
}
