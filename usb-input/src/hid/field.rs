//! Numbers in a report.

/// A number in a report.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Field {
    /// Where its lowest bit is, in bits from the report's first, its id not counted.
    pub(super) bit: u32,
    /// How many bits it has, 1…32.
    pub(super) size: u32,
    /// What its least value is.
    pub(super) minimum: i32,
    /// What its greatest value is.
    pub(super) maximum: i32,
}

impl Field {
    /// Reads it from a report without its id; `None` where the report ends before.
    pub(super) fn read(&self, report: &[u8]) -> Option<i32> {
        let bits = bits(report, self.bit, self.size)?;
        let unused = 32_u32.saturating_sub(self.size);
        Some(if self.minimum < 0 { (bits << unused) as i32 >> unused } else { bits as i32 })
    }

    /// Reads it as 0…255 between its least and its greatest value; 128 where it tells nothing.
    pub(super) fn read_byte(&self, report: &[u8]) -> u8 {
        const CENTRE: u8 = 0x80;
        let range = i64::from(self.maximum) - i64::from(self.minimum);
        match self.read(report) {
            Some(value) if range > 0 => {
                let above = (i64::from(value) - i64::from(self.minimum)).clamp(0, range);
                ((above * 255 + range / 2) / range) as u8
            }
            _ => CENTRE,
        }
    }
}

/// Reads up to 32 bits that begin at a bit, the lowest first; `None` where the report ends before.
pub(super) fn bits(report: &[u8], bit: u32, size: u32) -> Option<u32> {
    let first = (bit / 8) as usize;
    let last = (bit.checked_add(size)?.div_ceil(8)) as usize;
    let bytes = report.get(first..last).filter(|bytes| bytes.len() <= 5)?;
    let word = bytes.iter().rev().fold(0_u64, |word, &byte| word << 8 | u64::from(byte));
    Some(((word >> (bit % 8)) & ((1 << size) - 1)) as u32)
}

#[cfg(test)]
mod tests {
    use super::{Field, bits};

    #[test]
    fn bits_are_counted_from_the_lowest() {
        let report = [0b1010_0101, 0xC3, 0xFF, 0, 0x80];
        assert_eq!(bits(&report, 0, 1), Some(1));
        assert_eq!(bits(&report, 4, 8), Some(0x3A));
        assert_eq!(bits(&report, 7, 32), Some(0x0001_FF87));
        assert_eq!(bits(&report, 39, 1), Some(1));
        assert_eq!(bits(&report, 40, 1), None);
        assert_eq!(bits(&report, 33, 8), None);
        assert_eq!(bits(&report, u32::MAX, 32), None);
    }

    #[test]
    fn a_sign_is_seen_where_there_can_be_one() {
        let field = |minimum| Field { bit: 0, size: 8, minimum, maximum: 127 };
        assert_eq!(field(-127).read(&[0x81]), Some(-127));
        assert_eq!(field(0).read(&[0x81]), Some(0x81));
        let wide = Field { bit: 0, size: 32, minimum: i32::MIN, maximum: i32::MAX };
        assert_eq!(wide.read(&[0, 0, 0, 0x80]), Some(i32::MIN));
    }

    #[test]
    fn any_range_becomes_a_byte() {
        let byte = |minimum, maximum, report: &[u8]| Field { bit: 0, size: 16, minimum, maximum }.read_byte(report);
        assert_eq!(byte(-32768, 32767, &[0, 0x80]), 0);
        assert_eq!(byte(-32768, 32767, &[0, 0]), 128);
        assert_eq!(byte(-32768, 32767, &[0xFF, 0x7F]), 255);
        assert_eq!(byte(0, 1023, &[0, 2]), 128);
        assert_eq!(byte(0, 255, &[7, 0]), 7);
        assert_eq!(byte(0, 255, &[7, 1]), 255, "beyond its greatest value");
        assert_eq!([byte(0, 0, &[7, 0]), byte(5, -5, &[7, 0]), byte(0, 255, &[])], [128; 3]);
    }
}
