//! A stream of packet words through the device, frame by frame, and what each frame cost.

use fpga_regs::Port;
use fpga_regs::packet::{Header, Kind};
use fpga_regs::registers::{Control, Errors, Register};
use serde::Serialize;

use crate::rtl::Rtl;

/// Longest that a frame's last words may take: a FIFO full of clears with one pixel unit.
const PATIENCE: u64 = 60_000_000;

/// What a frame cost. It begins with its first word, and ends when it could be shown or, without a
/// swap, when the device is at rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct FrameCost {
    /// The bus clock in which it began, counted from the start of the simulation.
    pub first_clock: u64,
    /// Bus clocks, those in which the finished frame waited for the vertical blank left out.
    pub clocks: u64,
    /// Of them, those in which a word had to wait because the FIFO was full.
    pub held: u64,
    /// Words pushed.
    pub words: u64,
    /// Triangles drawn.
    pub triangles: u32,
    /// Pixels inside triangles, each of them tested against the depth buffer.
    pub pixels_tested: u32,
    /// Pixels of them that were nearer, and were written.
    pub pixels_written: u32,
    /// Tiles visited, those of clears among them; one a clock is the most there is.
    pub tiles: u64,
    /// Whether it ended with a swap.
    pub swapped: bool,
}

/// Draws a stream and hands the cost of each frame to `each`, as it comes to rest.
///
/// The device is enabled first. Words go in one a clock, as long as the FIFO takes them. The device
/// comes to rest after every frame, before the next frame's words go in.
///
/// # Panics
/// When the device does not come to rest, or loses a word: mistakes of the design.
pub fn replay(rtl: &mut Rtl, words: &[u32], mut each: impl FnMut(FrameCost)) {
    rtl.write(Register::Control, Control::default().with_enable(true).0);
    for frame in frames(words) {
        each(draw(rtl, frame));
    }
    let lost = Errors(rtl.read(Register::Errors)).fifo_overflow();
    assert!(!lost, "the device lost a word at {} units", rtl.units());
}

fn draw(rtl: &mut Rtl, FrameWords { words, swapped }: FrameWords<'_>) -> FrameCost {
    let counters = |rtl: &mut Rtl| {
        [Register::Triangles, Register::PixelsTested, Register::PixelsWritten, Register::StalledCycles]
            .map(|register| rtl.read(register))
    };
    let before = counters(rtl);
    let (first_clock, tiles) = (rtl.clocks(), rtl.tiles());
    let held = words.iter().map(|word| rtl.push_word(*word)).sum();
    rtl.rest(PATIENCE);
    let clocks = rtl.clocks() - first_clock;
    let tiles = rtl.tiles() - tiles;
    let after = counters(rtl);
    let [triangles, pixels_tested, pixels_written, waited] = [0, 1, 2, 3].map(|at| after[at].wrapping_sub(before[at]));
    FrameCost {
        first_clock,
        clocks: clocks - u64::from(waited),
        held,
        words: words.len() as u64,
        triangles,
        pixels_tested,
        pixels_written,
        tiles,
        swapped,
    }
}

/// A frame's words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FrameWords<'a> {
    /// Whole packets, unless the stream ends inside one.
    pub words: &'a [u32],
    /// Whether there is a swap at its end; without one it is the stream's last.
    pub swapped: bool,
}

/// Cuts a stream behind each swap and the fences that follow it. A bad packet is as long as its
/// header says, as for the device.
pub fn frames(words: &[u32]) -> impl Iterator<Item = FrameWords<'_>> {
    let mut rest = words;
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        let (mut end, mut swapped) = (0, false);
        while let Some(header) = rest.get(end).copied().map(Header) {
            if swapped && header.check() != Ok(Kind::Fence) {
                break;
            }
            swapped |= header.check() == Ok(Kind::Swap);
            end += 1 + usize::from(header.length());
        }
        let (words, behind) = rest.split_at(end.min(rest.len()));
        rest = behind;
        Some(FrameWords { words, swapped })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use fpga_regs::packet::{Clear, Fence, swap};
    use fpga_regs::screen::Rgb332;

    #[test]
    fn frames_end_behind_swaps_and_their_fences_and_nowhere_else() {
        let clear = Clear { colour: Rgb332(1), depth: 2 }.encode();
        // A fence's tag, and a bad packet's words, that look like swaps.
        let fence = Fence { tag: swap()[0] }.encode();
        let bad = [0x7f02_0000, swap()[0], swap()[0]];
        let words = [&fence[..], &clear, &swap(), &fence, &fence, &bad, &swap(), &swap(), &clear].concat();
        let found: Vec<_> = frames(&words).map(|frame| (frame.words.len(), frame.swapped)).collect();
        assert_eq!(found, [(9, true), (4, true), (1, true), (2, false)]);
        assert_eq!(frames(&words).flat_map(|frame| frame.words).copied().collect::<Vec<_>>(), words);
        assert_eq!(frames(&[]).count(), 0);
        // Cut inside a packet: all that is there.
        assert_eq!(frames(&words[..1]).collect::<Vec<_>>(), [FrameWords { words: &words[..1], swapped: false }]);
    }
}
