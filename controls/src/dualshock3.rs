//! The DualShock 3's input report.

use crate::{Acceleration, Battery, Buttons, ReportError};

/// Holds what a DualShock 3 says in its input report 0x01.
///
/// | byte | meaning |
/// | --- | --- |
/// | 0 | report id, 0x01 |
/// | 1 | 0; 0xFF in a report without data |
/// | 2–4 | buttons, bit 0 of byte 2 first |
/// | 6–9 | left x, left y, right x, right y |
/// | 30 | battery |
/// | 41–46 | acceleration x, y, z, **big endian**, ten bits |
///
/// Pressures (14–25), the cable (29), the link (31) and the yaw gyroscope (47–48, per-unit scale,
/// unused by Linux too) are left out. Source: Linux `hid-sony.c`, SDL `SDL_hidapi_ps3.c`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct DualShock3Report {
    /// The buttons that are down.
    pub held: Buttons,
    /// Left stick x, y: 0 left or top, 0x80 centre, 0xFF right or bottom.
    pub left_stick: [u8; 2],
    /// Right stick x, y, likewise.
    pub right_stick: [u8; 2],
    /// How full the battery is.
    pub battery: Battery,
    /// What the accelerometer reads.
    pub acceleration: Acceleration,
}

impl DualShock3Report {
    /// The report's length in bytes, its id included.
    pub const LENGTH: usize = 49;
    const ID: u8 = 0x01;
    const NO_DATA: u8 = 0xFF;

    /// Reads a report.
    ///
    /// # Errors
    ///
    /// [`ReportError::DualShock3Length`], [`ReportError::DualShock3Id`] or
    /// [`ReportError::DualShock3NoData`] for one that holds no input.
    pub fn parse(bytes: &[u8]) -> Result<Self, ReportError> {
        let bytes: &[u8; Self::LENGTH] =
            bytes.try_into().map_err(|_| ReportError::DualShock3Length { found: bytes.len() })?;
        if bytes[0] != Self::ID {
            return Err(ReportError::DualShock3Id { found: bytes[0] });
        }
        if bytes[1] == Self::NO_DATA {
            return Err(ReportError::DualShock3NoData);
        }
        let word = |offset: usize| u16::from_be_bytes([bytes[offset], bytes[offset + 1]]);
        Ok(Self {
            held: Buttons::from_bits(u32::from_le_bytes([bytes[2], bytes[3], bytes[4], 0])),
            left_stick: [bytes[6], bytes[7]],
            right_stick: [bytes[8], bytes[9]],
            battery: Battery::from_byte(bytes[30]),
            acceleration: Acceleration::from_raw([word(41), word(43), word(45)]),
        })
    }

    /// Writes the report that a pad in this state sends, for a recording or a fake pad.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; Self::LENGTH] {
        let mut bytes = [0; Self::LENGTH];
        bytes[0] = Self::ID;
        bytes[2..5].copy_from_slice(&self.held.bits().to_le_bytes()[..3]);
        bytes[6..8].copy_from_slice(&self.left_stick);
        bytes[8..10].copy_from_slice(&self.right_stick);
        bytes[29] = 0x02;
        bytes[30] = self.battery.to_byte();
        bytes[31] = 0x12;
        for (word, at) in self.acceleration.to_raw().into_iter().zip([41, 43, 45]) {
            bytes[at..at + 2].copy_from_slice(&word.to_be_bytes());
        }
        bytes[47..49].copy_from_slice(&0x01EC_u16.to_be_bytes());
        bytes
    }
}

impl Default for DualShock3Report {
    /// Returns the report of a pad that is held level and left alone.
    fn default() -> Self {
        Self {
            held: Buttons::NONE,
            left_stick: [0x80; 2],
            right_stick: [0x80; 2],
            battery: Battery::Full,
            acceleration: Acceleration::LEVEL,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::DualShock3Report;
    use crate::{Acceleration, Battery, Button, Buttons, ReportError};

    /// Offsets written out by hand, so that reading and writing cannot agree on a mistake.
    #[test]
    fn each_field_is_where_the_pad_puts_it() {
        let mut bytes = [0_u8; 49];
        bytes[0] = 1;
        bytes[3] = 0x40;
        bytes[4] = 0x01;
        bytes[6..10].copy_from_slice(&[1, 2, 3, 4]);
        bytes[30] = 0xEE;
        bytes[41..47].copy_from_slice(&[0x01, 0xF7, 0x01, 0xEC, 0x01, 0x90]);
        let report = DualShock3Report::parse(&bytes).unwrap();
        assert_eq!(report.held, Buttons::from_iter([Button::Cross, Button::Ps]));
        assert_eq!((report.left_stick, report.right_stick), ([1, 2], [3, 4]));
        assert_eq!(report.battery, Battery::Charging);
        assert_eq!(report.acceleration, Acceleration::from_raw([503, 492, 400]));
    }

    #[test]
    fn every_button_has_its_bit() {
        let bits = [
            (2, 0x01, Button::Select),
            (2, 0x02, Button::L3),
            (2, 0x04, Button::R3),
            (2, 0x08, Button::Start),
            (2, 0x10, Button::Up),
            (2, 0x20, Button::Right),
            (2, 0x40, Button::Down),
            (2, 0x80, Button::Left),
            (3, 0x01, Button::L2),
            (3, 0x02, Button::R2),
            (3, 0x04, Button::L1),
            (3, 0x08, Button::R1),
            (3, 0x10, Button::Triangle),
            (3, 0x20, Button::Circle),
            (3, 0x40, Button::Cross),
            (3, 0x80, Button::Square),
            (4, 0x01, Button::Ps),
        ];
        assert_eq!(bits.len(), Button::ALL.len());
        for (byte, mask, button) in bits {
            let mut bytes = DualShock3Report::default().to_bytes();
            bytes[byte] = mask;
            assert_eq!(DualShock3Report::parse(&bytes).unwrap().held, button.into());
        }
    }

    #[test]
    fn what_holds_no_input_is_named() {
        let good = DualShock3Report::default().to_bytes();
        assert_eq!(DualShock3Report::parse(&good[..48]), Err(ReportError::DualShock3Length { found: 48 }));
        assert_eq!(DualShock3Report::parse(&[]), Err(ReportError::DualShock3Length { found: 0 }));
        assert_eq!(DualShock3Report::parse(&[1; 64]), Err(ReportError::DualShock3Length { found: 64 }));
        let with = |at: usize, value| {
            let mut bytes = good;
            bytes[at] = value;
            DualShock3Report::parse(&bytes)
        };
        assert_eq!(with(0, 0x02), Err(ReportError::DualShock3Id { found: 2 }));
        assert_eq!(with(1, 0xFF), Err(ReportError::DualShock3NoData));
        assert!(with(1, 0xFE).is_ok());
    }

    #[test]
    fn what_is_written_is_read_back() {
        for bits in [0, 1, 0x5555, 0x1_FFFF] {
            let report = DualShock3Report {
                held: Buttons::from_bits(bits),
                left_stick: [0, 255],
                right_stick: [17, 99],
                battery: Battery::Dying,
                acceleration: Acceleration::from_raw([622, 398, 1]),
            };
            assert_eq!(DualShock3Report::parse(&report.to_bytes()), Ok(report));
        }
    }
}
