//! A device's report to what `controls` takes.

use controls::{Battery, DualShock3Report};

use crate::dualshock4;
use crate::hid::{Form, Layout};

/// How a device's reports are read.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Reader {
    BootKeyboard,
    DualShock3,
    DualShock4(Layout),
    Layout(Layout),
}

/// What a report says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Reading {
    Keyboard([u8; 8]),
    Pad([u8; DualShock3Report::LENGTH]),
    /// It is of another kind, or says that it says nothing.
    Nothing,
    /// It is shorter than its kind of report is.
    Short,
}

impl Reader {
    /// Returns how long a report is, in bytes, its id counted.
    pub(crate) fn length(&self) -> usize {
        match self {
            Self::BootKeyboard => controls::KeyboardReport::LENGTH,
            Self::DualShock3 => DualShock3Report::LENGTH,
            Self::DualShock4(layout) | Self::Layout(layout) => layout.length,
        }
    }

    /// Reads a report. What is longer than it should be is cut.
    pub(crate) fn read(&self, bytes: &[u8]) -> Reading {
        if let Self::DualShock4(layout) | Self::Layout(layout) = self
            && layout.id != 0
            && bytes.first().is_some_and(|&id| id != layout.id)
        {
            return Reading::Nothing;
        }
        let Some(bytes) = bytes.get(..self.length()).filter(|bytes| !bytes.is_empty()) else {
            return Reading::Short;
        };
        match self {
            Self::BootKeyboard => bytes.try_into().map_or(Reading::Short, Reading::Keyboard),
            Self::DualShock3 => bytes.try_into().map_or(Reading::Short, dualshock3),
            Self::DualShock4(layout) | Self::Layout(layout) => {
                let body = &bytes[usize::from(layout.id != 0)..];
                match layout.form {
                    Form::Keyboard(keyboard) => Reading::Keyboard(keyboard.boot_report(body)),
                    Form::Pad(pad) => {
                        let mut report = pad.read(body);
                        if let Self::DualShock4(_) = self {
                            dualshock4::complete(&mut report, bytes);
                        }
                        Reading::Pad(report.to_bytes())
                    }
                }
            }
        }
    }
}

/// A report of another id, or marked as empty in its second byte, is none.
fn dualshock3(report: [u8; DualShock3Report::LENGTH]) -> Reading {
    if DualShock3Report::parse(&report).is_ok() { Reading::Pad(report) } else { Reading::Nothing }
}

/// Returns what a pad's report says of its battery, if that is low.
pub(crate) fn low_battery(report: &[u8; DualShock3Report::LENGTH]) -> Option<Battery> {
    let battery = DualShock3Report::parse(report).map_or(Battery::Unknown, |report| report.battery);
    matches!(battery, Battery::Dying | Battery::Empty).then_some(battery)
}

#[cfg(test)]
mod tests {
    use super::{Reader, Reading, low_battery};
    use controls::{Battery, DualShock3Report};

    #[test]
    fn a_boot_keyboard_may_say_more_but_not_less() {
        assert_eq!(
            Reader::BootKeyboard.read(&[1, 2, 3, 4, 5, 6, 7, 8, 9]),
            Reading::Keyboard([1, 2, 3, 4, 5, 6, 7, 8])
        );
        assert_eq!(Reader::BootKeyboard.read(&[0; 7]), Reading::Short);
        assert_eq!(Reader::BootKeyboard.read(&[]), Reading::Short);
    }

    #[test]
    fn a_dualshock3_without_data_says_nothing() {
        let mut report = DualShock3Report::default().to_bytes();
        assert_eq!(Reader::DualShock3.read(&report), Reading::Pad(report));
        assert_eq!(Reader::DualShock3.read(&report[..48]), Reading::Short);
        report[1] = 0xFF;
        assert_eq!(Reader::DualShock3.read(&report), Reading::Nothing);
        report[0] = 2;
        report[1] = 0;
        assert_eq!(Reader::DualShock3.read(&report), Reading::Nothing);
    }

    #[test]
    fn a_battery_is_low_from_dying_on() {
        let low = |battery| low_battery(&DualShock3Report { battery, ..DualShock3Report::default() }.to_bytes());
        assert_eq!(low(Battery::Dying), Some(Battery::Dying));
        assert_eq!(low(Battery::Empty), Some(Battery::Empty));
        for battery in
            [Battery::Low, Battery::High, Battery::Full, Battery::Charging, Battery::Charged, Battery::Unknown]
        {
            assert_eq!(low(battery), None);
        }
    }
}
