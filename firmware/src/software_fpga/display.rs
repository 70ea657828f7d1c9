//! What the software model asks of a display.

use fpga_regs::screen::{HEIGHT, WIDTH};

/// Pixels in a row: the FPGA's VGA output doubles, and so does the model.
pub const DISPLAY_WIDTH: usize = 2 * WIDTH as usize;
/// Rows on the screen.
pub const DISPLAY_HEIGHT: usize = 2 * HEIGHT as usize;

/// A display of 640 × 480 pixels, each 0x00RRGGBB. One frame shows while the other is drawn.
pub trait Display {
    /// Words from a pixel to the one below it, at least [`DISPLAY_WIDTH`].
    const STRIDE: usize;

    /// Returns the frame that does not show, row by row from the top: pixel (x, y) is at
    /// `y * STRIDE + x`. It holds what was drawn two frames ago.
    fn back(&mut self) -> &mut [u32];

    /// Shows the back frame at once, or from the next vertical blank on without waiting for it:
    /// what is drawn until then may show.
    fn present(&mut self);
}
