//! Where VGA's beam is: 640×480, 800 by 525 pixel clocks at 25.175 MHz.

use crate::time::Clocks;

const LINE: u64 = 800;
const VISIBLE_LINES: u64 = 480;
const LINES: u64 = 525;
const FRAME: u64 = LINE * LINES;
/// In the last lines of the blank no swap takes place: it would not reach the beam in time.
const LAST_SWAP_LINE: u64 = LINES - 2;
/// Processor clocks in a pixel clock: 800 / 25.175 = 32,000 / 1,007.
const RATIO: (u64, u64) = (32_000, 1_007);

/// The beam.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Beam {
    /// Frames since power-on.
    pub frame: u64,
    /// Line of the frame; 480 is the first of the blank.
    pub line: u64,
}

impl Beam {
    /// Returns where it is.
    pub fn at(now: Clocks) -> Self {
        let pixels = (u128::from(now) * u128::from(RATIO.1) / u128::from(RATIO.0)) as u64;
        Self { frame: pixels / FRAME, line: pixels % FRAME / LINE }
    }

    /// Returns whether nothing is shown.
    pub fn in_blank(self) -> bool {
        self.line >= VISIBLE_LINES
    }
}

/// Returns when a frame's blank begins.
fn blank_of(frame: u64) -> Clocks {
    ((frame * FRAME + VISIBLE_LINES * LINE) * RATIO.0).div_ceil(RATIO.1)
}

/// Returns when a swap that is asked for now takes place; `last` is the frame in whose blank the last one did.
pub fn next_blank(now: Clocks, last: Option<u64>) -> Clocks {
    let beam = Beam::at(now);
    let free = last != Some(beam.frame);
    if free && (VISIBLE_LINES..LAST_SWAP_LINE).contains(&beam.line) {
        return now;
    }
    let this = beam.line < VISIBLE_LINES && free;
    blank_of(if this { beam.frame } else { beam.frame + 1 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::CPU_HERTZ;

    #[test]
    fn a_frame_is_a_59_94th_of_a_second() {
        let frames = Beam::at(1_000 * CPU_HERTZ).frame;
        assert_eq!(frames, 59_940);
    }

    #[test]
    fn swaps_take_place_in_the_blank_and_not_at_its_end() {
        let blank = next_blank(0, None);
        assert_eq!((Beam::at(blank - 1).line, Beam::at(blank).line), (479, 480));
        assert_eq!(next_blank(blank, None), blank);
        assert_eq!(next_blank(blank, Some(0)), blank_of(1));
        let line = LINE * RATIO.0 / RATIO.1;
        assert_eq!(next_blank(blank + 42 * line, None), blank + 42 * line);
        assert_eq!(next_blank(blank + 44 * line, None), blank_of(1));
    }
}
