//! What the MMU said of pages, kept until its tables or registers change.

use rsemu::cpu::arm::aprofile::cp::{AccessKind, Pa, PhysMem, Va};

use super::{Core, Stop};
use crate::bus::Bus;

/// The smallest page that ARMv7 has, and so the largest of which all is alike.
pub(super) const PAGE_BYTES: u32 = 4096;
/// Pages that are kept for each kind of access.
const ENTRIES: usize = 256;

/// A page: its number plus one, and its physical address.
type Entry = (u32, u32);

/// Translations for fetches, reads and writes.
pub(super) struct Translations {
    pages: [[Entry; ENTRIES]; 3],
}

impl Default for Translations {
    fn default() -> Self {
        Self { pages: [[(0, 0); ENTRIES]; 3] }
    }
}

/// The memory that the MMU reads its tables from.
struct Tables<'a>(&'a Bus);

impl PhysMem for Tables<'_> {
    fn read_u32(&self, at: Pa) -> Option<u32> {
        self.0.read(at.0, 4).ok()
    }
}

impl Core<'_> {
    /// Returns a physical address; a translation that fails is the library's.
    #[inline(always)]
    pub(super) fn physical(&mut self, address: u32, kind: AccessKind) -> Result<u32, Stop> {
        let page = address / PAGE_BYTES;
        let kinds = match kind {
            AccessKind::Fetch => 0,
            AccessKind::Read => 1,
            AccessKind::Write => 2,
        };
        let (tag, start) = self.translations.pages[kinds][page as usize % ENTRIES];
        if tag == page + 1 {
            return Ok(start | (address % PAGE_BYTES));
        }
        self.walk(address, kind, kinds)
    }

    #[cold]
    fn walk(&mut self, address: u32, kind: AccessKind, kinds: usize) -> Result<u32, Stop> {
        let found = self.mmu.translate(&Tables(self.bus), Va(address), kind, true);
        let physical = found.map_err(|_| Stop::Library)?.0;
        let page = address / PAGE_BYTES;
        self.translations.pages[kinds][page as usize % ENTRIES] = (page + 1, physical & !(PAGE_BYTES - 1));
        Ok(physical)
    }
}
