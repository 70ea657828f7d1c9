//! What a DualShock 3 wants to be told.

use crate::descriptor::HidInterface;
use crate::link::{Link, Next};
use crate::setup::{ReportType, Setup};
use crate::{Memory, Step, Text};

/// idVendor and idProduct.
pub(crate) const PRODUCT: (u16, u16) = (0x054C, 0x0268);

/// Length of output report 0x01 without its id (Linux `hid-sony.c`).
pub(crate) const OUTPUT_LENGTH: usize = 35;

/// Tells the pad to send reports, which it does not by itself: what goes out, one after the other.
///
/// Reading feature report 0xF2 does for Linux, writing 0xF4 for many others; both go out, and either may be refused.
/// Pads made by others want 0xF5 read and a byte written to their interrupt endpoint as well, but for
/// ShanWan's, which that makes shake for ever (Linux `hid-sony.c`). How these two end does not matter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wake {
    ReadF2,
    ReadF5,
    Byte(u8),
    WriteF4,
}

impl Wake {
    pub(crate) const FIRST: Self = Self::ReadF2;

    pub(crate) fn next(self, link: &mut Link, memory: &Memory, hid: &HidInterface) -> Next {
        let feature = |id| Setup::get_report(ReportType::Feature, id, hid.number);
        match (self, hid.output) {
            (Self::ReadF2, _) => link.read(memory, Step::Wake, feature(0xF2), 17),
            (Self::Byte(byte), Some(output)) => link.send(memory, Step::Wake, output, &[byte]),
            (Self::ReadF5, _) | (Self::Byte(_), None) => link.read(memory, Step::Wake, feature(0xF5), 8),
            (Self::WriteF4, _) => {
                let setup = Setup::set_report(ReportType::Feature, 0xF4, hid.number);
                link.write(memory, Step::Wake, setup, &[0x42, 0x0C, 0, 0])
            }
        }
    }

    /// Tells whether this may be refused, but not fail.
    pub(crate) const fn has_to_succeed(self) -> bool {
        matches!(self, Self::ReadF2 | Self::WriteF4)
    }

    /// Returns what follows the answer to this, `None` at the end; `names` are the pad's and its maker's.
    pub(crate) fn after(self, answer: &[u8], hid: &HidInterface, names: [&Text; 2]) -> Option<Self> {
        match self {
            Self::ReadF2 => Some(Self::ReadF5),
            Self::ReadF5 => match answer.first() {
                Some(&byte) if hid.output.is_some() && !names.iter().any(|name| is_shanwan(name.as_bytes())) => {
                    Some(Self::Byte(byte))
                }
                _ => Some(Self::WriteF4),
            },
            Self::Byte(_) => Some(Self::WriteF4),
            Self::WriteF4 => None,
        }
    }
}

fn is_shanwan(name: &[u8]) -> bool {
    const MAKER: &[u8] = b"shanwan";
    name.windows(MAKER.len()).any(|part| part.eq_ignore_ascii_case(MAKER))
}

/// Makes output report 0x01, without its id: the small motor on or off, one of four lamps lit.
pub(crate) fn output(player: u8, shake: bool) -> [u8; OUTPUT_LENGTH] {
    const MOTOR_DURATION: usize = 1;
    const MOTOR: usize = 2;
    const LAMPS: usize = 9;
    const PATTERNS: usize = 10;
    /// Total time, duty, enabled, time off, time on: steady light.
    const STEADY: [u8; 5] = [0xFF, 0x27, 0x10, 0x00, 0x32];
    let mut report = [0; OUTPUT_LENGTH];
    if shake {
        // Some units of about 20 ms, should the word to stop be lost.
        report[MOTOR_DURATION] = 0x10;
        report[MOTOR] = 1;
    }
    if let 1..=4 = player {
        report[LAMPS] = 1 << player;
    }
    for pattern in report[PATTERNS..].chunks_exact_mut(STEADY.len()).take(4) {
        pattern.copy_from_slice(&STEADY);
    }
    report
}

#[cfg(test)]
mod tests {
    use super::{is_shanwan, output};

    /// What Linux was seen to send for the first player.
    #[test]
    fn the_lamps_are_as_on_the_wire() {
        let mut wanted = [0; 35];
        wanted[9] = 0x02;
        for pattern in wanted[10..30].chunks_mut(5) {
            pattern.copy_from_slice(&[0xFF, 0x27, 0x10, 0x00, 0x32]);
        }
        assert_eq!(output(1, false), wanted);
        assert_eq!([output(4, false)[9], output(0, false)[9], output(5, false)[9]], [0x10, 0, 0]);
    }

    #[test]
    fn a_pulse_is_the_small_motor() {
        assert_eq!(output(1, true)[1..5], [0x10, 1, 0, 0]);
    }

    #[test]
    fn a_maker_is_known_by_its_name() {
        assert!(is_shanwan(b"SHANWAN PS3 GamePad") && is_shanwan(b"ShanWan"));
        assert!(!is_shanwan(b"Sony") && !is_shanwan(b""));
    }
}
