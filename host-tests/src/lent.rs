//! A software model with memory of its own.

use fpga_regs::registers::{Control, Register};
use fpga_regs::screen::PIXELS;
use raster_model::{Device, Memory};

/// Words of the model's FIFO.
pub const FIFO_WORDS: usize = 1024;

/// Makes a model, enables it, lends it to `work` and returns what that returns.
///
/// # Panics
/// If the model does not take buffers of the size that it asks for.
pub fn with_device<R>(work: impl FnOnce(&mut Device<'_>) -> R) -> R {
    let (mut first, mut second) = (vec![0; PIXELS], vec![0; PIXELS]);
    let (mut depth, mut fifo) = (vec![0; PIXELS], vec![0; FIFO_WORDS]);
    let memory = Memory::new([&mut first, &mut second], &mut depth).expect("the buffers have the screen's size");
    let mut device = Device::new(memory, &mut fifo).expect("the FIFO's depth is in range");
    device.write(Register::Control, Control::default().with_enable(true).0);
    work(&mut device)
}
