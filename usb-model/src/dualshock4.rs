//! A DualShock 4.

use crate::leaf::{Descriptors, Function, Leaf};
use crate::wire::Speed;

/// Time from one report to the next.
pub const REPORT_INTERVAL_US: u64 = 4_000;
/// A report's length in bytes.
pub const REPORT_LENGTH: usize = 64;

/// What it tells.
#[derive(Debug)]
pub struct Pad {
    report: [u8; REPORT_LENGTH],
    since: Option<u64>,
    made: u64,
}

/// A DualShock 4.
pub type DualShock4 = Leaf<Pad>;

/// Returns a pad that lies level and is left alone.
pub fn dualshock4() -> DualShock4 {
    let configuration = [
        &[9, 2, 41, 0, 1, 1, 0, 0xC0, 0xFA][..],
        &[9, 4, 0, 0, 2, 3, 0, 0, 0, 9, 0x21, 0x11, 1, 0, 1, 0x22],
        &(report_descriptor().len() as u16).to_le_bytes(),
        &[7, 5, 0x84, 3, 64, 0, 5, 7, 5, 0x03, 3, 64, 0, 5],
    ]
    .concat();
    let descriptors = Descriptors {
        device: vec![18, 1, 0, 2, 0, 0, 0, 64, 0x4C, 0x05, 0xCC, 0x09, 0, 1, 1, 2, 0, 1],
        configuration,
        strings: vec!["Sony Interactive Entertainment".into(), "Wireless Controller".into()],
        reports: vec![report_descriptor()],
    };
    let mut report = [0; REPORT_LENGTH];
    report[..6].copy_from_slice(&[1, 0x80, 0x80, 0x80, 0x80, 8]);
    report[21..23].copy_from_slice(&8192_i16.to_le_bytes());
    report[30] = 0x1B;
    Leaf::new(Speed::Full, descriptors, Pad { report, since: None, made: 0 })
}

/// Input report 1 as that pad has it (four axes, hat, 14 buttons, two triggers, 54 bytes of its own), output report 5, and
/// as many feature reports as make it as long as the pad's: 507 bytes.
fn report_descriptor() -> Vec<u8> {
    let mut bytes = [
        &[0x05, 0x01, 0x09, 0x05, 0xA1, 0x01, 0x85, 0x01][..],
        &[
            0x09, 0x30, 0x09, 0x31, 0x09, 0x32, 0x09, 0x35, 0x15, 0x00, 0x26, 0xFF, 0x00, 0x75, 0x08, 0x95, 0x04, 0x81,
            0x02,
        ],
        &[0x09, 0x39, 0x15, 0x00, 0x25, 0x07, 0x75, 0x04, 0x95, 0x01, 0x81, 0x42],
        &[0x05, 0x09, 0x19, 0x01, 0x29, 0x0E, 0x15, 0x00, 0x25, 0x01, 0x75, 0x01, 0x95, 0x0E, 0x81, 0x02],
        &[0x06, 0x00, 0xFF, 0x09, 0x20, 0x75, 0x06, 0x95, 0x01, 0x15, 0x00, 0x25, 0x7F, 0x81, 0x02],
        &[0x05, 0x01, 0x09, 0x33, 0x09, 0x34, 0x15, 0x00, 0x26, 0xFF, 0x00, 0x75, 0x08, 0x95, 0x02, 0x81, 0x02],
        &[0x06, 0x00, 0xFF, 0x09, 0x21, 0x95, 0x36, 0x81, 0x02],
        &[0x85, 0x05, 0x09, 0x22, 0x95, 0x1F, 0x91, 0x02],
    ]
    .concat();
    let mut id = 0x80;
    while bytes.len() + 8 < 507 {
        bytes.extend([0x85, id, 0x09, 0x20, 0x95, 0x06, 0xB1, 0x02]);
        id += 1;
    }
    bytes.push(0xC0);
    bytes
}

impl Pad {
    /// Changes what it reports from the next report on.
    pub fn set(&mut self, change: impl FnOnce(&mut [u8; REPORT_LENGTH])) {
        change(&mut self.report);
    }
}

impl Function for Pad {
    fn request_in(&mut self, _now: u64, _setup: [u8; 8]) -> Option<Vec<u8>> {
        None
    }

    fn request_out(&mut self, _now: u64, _setup: [u8; 8], _data: &[u8]) -> bool {
        false
    }

    fn input(&mut self, now: u64, _endpoint: u8) -> Option<Vec<u8>> {
        let due = (now - *self.since.get_or_insert(now)) / REPORT_INTERVAL_US;
        if self.made > due {
            return None;
        }
        self.made = due + 1;
        Some(self.report.to_vec())
    }

    fn reset(&mut self) {
        (self.since, self.made) = (None, 0);
    }
}
