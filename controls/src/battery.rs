//! The pad's battery, byte 30 of its report.

/// Tells how full the pad's battery is.
///
/// Source: Linux `hid-sony.c` (0 to 5; from 0xEE on the cable is in, and bit 0 clear means it
/// charges) and USB Host Shield's `PS3Enums.h` (the names).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Battery {
    /// No pad, or a value with no known meaning.
    #[default]
    Unknown,
    /// The pad is about to turn itself off (0x00, 0x01).
    Empty,
    /// About 25 % (0x02).
    Dying,
    /// About 50 % (0x03).
    Low,
    /// About 75 % (0x04).
    High,
    /// Full, running from the battery (0x05).
    Full,
    /// On the cable, not yet full (0xEE).
    Charging,
    /// On the cable and full (0xEF).
    Charged,
}

impl Battery {
    /// Returns what byte 30 of a report says.
    #[must_use]
    pub const fn from_byte(byte: u8) -> Self {
        match byte {
            0x00 | 0x01 => Self::Empty,
            0x02 => Self::Dying,
            0x03 => Self::Low,
            0x04 => Self::High,
            0x05 => Self::Full,
            0xEE.. if byte & 1 == 0 => Self::Charging,
            0xEE.. => Self::Charged,
            _ => Self::Unknown,
        }
    }

    /// Returns a byte that [`Battery::from_byte`] reads as this.
    #[must_use]
    pub const fn to_byte(self) -> u8 {
        match self {
            Self::Unknown => 0x80,
            Self::Empty => 0x00,
            Self::Dying => 0x02,
            Self::Low => 0x03,
            Self::High => 0x04,
            Self::Full => 0x05,
            Self::Charging => 0xEE,
            Self::Charged => 0xEF,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Battery;

    #[test]
    fn bytes_have_the_meaning_that_hid_sony_gives_them() {
        let known = [
            (0, Battery::Empty),
            (1, Battery::Empty),
            (2, Battery::Dying),
            (3, Battery::Low),
            (4, Battery::High),
            (5, Battery::Full),
            (6, Battery::Unknown),
            (0xED, Battery::Unknown),
            (0xEE, Battery::Charging),
            (0xEF, Battery::Charged),
        ];
        for (byte, battery) in known {
            assert_eq!(Battery::from_byte(byte), battery, "byte {byte:#04x}");
        }
    }

    #[test]
    fn a_byte_read_back_means_the_same() {
        for byte in 0..=255 {
            let battery = Battery::from_byte(byte);
            assert_eq!(Battery::from_byte(battery.to_byte()), battery);
        }
    }
}
