//! Memory between a processor with caches and a core with DMA.

use crate::violation::{Log, Rule};

/// What the core's DMA reaches. Addresses are bus addresses.
pub trait DmaBus {
    /// Reads into `bytes`; false where there is no memory.
    fn read(&mut self, address: u32, bytes: &mut [u8]) -> bool;

    /// Writes `bytes`; false where there is no memory.
    fn write(&mut self, address: u32, bytes: &[u8]) -> bool;

    /// From now on the core owns these bytes, for channel `channel`; it `writes` there or only reads.
    fn lend(&mut self, _channel: usize, _address: u32, _length: usize, _writes: bool) {}

    /// Channel `channel` is done with what it was lent.
    fn give_back(&mut self, _channel: usize) {}
}

/// Bytes of a cache line of the Cortex-A9 and its PL310.
const LINE: usize = 32;

/// What the caches hold of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Line {
    /// The same as memory, or nothing.
    Clean,
    /// What the processor wrote, newer than memory.
    Dirty,
    /// What memory held before the core wrote there.
    Stale,
}

/// Memory behind caches that forgive nothing. At power-on all of it is dirty, as after a boot loader that cleared it.
pub struct CachedMemory {
    base: u32,
    log: Log,
    now: u64,
    /// What the core sees.
    memory: Vec<u8>,
    /// What the processor sees, where a line is not clean.
    cache: Vec<u8>,
    lines: Vec<Line>,
    lent: Vec<(usize, usize, usize, bool)>,
}

impl CachedMemory {
    /// `length` bytes at bus address `base`, both multiples of 32.
    pub fn new(base: u32, length: usize, log: Log) -> Self {
        let lines = length / LINE;
        Self {
            base,
            log,
            now: 0,
            memory: vec![0xa5; length],
            cache: vec![0; length],
            lines: vec![Line::Dirty; lines],
            lent: Vec::new(),
        }
    }

    /// Bus address of the first byte.
    pub fn base(&self) -> u32 {
        self.base
    }

    /// Length in bytes.
    pub fn length(&self) -> usize {
        self.memory.len()
    }

    /// Time, for what is written down.
    pub fn set_now(&mut self, now: u64) {
        self.now = now;
    }

    fn blame(&self, rule: Rule, offset: usize, length: usize) {
        self.log.add(self.now, rule, format!("{length} bytes at offset {offset:#x}"));
    }

    fn lines_of(offset: usize, length: usize) -> std::ops::Range<usize> {
        offset / LINE..(offset + length).div_ceil(LINE)
    }

    fn any(&self, offset: usize, length: usize, state: Line) -> bool {
        Self::lines_of(offset, length).any(|line| self.lines[line] == state)
    }

    /// The processor writes.
    pub fn cpu_write(&mut self, offset: usize, bytes: &[u8]) {
        self.check_owner(offset, bytes.len(), true);
        self.fill(offset, bytes.len());
        self.cache[offset..offset + bytes.len()].copy_from_slice(bytes);
        for line in Self::lines_of(offset, bytes.len()) {
            self.lines[line] = Line::Dirty;
        }
    }

    /// The processor reads.
    pub fn cpu_read(&mut self, offset: usize, bytes: &mut [u8]) {
        self.check_owner(offset, bytes.len(), false);
        if self.any(offset, bytes.len(), Line::Stale) {
            self.blame(Rule::NotInvalidated, offset, bytes.len());
        }
        self.fill(offset, bytes.len());
        bytes.copy_from_slice(&self.cache[offset..offset + bytes.len()]);
    }

    /// Writes dirty lines back.
    pub fn clean(&mut self, offset: usize, length: usize) {
        for line in Self::lines_of(offset, length) {
            if self.lines[line] == Line::Dirty {
                let bytes = line * LINE..(line + 1) * LINE;
                self.memory[bytes.clone()].copy_from_slice(&self.cache[bytes]);
                self.lines[line] = Line::Clean;
            }
        }
    }

    /// Forgets what the caches hold.
    pub fn invalidate(&mut self, offset: usize, length: usize) {
        for line in Self::lines_of(offset, length) {
            self.lines[line] = Line::Clean;
        }
    }

    /// Some of these bytes are in the caches as they were before the core wrote them.
    pub fn is_stale(&self, offset: usize, length: usize) -> bool {
        self.any(offset, length, Line::Stale)
    }

    /// Loads clean lines.
    fn fill(&mut self, offset: usize, length: usize) {
        for line in Self::lines_of(offset, length).filter(|line| self.lines[*line] == Line::Clean) {
            let bytes = line * LINE..(line + 1) * LINE;
            self.cache[bytes.clone()].copy_from_slice(&self.memory[bytes]);
        }
    }

    fn check_owner(&self, offset: usize, length: usize, writes: bool) {
        let touches = |(_, start, lent, core_writes): &(usize, usize, usize, bool)| {
            offset < start + lent && *start < offset + length && (writes || *core_writes)
        };
        if self.lent.iter().any(touches) {
            self.blame(Rule::BufferTouched, offset, length);
        }
    }

    fn offset(&self, address: u32, length: usize) -> Option<usize> {
        let offset = address.checked_sub(self.base)? as usize;
        (offset + length <= self.memory.len()).then_some(offset)
    }
}

impl DmaBus for CachedMemory {
    fn read(&mut self, address: u32, bytes: &mut [u8]) -> bool {
        let Some(offset) = self.offset(address, bytes.len()) else { return false };
        if self.any(offset, bytes.len(), Line::Dirty) {
            self.blame(Rule::NotCleaned, offset, bytes.len());
        }
        bytes.copy_from_slice(&self.memory[offset..offset + bytes.len()]);
        true
    }

    fn write(&mut self, address: u32, bytes: &[u8]) -> bool {
        let Some(offset) = self.offset(address, bytes.len()) else { return false };
        if self.any(offset, bytes.len(), Line::Dirty) {
            self.blame(Rule::DirtyUnderWrite, offset, bytes.len());
        }
        // A processor may have loaded any line on speculation, at any moment before this.
        for line in Self::lines_of(offset, bytes.len()) {
            if self.lines[line] == Line::Clean {
                self.fill(line * LINE, LINE);
                self.lines[line] = Line::Stale;
            }
        }
        self.memory[offset..offset + bytes.len()].copy_from_slice(bytes);
        true
    }

    fn lend(&mut self, channel: usize, address: u32, length: usize, writes: bool) {
        if let Some(offset) = self.offset(address, length) {
            self.lent.push((channel, offset, length, writes));
        }
    }

    fn give_back(&mut self, channel: usize) {
        self.lent.retain(|lent| lent.0 != channel);
    }
}
