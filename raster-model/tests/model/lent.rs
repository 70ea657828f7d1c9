//! The buffers that a test lends to a device.

use fpga_regs::registers::{Control, Register};
use fpga_regs::screen::PIXELS;
use raster_model::{Device, Memory};

/// Words of the FIFO that tests lend.
pub const FIFO_WORDS: usize = 40;

/// Buffers for one device.
pub struct Lent {
    colours: [Vec<u8>; 2],
    depths: Vec<u16>,
    fifo: Vec<u32>,
}

impl Lent {
    /// Returns buffers full of zeros.
    pub fn new() -> Self {
        Self { colours: [vec![0; PIXELS], vec![0; PIXELS]], depths: vec![0; PIXELS], fifo: vec![0; FIFO_WORDS] }
    }

    /// Returns a disabled device on the buffers.
    pub fn device(&mut self) -> Device<'_> {
        let [first, second] = &mut self.colours;
        let memory = Memory::new([first, second], &mut self.depths).unwrap();
        Device::new(memory, &mut self.fifo).unwrap()
    }

    /// Returns an enabled device on the buffers.
    pub fn enabled(&mut self) -> Device<'_> {
        let mut device = self.device();
        device.write(Register::Control, Control::default().with_enable(true).0);
        device
    }
}
