//! RAM: words, and beside them what the caches may hold of each line.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicU8, AtomicU32, Ordering::Relaxed};

use crate::cache;

/// Bytes of a chunk, the unit in which memory is taken from the host when it is first touched.
const CHUNK_BYTES: u32 = 1 << 20;
/// Bytes of a cache line, in both levels.
pub const LINE_BYTES: u32 = 32;
/// What memory holds before anyone has written it: SDRAM is not zero after power-on.
const GARBAGE: u32 = 0xD1EB_A5E5;

struct Chunk {
    words: Box<[AtomicU32]>,
    lines: Box<[AtomicU8]>,
}

/// A page of memory, as instructions are fetched from it.
pub struct Page<'a> {
    words: &'a [AtomicU32],
    lines: &'a [AtomicU8],
}

impl Page<'_> {
    /// Returns the word at an offset in the page, unless that is misaligned, or the line that holds it may not have
    /// left the data cache.
    #[inline(always)]
    pub fn fetch(&self, offset: u32) -> Option<u32> {
        let fetched = cache::is_fetched(self.lines[(offset / LINE_BYTES) as usize].load(Relaxed));
        (fetched && offset & 3 == 0).then(|| self.words[(offset / 4) as usize].load(Relaxed))
    }

    /// Returns an instruction of Thumb code likewise: a half word, or two with the first on top. One that ends on
    /// another page is none.
    #[inline(always)]
    pub fn fetch_thumb(&self, offset: u32) -> Option<u32> {
        let half = |offset: u32| Some(self.fetch(offset & !3)? >> (8 * (offset & 2)) & 0xFFFF);
        let first = half(offset & !1)?;
        if first < 0xE800 {
            return Some(first);
        }
        let second = offset + 2;
        if second as usize >= 4 * self.words.len() { None } else { Some(first << 16 | half(second)?) }
    }
}

/// A range of RAM, aligned to its chunks.
///
/// Words are atomics only because the processor's library wants a bus that may be shared between
/// threads; one thread uses it.
pub struct Memory {
    start: u32,
    chunks: Box<[OnceLock<Chunk>]>,
    bytes: u32,
}

impl Memory {
    /// Returns `bytes` bytes of RAM that begin at `start`.
    pub fn new(start: u32, bytes: u32) -> Self {
        let chunks = bytes.div_ceil(CHUNK_BYTES);
        Self { start, chunks: (0..chunks).map(|_| OnceLock::new()).collect(), bytes }
    }

    /// Returns whether an address lies in it.
    #[inline]
    pub fn contains(&self, address: u32) -> bool {
        address.wrapping_sub(self.start) < self.bytes
    }

    #[inline]
    fn chunk(&self, address: u32) -> (&Chunk, u32) {
        let offset = address.wrapping_sub(self.start);
        let chunk = self.chunks[(offset / CHUNK_BYTES) as usize].get_or_init(|| Chunk {
            words: (0..CHUNK_BYTES / 4).map(|_| AtomicU32::new(GARBAGE)).collect(),
            lines: (0..CHUNK_BYTES / LINE_BYTES).map(|_| AtomicU8::new(0)).collect(),
        });
        (chunk, offset % CHUNK_BYTES)
    }

    /// Returns the page of 4 KiB that holds an address.
    pub fn page(&self, address: u32) -> Page<'_> {
        let (chunk, offset) = self.chunk(address & !0xFFF);
        let (word, line) = ((offset / 4) as usize, (offset / LINE_BYTES) as usize);
        Page {
            words: &chunk.words[word..word + 0x1000 / 4],
            lines: &chunk.lines[line..line + 0x1000 / LINE_BYTES as usize],
        }
    }

    /// Reads the word that holds an address.
    #[inline]
    pub fn word(&self, address: u32) -> u32 {
        let (chunk, offset) = self.chunk(address);
        chunk.words[(offset / 4) as usize].load(Relaxed)
    }

    /// Writes the word that holds an address.
    #[inline]
    pub fn set_word(&self, address: u32, value: u32) {
        let (chunk, offset) = self.chunk(address);
        chunk.words[(offset / 4) as usize].store(value, Relaxed);
    }

    /// Reads 1, 2 or 4 bytes that do not cross a word.
    #[inline]
    pub fn read(&self, address: u32, bytes: u32) -> u32 {
        let word = self.word(address) >> (8 * (address & 3));
        if bytes == 4 { word } else { word & ((1 << (8 * bytes)) - 1) }
    }

    /// Writes 1, 2 or 4 bytes that do not cross a word.
    #[inline]
    pub fn write(&self, address: u32, bytes: u32, value: u32) {
        if bytes == 4 {
            return self.set_word(address, value);
        }
        let shift = 8 * (address & 3);
        let mask = ((1 << (8 * bytes)) - 1) << shift;
        self.set_word(address, self.word(address) & !mask | value << shift & mask);
    }

    /// Writes bytes anywhere, as a loader does.
    pub fn load(&self, address: u32, bytes: &[u8]) {
        for (address, byte) in (address..).zip(bytes) {
            self.write(address, 1, u32::from(*byte));
        }
    }

    /// Reads bytes from anywhere.
    pub fn bytes(&self, address: u32, count: usize) -> Vec<u8> {
        (address..).take(count).map(|address| self.read(address, 1) as u8).collect()
    }

    /// Returns the state of the line that holds an address; see [`crate::cache`].
    #[inline]
    pub fn line(&self, address: u32) -> &AtomicU8 {
        let (chunk, offset) = self.chunk(address);
        &chunk.lines[(offset / LINE_BYTES) as usize]
    }

    /// Forgets what is known of all lines.
    pub fn forget_lines(&self) {
        for line in self.chunks.iter().filter_map(OnceLock::get).flat_map(|chunk| &chunk.lines) {
            line.store(0, Relaxed);
        }
    }

    /// Fills the line that begins at an address with garbage: what it held is lost.
    pub fn poison(&self, line: u32) {
        for address in (line..).step_by(4).take((LINE_BYTES / 4) as usize) {
            self.set_word(address, GARBAGE);
        }
    }
}
