//! A pad of the plainest kind: two sticks, a hat, twelve buttons; it reports when something changes.

use crate::leaf::{Descriptors, Function, Leaf};
use crate::wire::Speed;

/// What it tells: X, Y, Z, Rz, then the hat in the low half of a byte and the buttons from its high half on.
#[derive(Debug)]
pub struct Pad {
    report: [u8; 6],
    changed: bool,
}

/// A pad.
pub type Gamepad = Leaf<Pad>;

const REPORT: &[u8] = &[
    0x05, 0x01, 0x09, 0x05, 0xA1, 0x01, 0x15, 0x00, 0x26, 0xFF, 0x00, 0x75, 0x08, 0x95, 0x04, 0x09, 0x30, 0x09, 0x31,
    0x09, 0x32, 0x09, 0x35, 0x81, 0x02, 0x75, 0x04, 0x95, 0x01, 0x25, 0x07, 0x46, 0x3B, 0x01, 0x65, 0x14, 0x09, 0x39,
    0x81, 0x42, 0x65, 0x00, 0x05, 0x09, 0x19, 0x01, 0x29, 0x0C, 0x25, 0x01, 0x75, 0x01, 0x95, 0x0C, 0x81, 0x02, 0xC0,
];

/// Returns a pad that is left alone. It signals at low speed, so that a packet holds all it says.
pub fn gamepad() -> Gamepad {
    let configuration = [
        &[9, 2, 34, 0, 1, 1, 0, 0xA0, 50][..],
        &[9, 4, 0, 0, 1, 3, 0, 0, 0, 9, 0x21, 0x10, 1, 0, 1, 0x22, REPORT.len() as u8, 0, 7, 5, 0x81, 3, 8, 0, 10],
    ]
    .concat();
    let descriptors = Descriptors {
        device: vec![18, 1, 0x10, 1, 0, 0, 0, 8, 0x79, 0x00, 0x11, 0x00, 6, 1, 0, 0, 0, 1],
        configuration,
        strings: Vec::new(),
        reports: vec![REPORT.to_vec()],
    };
    Leaf::new(Speed::Low, descriptors, Pad { report: [0x80, 0x80, 0x80, 0x80, 0x0F, 0], changed: false })
}

impl Pad {
    /// Reports something.
    pub fn set(&mut self, report: [u8; 6]) {
        self.report = report;
        self.changed = true;
    }
}

impl Function for Pad {
    fn request_in(&mut self, _now: u64, _setup: [u8; 8]) -> Option<Vec<u8>> {
        None
    }

    fn request_out(&mut self, _now: u64, _setup: [u8; 8], _data: &[u8]) -> bool {
        false
    }

    fn input(&mut self, _now: u64, _endpoint: u8) -> Option<Vec<u8>> {
        std::mem::take(&mut self.changed).then(|| self.report.to_vec())
    }
}
