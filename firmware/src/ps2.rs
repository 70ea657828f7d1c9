//! PS/2 keyboard bytes (scan code set 2) to USB boot keyboard reports.
//!
//! So that the application sees one kind of keyboard. The decoder keeps the set of held keys, by
//! USB usage (HID Usage Tables, page 0x07), and gives an 8-byte report (HID 1.11, appendix B.1):
//!
//! | byte | meaning |
//! | --- | --- |
//! | 0 | modifiers: usages 0xE0 to 0xE7, bit 0 = left control … bit 7 = right GUI |
//! | 1 | 0 |
//! | 2–7 | up to six held usages, rising, 0 where there are fewer; all 0x01 when there are more |
//!
//! What a keyboard may send besides keys: a typematic repeat changes nothing; 0x00 and 0xFF (its
//! buffer overran, so releases may be lost) and 0xAA (it was plugged in) release every key; other
//! answers (0xEE, 0xFA, 0xFC, 0xFE) and codes that name no key are dropped. Pause sends no
//! release, so it is taken in and held by nobody.

mod scan_codes;

use scan_codes::{extended_usage, plain_usage};

/// A USB boot keyboard report: modifiers, 0, six usages.
pub type KeyboardReport = [u8; 8];

/// The usage that fills a report of more than six keys (`ErrorRollOver`).
const ROLLOVER: u8 = 0x01;
/// The usages that byte 0 of a report holds, left control to right GUI.
const FIRST_MODIFIER: u8 = 0xE0;
/// What follows 0xE1 in Pause's sequence: 14 77 E1 F0 14 F0 77.
const PAUSE_BYTES: u8 = 7;

/// What the bytes so far say about the next one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Expect {
    /// A code, or the first byte of a sequence.
    Code { extended: bool, released: bool },
    /// So many bytes more of Pause.
    Pause(u8),
}

impl Expect {
    const START: Self = Self::Code { extended: false, released: false };
}

/// Turns scan codes into reports.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Decoder {
    expect: Expect,
    held: HeldKeys,
}

impl Decoder {
    /// Returns a decoder that holds no key.
    #[must_use]
    pub const fn new() -> Self {
        Self { expect: Expect::START, held: HeldKeys([0; 8]) }
    }

    /// Takes the keyboard's next byte. Returns the new report when the byte changed it.
    pub fn push(&mut self, byte: u8) -> Option<KeyboardReport> {
        let before = self.report();
        self.take(byte);
        let after = self.report();
        (after != before).then_some(after)
    }

    /// Returns the report of the keys held now.
    #[must_use]
    pub fn report(&self) -> KeyboardReport {
        let mut report = [0; 8];
        report[0] = self.held.modifiers();
        let keys = &mut report[2..];
        for (count, usage) in self.held.keys().enumerate() {
            match keys.get_mut(count) {
                Some(slot) => *slot = usage,
                None => {
                    keys.fill(ROLLOVER);
                    break;
                }
            }
        }
        report
    }

    fn take(&mut self, byte: u8) {
        let Expect::Code { extended, released } = self.expect else {
            return self.take_pause(byte);
        };
        self.expect = match byte {
            0x00 | 0xFF | 0xAA => {
                self.held = HeldKeys([0; 8]);
                Expect::START
            }
            0xE0 => Expect::Code { extended: true, released: false },
            0xE1 => Expect::Pause(PAUSE_BYTES),
            0xF0 => Expect::Code { extended, released: true },
            code => {
                let usage = if extended { extended_usage(code) } else { plain_usage(code) };
                if let Some(usage) = usage {
                    self.held.set(usage, !released);
                }
                Expect::START
            }
        };
    }

    /// Takes in Pause. A byte that cannot stand there ends it, so that a lost byte swallows no key.
    fn take_pause(&mut self, byte: u8) {
        let Expect::Pause(left) = self.expect else { return };
        if matches!(byte, 0x14 | 0x77 | 0xE1 | 0xF0) {
            self.expect = if left > 1 { Expect::Pause(left - 1) } else { Expect::START };
        } else {
            self.expect = Expect::START;
            self.take(byte);
        }
    }
}

impl Default for Decoder {
    fn default() -> Self {
        Self::new()
    }
}

/// A set of usages, one bit each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct HeldKeys([u32; 8]);

impl HeldKeys {
    fn set(&mut self, usage: u8, held: bool) {
        let bit = 1 << (usage % 32);
        let word = &mut self.0[usize::from(usage / 32)];
        *word = if held { *word | bit } else { *word & !bit };
    }

    fn modifiers(self) -> u8 {
        (self.0[usize::from(FIRST_MODIFIER / 32)] & 0xFF) as u8
    }

    /// The held keys that are no modifiers, rising.
    fn keys(self) -> impl Iterator<Item = u8> {
        (0..FIRST_MODIFIER).filter(move |usage| self.0[usize::from(usage / 32)] >> (usage % 32) & 1 == 1)
    }
}

#[cfg(test)]
mod tests;
