//! A flat map of the 4 GiB address space in 1 MiB sections, built at compile time.
//!
//! Every address that a board does not list faults, page zero among them. Bits are those of the
//! short-descriptor format without TEX remap (ARM DDI 0406, §B3.5.1 and §B3.8.2), all in domain 0:
//!
//! | memory | TEX C B | S | APX AP | XN |
//! | --- | --- | --- | --- | --- |
//! | code: write-back, read only, executable | 001 1 1 | 1 | 1 01 | 0 |
//! | constants: the same, read only | 001 1 1 | 1 | 1 01 | 1 |
//! | data: write-back, write-allocate | 001 1 1 | 1 | 0 01 | 1 |
//! | uncached: Normal, non-cacheable | 001 0 0 | 1 | 0 01 | 1 |
//! | device: shareable Device | 000 0 1 | 0 | 0 01 | 1 |

/// Bytes in a section.
pub const SECTION_BYTES: u32 = 1 << 20;
/// Sections in the address space.
const SECTIONS: usize = 4096;

/// What lies in a section, and so how it may be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Memory {
    /// Nothing: any access faults.
    Fault,
    /// Instructions and constants.
    Code,
    /// What somebody else left to be read.
    Constants,
    /// Variables and stacks.
    Data,
    /// RAM that a device reads, too: stores may be merged, but go past the caches.
    Uncached,
    /// Registers.
    Device,
}

/// A run of sections with one kind of memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Region {
    /// First address; a multiple of 1 MiB.
    pub start: u32,
    /// Length, in sections of 1 MiB.
    pub sections: u32,
    /// What lies there.
    pub memory: Memory,
}

/// The first-level translation table, at the alignment that TTBR0 wants.
#[repr(C, align(16384))]
pub struct TranslationTable([u32; SECTIONS]);

impl TranslationTable {
    /// Builds the table. Where regions overlap, the later one counts.
    ///
    /// # Panics
    /// When a region is not aligned to a section or ends beyond 4 GiB: a compile error, where the
    /// table is a constant.
    #[must_use]
    pub const fn new(regions: &[Region]) -> Self {
        let mut table = Self::EMPTY;
        table.map(regions);
        table
    }

    /// A table by which every access faults.
    pub const EMPTY: Self = Self([descriptor(0, Memory::Fault); SECTIONS]);

    /// Adds regions. Where they overlap, with each other or with what is there, the later one counts.
    ///
    /// # Panics
    /// As [`new`](Self::new).
    pub const fn map(&mut self, regions: &[Region]) {
        let mut index = 0;
        while index < regions.len() {
            let Region { start, sections, memory } = regions[index];
            assert!(start.is_multiple_of(SECTION_BYTES), "a region starts on a section");
            let first = start / SECTION_BYTES;
            assert!(first + sections <= SECTIONS as u32, "a region ends within 4 GiB");
            let mut section = first;
            while section < first + sections {
                self.0[section as usize] = descriptor(section * SECTION_BYTES, memory);
                section += 1;
            }
            index += 1;
        }
    }

    /// Returns whether an access to `address` faults for want of a mapping.
    #[must_use]
    pub const fn is_hole(&self, address: u32) -> bool {
        self.0[(address / SECTION_BYTES) as usize] & 0b11 == 0
    }
}

/// Returns the descriptor of the section at `base`.
const fn descriptor(base: u32, memory: Memory) -> u32 {
    const SECTION: u32 = 0b10;
    const BUFFERABLE: u32 = 1 << 2;
    const CACHEABLE: u32 = 1 << 3;
    const EXECUTE_NEVER: u32 = 1 << 4;
    const PRIVILEGED_ACCESS: u32 = 0b01 << 10;
    const NORMAL: u32 = 0b001 << 12;
    const READ_ONLY: u32 = 1 << 15;
    const SHAREABLE: u32 = 1 << 16;

    const WRITE_BACK: u32 = NORMAL | CACHEABLE | BUFFERABLE | SHAREABLE;
    let attributes = match memory {
        Memory::Fault => return 0,
        Memory::Code => WRITE_BACK | READ_ONLY,
        Memory::Constants => WRITE_BACK | READ_ONLY | EXECUTE_NEVER,
        Memory::Data => WRITE_BACK | EXECUTE_NEVER,
        Memory::Uncached => NORMAL | SHAREABLE | EXECUTE_NEVER,
        Memory::Device => BUFFERABLE | EXECUTE_NEVER,
    };
    base | attributes | PRIVILEGED_ACCESS | SECTION
}

#[cfg(test)]
mod tests {
    use super::*;

    const REGIONS: [Region; 3] = [
        Region { start: 0x6000_0000, sections: 16, memory: Memory::Code },
        Region { start: 0x6100_0000, sections: 112, memory: Memory::Data },
        Region { start: 0x6700_0000, sections: 1, memory: Memory::Fault },
    ];
    static TABLE: TranslationTable = TranslationTable::new(&REGIONS);

    /// Spelled out from the manual's tables, not from the constants above.
    #[test]
    fn descriptors_have_the_manuals_bits() {
        assert_eq!(descriptor(0x6000_0000, Memory::Code), 0x6001_940E);
        assert_eq!(descriptor(0x0800_0000, Memory::Constants), 0x0801_941E);
        assert_eq!(descriptor(0x6100_0000, Memory::Data), 0x6101_141E);
        assert_eq!(descriptor(0x6800_0000, Memory::Uncached), 0x6801_1412);
        assert_eq!(descriptor(0xFFF0_0000, Memory::Device), 0xFFF0_0416);
        assert_eq!(descriptor(0x1230_0000, Memory::Fault), 0);
    }

    #[test]
    fn regions_fill_their_sections_and_no_more() {
        assert!(TABLE.is_hole(0), "page zero");
        assert!(TABLE.is_hole(0x5FFF_FFFF));
        assert_eq!(TABLE.0[0x600], descriptor(0x6000_0000, Memory::Code));
        assert_eq!(TABLE.0[0x60F], descriptor(0x60F0_0000, Memory::Code));
        assert_eq!(TABLE.0[0x610], descriptor(0x6100_0000, Memory::Data));
        assert!(!TABLE.is_hole(0x67FF_FFFF));
        assert!(TABLE.is_hole(0x6800_0000));
    }

    #[test]
    fn a_later_region_cuts_a_hole() {
        assert!(TABLE.is_hole(0x6700_0000) && TABLE.is_hole(0x670F_FFFF));
        assert!(!TABLE.is_hole(0x66FF_FFFF) && !TABLE.is_hole(0x6710_0000));
    }

    #[test]
    fn the_last_section_can_be_mapped() {
        let table = TranslationTable::new(&[Region { start: 0xFFF0_0000, sections: 1, memory: Memory::Device }]);
        assert!(!table.is_hole(u32::MAX));
        assert_eq!(size_of::<TranslationTable>(), 16384);
    }

    #[test]
    #[should_panic(expected = "a region starts on a section")]
    fn an_unaligned_region_is_refused() {
        let _ = TranslationTable::new(&[Region { start: 0x1000, sections: 1, memory: Memory::Data }]);
    }
}
