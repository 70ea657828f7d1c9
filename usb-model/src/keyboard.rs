//! Keyboards.

use std::collections::{BTreeSet, VecDeque};

use crate::leaf::{Descriptors, Function, Leaf};
use crate::wire::Speed;

/// How a keyboard lays out its reports.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// A boot keyboard: eight bytes in the boot protocol; without it a bit for each key, as [`Bitmap`](Self::Bitmap).
    Boot,
    /// A boot keyboard that refuses SET_PROTOCOL and SET_IDLE, and lists keys in either protocol.
    StubbornBoot,
    /// No boot keyboard: a bit for each key, 17 bytes with the report's id.
    Bitmap,
    /// No boot keyboard: a list of keys, laid out as a boot keyboard's.
    List,
}

/// Report descriptor of HID 1.11 appendix E.6: modifiers, lamps, a list of six keys.
const LIST_REPORT: &[u8] = &[
    0x05, 0x01, 0x09, 0x06, 0xA1, 0x01, 0x05, 0x07, 0x19, 0xE0, 0x29, 0xE7, 0x15, 0x00, 0x25, 0x01, 0x75, 0x01, 0x95,
    0x08, 0x81, 0x02, 0x95, 0x01, 0x75, 0x08, 0x81, 0x01, 0x95, 0x05, 0x75, 0x01, 0x05, 0x08, 0x19, 0x01, 0x29, 0x05,
    0x91, 0x02, 0x95, 0x01, 0x75, 0x03, 0x91, 0x01, 0x95, 0x06, 0x75, 0x08, 0x15, 0x00, 0x25, 0x65, 0x05, 0x07, 0x19,
    0x00, 0x29, 0x65, 0x81, 0x00, 0xC0,
];

/// Media keys as report 2, then modifiers and a bit for each key as report 4.
const BITMAP_REPORT: &[u8] = &[
    0x05, 0x0C, 0x09, 0x01, 0xA1, 0x01, 0x85, 0x02, 0x19, 0x00, 0x2A, 0x3C, 0x02, 0x15, 0x00, 0x26, 0x3C, 0x02, 0x95,
    0x01, 0x75, 0x10, 0x81, 0x00, 0xC0, 0x05, 0x01, 0x09, 0x06, 0xA1, 0x01, 0x85, 0x04, 0x05, 0x07, 0x19, 0xE0, 0x29,
    0xE7, 0x15, 0x00, 0x25, 0x01, 0x75, 0x01, 0x95, 0x08, 0x81, 0x02, 0x19, 0x00, 0x29, 0x77, 0x95, 0x78, 0x81, 0x02,
    0xC0,
];

/// A keyboard's keys.
#[derive(Debug)]
pub struct Keys {
    form: Form,
    boot_protocol: bool,
    /// SET_IDLE(0) came.
    quiet: bool,
    held: BTreeSet<u8>,
    reports: VecDeque<Vec<u8>>,
    sent: u32,
}

/// A keyboard.
pub type Keyboard = Leaf<Keys>;

/// Returns a keyboard that signals at a speed, with packets of eight bytes.
pub fn keyboard(form: Form, speed: Speed) -> Keyboard {
    let boot = matches!(form, Form::Boot | Form::StubbornBoot);
    let report = if matches!(form, Form::List | Form::StubbornBoot) { LIST_REPORT } else { BITMAP_REPORT };
    let control_packet = match speed {
        Speed::Low => 8,
        Speed::Full => 16,
        Speed::High => 64,
    };
    // Ten milliseconds; at high speed 2^(7 − 1) microframes are eight.
    let interval = if speed == Speed::High { 7 } else { 10 };
    let [subclass, protocol] = if boot { [1, 1] } else { [0, 0] };
    let configuration = [
        &[9, 2, 34, 0, 1, 1, 0, 0xA0, 50][..],
        &[9, 4, 0, 0, 1, 3, subclass, protocol, 0],
        &[9, 0x21, 0x10, 1, 0, 1, 0x22, report.len() as u8, 0],
        &[7, 5, 0x81, 3, 8, 0, interval],
    ]
    .concat();
    let descriptors = Descriptors {
        device: vec![18, 1, 0, 2, 0, 0, 0, control_packet, 0xD0, 0x16, 0x01, 0x0F, 0, 1, 1, 2, 0, 1],
        configuration,
        strings: vec!["Halfspace".into(), "Model keyboard".into()],
        reports: vec![report.to_vec()],
    };
    let keys =
        Keys { form, boot_protocol: false, quiet: false, held: BTreeSet::new(), reports: VecDeque::new(), sent: 0 };
    Leaf::new(speed, descriptors, keys)
}

impl Keys {
    /// Presses a key, by its usage; modifiers are 0xE0 to 0xE7.
    pub fn press(&mut self, usage: u8) {
        self.held.insert(usage);
        self.report();
    }

    /// Lets a key go.
    pub fn release(&mut self, usage: u8) {
        self.held.remove(&usage);
        self.report();
    }

    /// Reports that the host has not read yet.
    pub fn unread(&self) -> usize {
        self.reports.len()
    }

    /// Reports that were handed to the wire.
    pub fn sent(&self) -> u32 {
        self.sent
    }

    /// Whether SET_IDLE(0) came.
    pub fn is_quiet(&self) -> bool {
        self.quiet
    }

    /// Puts any bytes among the reports.
    pub fn report_bytes(&mut self, bytes: Vec<u8>) {
        self.reports.push_back(bytes);
    }

    fn report(&mut self) {
        let modifiers = (0..8).filter(|bit| self.held.contains(&(0xE0 + bit))).fold(0, |byte, bit| byte | 1 << bit);
        let keys: Vec<u8> = self.held.iter().copied().filter(|usage| *usage < 0xE0).collect();
        let lists = matches!(self.form, Form::List | Form::StubbornBoot) || self.boot_protocol;
        let mut report = if lists { vec![0; 8] } else { vec![0; 17] };
        if lists {
            report[0] = modifiers;
            // Too many keys are told as such (HID 1.11 appendix C).
            match keys.len() {
                0..=6 => report[2..2 + keys.len()].copy_from_slice(&keys),
                _ => report[2..].fill(1),
            }
        } else {
            report[0] = 4;
            report[1] = modifiers;
            for key in keys {
                report[2 + usize::from(key / 8)] |= 1 << (key % 8);
            }
        }
        self.reports.push_back(report);
    }
}

impl Function for Keys {
    fn request_in(&mut self, _now: u64, setup: [u8; 8]) -> Option<Vec<u8>> {
        // GET_PROTOCOL.
        (setup[..2] == [0xA1, 3]).then(|| vec![u8::from(!self.boot_protocol)])
    }

    fn request_out(&mut self, _now: u64, setup: [u8; 8], _data: &[u8]) -> bool {
        match (self.form, setup[0], setup[1]) {
            (Form::StubbornBoot, ..) => false,
            (Form::Boot, 0x21, 0x0B) => {
                self.boot_protocol = setup[2] == 0;
                true
            }
            (_, 0x21, 0x0A) => {
                self.quiet = setup[3] == 0;
                true
            }
            _ => false,
        }
    }

    fn input(&mut self, _now: u64, _endpoint: u8) -> Option<Vec<u8>> {
        let report = self.reports.pop_front()?;
        self.sent += 1;
        Some(report)
    }

    fn reset(&mut self) {
        self.boot_protocol = false;
        self.quiet = false;
        self.reports.clear();
    }
}
