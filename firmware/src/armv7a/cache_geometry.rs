//! How large an L1 cache is, and the operand of its set/way operations.

/// Bytes in a line of the Cortex-A9's L1 caches and of the PL310.
pub const LINE_BYTES: u32 = 32;

/// An L1 cache's shape, from CCSIDR (ARM DDI 0406, §B4.1.19).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Geometry {
    /// Number of sets.
    pub sets: u32,
    /// Number of ways.
    pub ways: u32,
    /// log2 of the bytes in a line.
    pub line_shift: u32,
}

impl Geometry {
    /// Decodes CCSIDR.
    #[must_use]
    pub const fn from_ccsidr(ccsidr: u32) -> Self {
        Self { sets: (ccsidr >> 13 & 0x7FFF) + 1, ways: (ccsidr >> 3 & 0x3FF) + 1, line_shift: (ccsidr & 0b111) + 4 }
    }

    /// Returns the cache's size in bytes.
    #[must_use]
    pub const fn bytes(self) -> u32 {
        (self.sets * self.ways) << self.line_shift
    }

    /// Returns the operand of a set/way operation on the first-level cache: the way in the
    /// topmost bits, the set above the line's offset (ARM DDI 0406, §B4.2.1).
    #[must_use]
    pub const fn set_way(self, set: u32, way: u32) -> u32 {
        let way_bits = self.ways.next_power_of_two().trailing_zeros();
        let way = if way_bits == 0 { 0 } else { way << (32 - way_bits) };
        way | set << self.line_shift
    }
}

/// Returns the addresses of the lines that hold `bytes` bytes from `address` on.
pub fn lines(address: u32, bytes: u32) -> impl Iterator<Item = u32> {
    let first = address & !(LINE_BYTES - 1);
    let end = u64::from(address) + u64::from(bytes);
    let count = if bytes == 0 { 0 } else { (end - u64::from(first)).div_ceil(u64::from(LINE_BYTES)) };
    (0..count as u32).map(move |line| first + line * LINE_BYTES)
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::vec::Vec;

    #[test]
    fn a_32_kib_cache_has_256_sets_of_4_ways() {
        // sets - 1 = 255 at bit 13, ways - 1 = 3 at bit 3, 32-byte lines = 1.
        let geometry = Geometry::from_ccsidr(255 << 13 | 3 << 3 | 1);
        assert_eq!(geometry, Geometry { sets: 256, ways: 4, line_shift: 5 });
        assert_eq!(geometry.bytes(), 32 * 1024);
        assert_eq!(geometry.set_way(0, 0), 0);
        assert_eq!(geometry.set_way(255, 3), 0xC000_1FE0);
    }

    #[test]
    fn a_direct_mapped_cache_has_no_way_bits() {
        assert_eq!(Geometry { sets: 4, ways: 1, line_shift: 5 }.set_way(3, 0), 0x60);
    }

    #[test]
    fn lines_cover_a_range_that_starts_and_ends_inside_them() {
        assert_eq!(lines(0x1010, 0x20).collect::<Vec<_>>(), [0x1000, 0x1020]);
        assert_eq!(lines(0x1000, 0x20).collect::<Vec<_>>(), [0x1000]);
        assert_eq!(lines(0x101F, 1).collect::<Vec<_>>(), [0x1000]);
        assert_eq!(lines(0x1000, 0).count(), 0);
        assert_eq!(lines(0xFFFF_FFE0, 0x20).collect::<Vec<_>>(), [0xFFFF_FFE0]);
    }
}
