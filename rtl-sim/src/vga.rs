//! A picture taken from the VGA pins.

use crate::rtl::Rtl;

/// The pins in one clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pins(u32);

impl Pins {
    /// Red, green and blue, 0…255 each.
    pub fn rgb(self) -> [u8; 3] {
        [(self.0 >> 16) as u8, (self.0 >> 8) as u8, self.0 as u8]
    }

    /// The horizontal sync pin; a pulse is low.
    pub fn hsync(self) -> bool {
        self.0 >> 24 & 1 != 0
    }

    /// The vertical sync pin; a pulse is low.
    pub fn vsync(self) -> bool {
        self.0 >> 25 & 1 != 0
    }

    /// Whether the pixel is to be seen.
    pub fn visible(self) -> bool {
        self.0 >> 26 & 1 != 0
    }
}

/// Clocks of a line: visible, front porch, sync, back porch.
const LINE: [usize; 4] = [640, 16, 96, 48];
/// Lines of a frame, likewise.
const FRAME: [usize; 4] = [480, 10, 2, 33];
const LINE_CLOCKS: usize = 800;
const FRAME_LINES: usize = 525;

/// One frame, 640×480.
pub struct Frame {
    pixels: Vec<[u8; 3]>,
}

impl Frame {
    /// Pixels of a frame.
    pub const PIXELS: usize = LINE[0] * FRAME[0];

    /// Returns a frame of these pixels, row 0 first.
    pub(crate) fn of(pixels: Vec<[u8; 3]>) -> Self {
        Self { pixels }
    }

    /// Takes the next whole frame from the pins, checking every clock of it against the timing of
    /// 640×480 at 60 Hz.
    ///
    /// `between` runs before each of VGA's clocks: let the bus clock run there, or not.
    ///
    /// # Errors
    /// Says which pin was wrong in which clock of which line.
    pub fn take(rtl: &mut Rtl, mut between: impl FnMut(&mut Rtl)) -> Result<Self, String> {
        // From the end of a vertical sync pulse it is a back porch to the first visible line.
        let mut clock = |rtl: &mut Rtl| {
            between(rtl);
            Pins(rtl.vga_clock())
        };
        let mut waited = 0;
        let mut before = true;
        loop {
            let pins = clock(rtl);
            if pins.vsync() && !before {
                break;
            }
            before = pins.vsync();
            waited += 1;
            if waited > 2 * LINE_CLOCKS * FRAME_LINES {
                return Err("no vertical sync within two frames".into());
            }
        }
        for _ in 1..FRAME[3] * LINE_CLOCKS {
            clock(rtl);
        }
        let mut pixels = Vec::with_capacity(LINE[0] * FRAME[0]);
        for line in 0..FRAME_LINES {
            for column in 0..LINE_CLOCKS {
                let pins = clock(rtl);
                let visible = line < FRAME[0] && column < LINE[0];
                let pulse =
                    |at: usize, spans: [usize; 4]| (spans[0] + spans[1]..spans[0] + spans[1] + spans[2]).contains(&at);
                let expected = (visible, !pulse(column, LINE), !pulse(line, FRAME));
                let found = (pins.visible(), pins.hsync(), pins.vsync());
                if found != expected {
                    return Err(format!(
                        "line {line}, clock {column}: (visible, hsync, vsync) is {found:?}, not {expected:?}"
                    ));
                }
                if visible {
                    pixels.push(pins.rgb());
                } else if pins.rgb() != [0; 3] {
                    return Err(format!("line {line}, clock {column}: a colour in the blank"));
                }
            }
        }
        Ok(Self { pixels })
    }

    /// Returns red, green and blue of every pixel, row 0 first, each row from left to right.
    pub fn pixels(&self) -> &[[u8; 3]] {
        &self.pixels
    }

    /// Returns a pixel's red, green and blue.
    pub fn pixel(&self, x: usize, y: usize) -> [u8; 3] {
        self.pixels[y * LINE[0] + x]
    }
}
