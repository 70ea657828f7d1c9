//! What the FPGA's LEDs and hex displays show: the frame rate, and whether something went wrong.
//!
//! | where | what |
//! | --- | --- |
//! | HEX1, HEX0 | frames in the last second, decimal; 99 for more |
//! | HEX5, HEX4 | faults since the start, decimal; 99 for more |
//! | LEDR0 to LEDR5 | a bar: one for each ten frames a second |
//! | LEDR8 | lit for a second after a fault |
//! | LEDR9 | lit since the first fault |
//!
//! While the game is played the displays show its score instead.

/// Frames and faults, counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Readout {
    /// When the second that is counted began, in microseconds.
    second_began: u64,
    frames: u32,
    frames_last_second: u32,
    faults: u32,
    last_fault: Option<u64>,
}

const SECOND: u64 = 1_000_000;
/// LEDs of the bar.
const BAR: u32 = 6;

impl Readout {
    /// Counts from a time on, in microseconds.
    #[must_use]
    pub fn new(now: u64) -> Self {
        Self { second_began: now, ..Self::default() }
    }

    /// Counts a frame, and returns whether a second has ended with it.
    pub fn frame(&mut self, now: u64) -> bool {
        self.frames += 1;
        let ended = now.wrapping_sub(self.second_began) >= SECOND;
        if ended {
            (self.frames_last_second, self.frames, self.second_began) = (self.frames, 0, now);
        }
        ended
    }

    /// Counts a fault.
    pub fn fault(&mut self, now: u64) {
        self.faults = self.faults.saturating_add(1);
        self.last_fault = Some(now);
    }

    /// Returns the displays' digits, HEX0 first.
    #[must_use]
    pub fn digits(&self) -> [Option<u8>; 6] {
        let [rate, faults] = [self.frames_last_second, self.faults].map(|number| number.min(99) as u8);
        [Some(rate % 10), Some(rate / 10), None, None, Some(faults % 10), Some(faults / 10)]
    }

    /// Returns the LEDs, LEDR0 in bit 0.
    #[must_use]
    pub fn leds(&self, now: u64) -> u16 {
        let bar = (1 << (self.frames_last_second / 10).min(BAR)) - 1;
        let recent = self.last_fault.is_some_and(|fault| now.wrapping_sub(fault) < SECOND);
        bar | u16::from(recent) << 8 | u16::from(self.faults > 0) << 9
    }
}

/// Returns a number's digits for the displays, HEX0 first, without leading zeros; 999,999 for more.
#[must_use]
pub fn decimal(number: u32) -> [Option<u8>; 6] {
    let mut rest = number.min(999_999);
    let mut digits = [None; 6];
    for digit in &mut digits {
        *digit = Some((rest % 10) as u8);
        rest /= 10;
        if rest == 0 {
            break;
        }
    }
    digits
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_score_stands_on_the_right_without_leading_zeros() {
        assert_eq!(decimal(0), [Some(0), None, None, None, None, None]);
        assert_eq!(decimal(1_250), [Some(0), Some(5), Some(2), Some(1), None, None]);
        assert_eq!(decimal(u32::MAX), [Some(9); 6]);
    }

    /// Sixty frames in a second.
    fn running() -> Readout {
        let mut readout = Readout::new(5 * SECOND);
        let seconds = (1..=60).filter(|frame| readout.frame(5 * SECOND + frame * SECOND / 60));
        assert_eq!(seconds.count(), 1);
        readout
    }

    #[test]
    fn frames_are_counted_by_the_second() {
        let readout = running();
        assert_eq!(readout.digits(), [Some(0), Some(6), None, None, Some(0), Some(0)]);
        assert_eq!(readout.leds(0), 0b11_1111);
        assert_eq!(Readout::new(0).leds(0), 0);
    }

    #[test]
    fn a_fault_shows_for_a_second_and_is_not_forgotten() {
        let mut readout = running();
        readout.fault(7 * SECOND);
        assert_eq!(readout.leds(7 * SECOND + 999_999) >> 8, 0b11);
        assert_eq!(readout.leds(8 * SECOND) >> 8, 0b10);
        assert_eq!(readout.digits()[4..], [Some(1), Some(0)]);
        (0..1_000).for_each(|_| readout.fault(0));
        assert_eq!(readout.digits()[4..], [Some(9), Some(9)]);
    }
}
