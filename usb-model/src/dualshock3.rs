//! A DualShock 3.

use crate::leaf::{Descriptors, Function, Leaf};
use crate::wire::Speed;

/// Time from one report to the next.
pub const REPORT_INTERVAL_US: u64 = 10_000;
/// A report's length in bytes.
pub const REPORT_LENGTH: usize = 49;
/// Where a report carries its number, 16 bits, big endian: the yaw gyroscope's place, which nothing reads.
pub const NUMBER_AT: usize = 47;

/// Which requests it takes for the wake-up, and which it refuses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Temper {
    /// Sony's own: reading feature report 0xF2 or writing 0xF4 wakes it.
    Sony,
    /// Woken by 0xF4 alone; refuses 0xF2 and 0xF5.
    RefusesReading,
    /// Woken by 0xF2 alone; refuses 0xF4.
    RefusesWriting,
    /// Awake by itself; refuses 0xF2, 0xF4 and 0xF5.
    RefusesBoth,
    /// Woken by a byte to its interrupt endpoint, after 0xF2 and 0xF5 were read.
    WantsByte,
    /// Shakes for ever if such a byte comes; its name tells.
    Shanwan,
}

/// What it is told, and what it tells.
#[derive(Debug)]
pub struct Pad {
    temper: Temper,
    asked: [bool; 2],
    awake_since: Option<u64>,
    /// Reports made since it woke; the next one's number.
    made: u64,
    report: [u8; REPORT_LENGTH],
    /// Output reports 0x01, without their id: lamps and motors.
    pub outputs: Vec<Vec<u8>>,
    /// Whether it shakes for ever.
    pub shakes: bool,
}

/// A DualShock 3.
pub type DualShock3 = Leaf<Pad>;

/// The device descriptor, as captured from one.
const DEVICE: [u8; 18] = [0x12, 1, 0, 2, 0, 0, 0, 0x40, 0x4C, 0x05, 0x68, 0x02, 0, 1, 1, 2, 0, 1];
/// The configuration descriptor, likewise.
const CONFIGURATION: [u8; 41] = [
    0x09, 0x02, 0x29, 0x00, 0x01, 0x01, 0x00, 0x80, 0xFA, 0x09, 0x04, 0x00, 0x00, 0x02, 0x03, 0x00, 0x00, 0x00, 0x09,
    0x21, 0x11, 0x01, 0x00, 0x01, 0x22, 0x94, 0x00, 0x07, 0x05, 0x02, 0x03, 0x40, 0x00, 0x01, 0x07, 0x05, 0x81, 0x03,
    0x40, 0x00, 0x01,
];
/// The input report as descriptors of this pad have it: 19 buttons, 13 bits of nothing, four axes, 39 bytes of its own.
const REPORT: &[u8] = &[
    0x05, 0x01, 0x09, 0x04, 0xA1, 0x01, 0x85, 0x01, 0x75, 0x08, 0x95, 0x01, 0x81, 0x03, 0x75, 0x01, 0x95, 0x13, 0x15,
    0x00, 0x25, 0x01, 0x05, 0x09, 0x19, 0x01, 0x29, 0x13, 0x81, 0x02, 0x75, 0x01, 0x95, 0x0D, 0x81, 0x03, 0x26, 0xFF,
    0x00, 0x75, 0x08, 0x95, 0x04, 0x05, 0x01, 0x09, 0x30, 0x09, 0x31, 0x09, 0x32, 0x09, 0x35, 0x81, 0x02, 0x06, 0x00,
    0xFF, 0x09, 0x01, 0x95, 0x27, 0x81, 0x02, 0xC0,
];

/// Returns a pad that lies level and is left alone.
pub fn dualshock3(temper: Temper) -> DualShock3 {
    let name = if temper == Temper::Shanwan { "SHANWAN PS3 GamePad" } else { "PLAYSTATION(R)3 Controller" };
    let descriptors = Descriptors {
        device: DEVICE.to_vec(),
        configuration: CONFIGURATION.to_vec(),
        strings: vec!["Sony".into(), name.into()],
        reports: vec![REPORT.to_vec()],
    };
    let mut report = [0; REPORT_LENGTH];
    report[0] = 1;
    report[6..10].fill(0x80);
    report[29..32].copy_from_slice(&[0x02, 0xEE, 0x12]);
    for (at, word) in [(41, 511_u16), (43, 511), (45, 398)] {
        report[at..at + 2].copy_from_slice(&word.to_be_bytes());
    }
    let pad = Pad { temper, asked: [false; 2], awake_since: None, made: 0, report, outputs: Vec::new(), shakes: false };
    Leaf::new(Speed::Full, descriptors, pad)
}

impl Pad {
    /// Changes what it reports from the next report on.
    pub fn set(&mut self, change: impl FnOnce(&mut [u8; REPORT_LENGTH])) {
        change(&mut self.report);
    }

    /// Whether it sends reports.
    pub fn is_awake(&self) -> bool {
        self.awake_since.is_some()
    }

    fn wake(&mut self, now: u64) {
        self.awake_since.get_or_insert(now);
    }
}

impl Function for Pad {
    fn request_in(&mut self, now: u64, setup: [u8; 8]) -> Option<Vec<u8>> {
        let length = usize::from(u16::from_le_bytes([setup[6], setup[7]]));
        match (setup[0], setup[1], setup[3], setup[2]) {
            (0xA1, 1, 3, 0xF2 | 0xF5) if matches!(self.temper, Temper::RefusesReading | Temper::RefusesBoth) => None,
            (0xA1, 1, 3, 0xF2) => {
                self.asked[0] = true;
                if self.temper != Temper::WantsByte {
                    self.wake(now);
                }
                let mut answer = vec![0; 17];
                answer[..3].copy_from_slice(&[0xF2, 0xFF, 0xFF]);
                Some(answer)
            }
            (0xA1, 1, 3, 0xF5) => {
                self.asked[1] = true;
                Some(vec![1, 0, 0, 0, 0, 0, 0, 0])
            }
            (0xA1, 1, 1, 1) if length >= REPORT_LENGTH => Some(self.report.to_vec()),
            _ => None,
        }
    }

    fn request_out(&mut self, now: u64, setup: [u8; 8], data: &[u8]) -> bool {
        match (setup[0], setup[1], setup[3], setup[2]) {
            (0x21, 9, 3, 0xF4)
                if !matches!(self.temper, Temper::RefusesWriting | Temper::RefusesBoth | Temper::WantsByte) =>
            {
                if data == [0x42, 0x0C, 0, 0] {
                    self.wake(now);
                }
                true
            }
            (0x21, 9, 2, 0x01) => {
                self.outputs.push(data.to_vec());
                true
            }
            _ => false,
        }
    }

    fn input(&mut self, now: u64, _endpoint: u8) -> Option<Vec<u8>> {
        if self.temper == Temper::RefusesBoth {
            self.wake(now);
        }
        // One report an interval; one that nobody fetched in time is lost.
        let due = (now - self.awake_since?) / REPORT_INTERVAL_US;
        if self.made > due {
            return None;
        }
        self.made = due + 1;
        let mut report = self.report;
        report[NUMBER_AT..].copy_from_slice(&(due as u16).to_be_bytes());
        Some(report.to_vec())
    }

    fn output(&mut self, now: u64, _endpoint: u8, packet: &[u8]) {
        if packet.len() == 1 {
            self.shakes |= self.temper == Temper::Shanwan;
            if self.asked == [true; 2] {
                self.wake(now);
            }
        }
    }

    fn reset(&mut self) {
        (self.asked, self.awake_since, self.made, self.shakes) = ([false; 2], None, 0, false);
    }
}
