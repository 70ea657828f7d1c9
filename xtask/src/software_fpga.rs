//! The FPGA's software model with memory of its own.

use std::cell::RefCell;
use std::rc::Rc;

use fpga_regs::registers::Register;
use fpga_regs::screen::{HEIGHT, PIXELS, Rgb332, WIDTH};
use fpga_regs::{Port, Wait};
use raster_model::{Device, Memory};

use crate::picture::Picture;

/// Depth of the model's FIFO in words: what the FPGA has, too.
const FIFO_WORDS: usize = 1024;

/// Makes a model, lends it to `work` and returns what that returns.
pub fn with_model<R>(work: impl FnOnce(&mut Device<'_>) -> R) -> R {
    let (mut first, mut second) = (vec![0; PIXELS], vec![0; PIXELS]);
    let (mut depth, mut fifo) = (vec![0; PIXELS], vec![0; FIFO_WORDS]);
    let memory = Memory::new([&mut first, &mut second], &mut depth).expect("the buffers have the screen's size");
    let mut device = Device::new(memory, &mut fifo).expect("the FIFO's depth is in range");
    work(&mut device)
}

/// A model that a renderer and an onlooker share.
#[derive(Clone)]
pub struct SharedModel<'a, 'memory>(Rc<RefCell<Shared<'a, 'memory>>>);

struct Shared<'a, 'memory> {
    device: &'a mut Device<'memory>,
    /// All words pushed, if they are kept.
    words: Option<Vec<u32>>,
}

impl<'a, 'memory> SharedModel<'a, 'memory> {
    /// Returns a handle that can be cloned.
    pub fn new(device: &'a mut Device<'memory>) -> Self {
        Self(Rc::new(RefCell::new(Shared { device, words: None })))
    }

    /// Returns a handle that keeps every word that is pushed, for [`take_words`](Self::take_words).
    pub fn recording(device: &'a mut Device<'memory>) -> Self {
        Self(Rc::new(RefCell::new(Shared { device, words: Some(Vec::new()) })))
    }

    /// Returns the words pushed since the last call; none unless they are kept.
    pub fn take_words(&self) -> Vec<u32> {
        self.0.borrow_mut().words.as_mut().map(std::mem::take).unwrap_or_default()
    }

    /// Returns the picture that the model shows.
    pub fn picture(&self) -> Picture {
        picture(self.0.borrow().device.front())
    }

    /// Returns the checksum of the picture that the model shows.
    pub fn checksum(&self) -> u32 {
        raster_model::picture_checksum(self.0.borrow().device.front())
    }
}

impl Port for SharedModel<'_, '_> {
    fn read(&mut self, register: Register) -> u32 {
        Port::read(self.0.borrow_mut().device, register)
    }

    fn write(&mut self, register: Register, value: u32) {
        Port::write(self.0.borrow_mut().device, register, value);
    }

    fn push(&mut self, words: &[u32]) {
        let mut shared = self.0.borrow_mut();
        if let Some(kept) = &mut shared.words {
            kept.extend(words);
        }
        Port::push(shared.device, words);
    }
}

/// Waiting for a model: it is done at once.
#[derive(Debug, Clone, Copy)]
pub struct NoWait;

impl Wait for NoWait {
    const INTERRUPT: bool = false;

    fn wait(&mut self, micros: u32) -> u32 {
        micros
    }
}

/// Returns an RGB332 buffer as a picture.
pub fn picture(buffer: &[u8]) -> Picture {
    let pixels = buffer.iter().flat_map(|pixel| Rgb332(*pixel).to_rgb888()).collect();
    Picture::new(WIDTH, HEIGHT, pixels).expect("the buffer has the screen's size")
}

/// Returns a picture of the doubled screen as the RGB332 buffer that it was made from, or says
/// where it cannot have come from one.
///
/// # Errors
/// When the size is not the doubled screen's, when the four pixels of a doubled one differ, or
/// when a colour is none that RGB332 has.
pub fn buffer_of_screen(screen: &Picture) -> anyhow::Result<Vec<u8>> {
    let size = (screen.width(), screen.height());
    anyhow::ensure!(
        size == (2 * WIDTH, 2 * HEIGHT),
        "the machine's screen has {}×{} pixels instead of {}×{}",
        size.0,
        size.1,
        2 * WIDTH,
        2 * HEIGHT
    );
    let pixels: Vec<[u8; 3]> = screen.pixels().collect();
    let mut buffer = Vec::with_capacity(PIXELS);
    for row in 0..HEIGHT as usize {
        for column in 0..WIDTH as usize {
            let at = |right: usize, down: usize| pixels[(2 * row + down) * 2 * WIDTH as usize + 2 * column + right];
            let [red, green, blue] = at(0, 0);
            let colour = Rgb332::nearest(red, green, blue);
            let all = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
            anyhow::ensure!(
                all == [colour.to_rgb888(); 4],
                "pixel ({column}, {row}) of the machine's screen shows {all:?}: no doubled RGB332 colour"
            );
            buffer.push(colour.0);
        }
    }
    Ok(buffer)
}
