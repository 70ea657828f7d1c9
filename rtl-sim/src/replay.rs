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
/// comes to rest after every swap, before the next frame's words go in.
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

fn draw(rtl: &mut Rtl, words: &[u32]) -> FrameCost {
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
        swapped: last_is_swap(words),
    }
}

/// Cuts a stream behind each swap. A bad packet is as long as its header says, as for the device.
pub fn frames(words: &[u32]) -> impl Iterator<Item = &[u32]> {
    let mut rest = words;
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        let mut end = 0;
        while let Some(header) = rest.get(end).copied().map(Header) {
            end += 1 + usize::from(header.length());
            if header.check() == Ok(Kind::Swap) {
                break;
            }
        }
        let (frame, behind) = rest.split_at(end.min(rest.len()));
        rest = behind;
        Some(frame)
    })
}

/// Says whether one of [`frames`] ends with a swap: only its last packet can be one.
fn last_is_swap(frame: &[u32]) -> bool {
    let mut at = 0;
    let mut last = None;
    while let Some(header) = frame.get(at).copied().map(Header) {
        at += 1 + usize::from(header.length());
        last = Some(header.check());
    }
    last == Some(Ok(Kind::Swap))
}

#[cfg(test)]
mod tests {
    use super::*;
    use fpga_regs::packet::{Clear, Fence, swap};
    use fpga_regs::screen::Rgb332;

    #[test]
    fn frames_end_behind_swaps_and_nowhere_else() {
        let clear = Clear { colour: Rgb332(1), depth: 2 }.encode();
        // A fence's tag, and a bad packet's words, that look like swaps.
        let fence = Fence { tag: swap()[0] }.encode();
        let bad = [0x7f02_0000, swap()[0], swap()[0]];
        let words = [&clear[..], &swap(), &fence, &bad, &swap(), &clear].concat();
        let found: Vec<_> = frames(&words).map(|frame| (frame.len(), last_is_swap(frame))).collect();
        assert_eq!(found, [(3, true), (6, true), (2, false)]);
        assert_eq!(frames(&words).flatten().copied().collect::<Vec<_>>(), words);
        assert_eq!(frames(&[]).count(), 0);
        // Cut inside a packet: all that is there.
        assert_eq!(frames(&words[..1]).collect::<Vec<_>>(), [&words[..1]]);
    }
}
