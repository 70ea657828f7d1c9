//! The display: a PL111 with two frames (ARM DDI 0293).

use crate::mmio::{Register, Registers};
use crate::software_fpga::{DISPLAY_HEIGHT, DISPLAY_WIDTH, Display};
use core::ptr::NonNull;

/// Pixels in a frame.
pub const FRAME_PIXELS: usize = DISPLAY_WIDTH * DISPLAY_HEIGHT;
const _: () = assert!(DISPLAY_WIDTH == 640 && DISPLAY_HEIGHT == 480, "the timing below is for 640 × 480 pixels");

/// On, 24 bits in 32, a TFT panel, power on. BGR puts red into bits 23 to 16.
const CONTROL: u32 = 1 << 0 | 0b101 << 1 | 1 << 5 | 1 << 8 | 1 << 11;
/// 640 pixels a row, 96 clocks of synchronisation, 16 in front and 48 behind.
const TIMING_0: u32 = (640 / 16 - 1) << 2 | 95 << 8 | 15 << 16 | 47 << 24;
/// 480 rows, 2 rows of synchronisation, 9 in front and 32 behind.
const TIMING_1: u32 = 479 | 1 << 10 | 9 << 16 | 32 << 24;
/// 640 clocks a row, synchronisation active low, divider bypassed.
const TIMING_2: u32 = 0x067F_1800;

#[derive(Clone, Copy)]
enum Offset {
    Timing0 = 0x00,
    Timing1 = 0x04,
    Timing2 = 0x08,
    UpperBase = 0x10,
    Control = 0x18,
    InterruptMask = 0x1C,
}

impl Register for Offset {
    fn offset(self) -> usize {
        self as usize
    }
}

/// A display of 640 × 480 pixels, each 0x00RRGGBB. One frame shows while the other is drawn.
pub struct Pl111 {
    registers: Registers<Offset>,
    frames: [NonNull<[u32; FRAME_PIXELS]>; 2],
    back: usize,
}

// SAFETY: the display owns its frames and its device.
unsafe impl Send for Pl111 {}

impl Pl111 {
    /// Clears both frames and turns the display on.
    ///
    /// # Safety
    /// - A PL111 answers at `address`, and no other driver writes to it.
    /// - At each of `frames`, a frame's worth of RAM lies that nothing else uses, mapped so that
    ///   the PL111 sees what is stored there.
    ///
    /// # Panics
    /// When a frame is at address 0.
    #[must_use]
    pub unsafe fn new(address: usize, frames: [usize; 2]) -> Self {
        let frames = frames.map(|frame| {
            let frame: *mut [u32; FRAME_PIXELS] = core::ptr::with_exposed_provenance_mut(frame);
            let frame = NonNull::new(frame).expect("a frame is not at address 0");
            // SAFETY: the caller gives RAM of that size; all-zero words are pixels.
            unsafe { frame.write_bytes(0, 1) };
            frame
        });
        // SAFETY: the caller's promise is the same.
        let registers = unsafe { Registers::at(address) };
        let display = Self { registers, frames, back: 1 };
        registers.write(Offset::Control, 0);
        registers.write(Offset::InterruptMask, 0);
        registers.write(Offset::Timing0, TIMING_0);
        registers.write(Offset::Timing1, TIMING_1);
        registers.write(Offset::Timing2, TIMING_2);
        display.set_base(0);
        registers.write(Offset::Control, CONTROL);
        display
    }

    fn set_base(&self, frame: usize) {
        self.registers.write(Offset::UpperBase, self.frames[frame].addr().get() as u32);
    }
}

impl Display for Pl111 {
    const STRIDE: usize = DISPLAY_WIDTH;

    fn back(&mut self) -> &mut [u32] {
        // SAFETY: `new`'s caller gave the frame to this display alone, it is all pixels, and the
        // borrow of `self` keeps a second reference away.
        unsafe { self.frames[self.back].as_mut() }
    }

    /// Shows the back frame from the next vertical blank on.
    fn present(&mut self) {
        // The pixels are Normal memory, the register is Device memory: order the two.
        core::sync::atomic::fence(core::sync::atomic::Ordering::SeqCst);
        self.set_base(self.back);
        self.back = 1 - self.back;
    }
}
