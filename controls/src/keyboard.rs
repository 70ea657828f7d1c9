//! The boot keyboard's input report.

use crate::ReportError;

/// Holds which keys a keyboard says are down.
///
/// | byte | meaning |
/// | --- | --- |
/// | 0 | modifiers, from bit 0: left Control, Shift, Alt, GUI, then the right ones |
/// | 1 | reserved |
/// | 2–7 | up to six usages of the keyboard page, 0 for none |
///
/// It is a state, not an event: a key is down while reports name it. Source: USB HID 1.11,
/// appendix B.1; usages from the HID Usage Tables, page 0x07.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct KeyboardReport {
    /// The modifiers that are down, as the bits of byte 0.
    pub modifiers: u8,
    /// The usages of the other keys that are down, 0 for none, in any order.
    pub usages: [u8; 6],
}

impl KeyboardReport {
    /// The report's length in bytes.
    pub const LENGTH: usize = 8;
    const LEFT_CONTROL: u8 = 0xE0;

    /// Reads a report, or `None` if the keyboard cannot tell which keys are down.
    ///
    /// It cannot when too many are (rollover: each usage is 0x01) or when it has a fault (0x02, 0x03).
    /// What was down then counts as down still.
    ///
    /// # Errors
    ///
    /// [`ReportError::KeyboardLength`] unless there are exactly 8 bytes.
    pub fn parse(bytes: &[u8]) -> Result<Option<Self>, ReportError> {
        let &[modifiers, _reserved, ref usages @ ..]: &[u8; Self::LENGTH] =
            bytes.try_into().map_err(|_| ReportError::KeyboardLength { found: bytes.len() })?;
        let unknown = usages.iter().any(|usage| (0x01..=0x03).contains(usage));
        Ok((!unknown).then_some(Self { modifiers, usages: *usages }))
    }

    /// Writes the report that a keyboard in this state sends, for a recording or a fake keyboard.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; Self::LENGTH] {
        let [one, two, three, four, five, six] = self.usages;
        [self.modifiers, 0, one, two, three, four, five, six]
    }

    /// Goes through the usages of all keys that are down, modifiers as 0xE0 to 0xE7.
    pub fn held(&self) -> impl Iterator<Item = u8> {
        let modifiers = self.modifiers;
        let modifier = (0..8).filter(move |bit| modifiers >> bit & 1 == 1);
        let others = self.usages.into_iter().filter(|&usage| usage != 0);
        modifier.map(|bit| Self::LEFT_CONTROL + bit).chain(others)
    }
}

#[cfg(test)]
mod tests {
    use super::KeyboardReport;
    use crate::ReportError;
    use std::vec::Vec;

    #[test]
    fn keys_and_modifiers_are_usages() {
        let report = KeyboardReport::parse(&[0x82, 0xAA, 0x04, 0, 0x2C, 0, 0, 0x52]).unwrap().unwrap();
        assert_eq!(report.held().collect::<Vec<_>>(), [0xE1, 0xE7, 0x04, 0x2C, 0x52]);
    }

    #[test]
    fn a_keyboard_that_cannot_tell_says_nothing() {
        assert_eq!(KeyboardReport::parse(&[0, 0, 1, 1, 1, 1, 1, 1]), Ok(None));
        assert_eq!(KeyboardReport::parse(&[0xFF, 0, 1, 1, 1, 1, 1, 1]), Ok(None));
        assert_eq!(KeyboardReport::parse(&[0, 0, 2, 2, 2, 2, 2, 2]), Ok(None));
    }

    #[test]
    fn a_wrong_length_is_named() {
        for length in (0..64).filter(|&length| length != 8) {
            let found = KeyboardReport::parse(&[0; 64][..length]);
            assert_eq!(found, Err(ReportError::KeyboardLength { found: length }));
        }
    }

    #[test]
    fn what_is_written_is_read_back() {
        let report = KeyboardReport { modifiers: 0x21, usages: [4, 5, 6, 7, 8, 9] };
        assert_eq!(KeyboardReport::parse(&report.to_bytes()), Ok(Some(report)));
    }
}
