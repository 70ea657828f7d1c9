//! Both cache levels, as far as mistakes with them would show on the board.
//!
//! There is one copy of the data; what is tracked for each line of 32 bytes is what the caches
//! *may* hold of it. Nothing is ever evicted by itself and everything may be at any time, so a
//! program that passes here does not rely on luck:
//!
//! | done | while | is |
//! | --- | --- | --- |
//! | access around the caches | a level may hold the line dirty | refused |
//! | access through the caches | a bus master wrote the line and a level was not invalidated since | refused |
//! | access through L1 | L2 is off and holds the line dirty | refused |
//! | DMA read | a level may hold the line dirty, or no barrier followed an uncached write | refused |
//! | DMA write | a level may hold the line dirty, and so may write it back over the new data | refused |
//! | invalidation of the whole of a level | it holds dirty lines | refused |
//! | invalidation of a line | it is dirty | done, and the line then holds garbage |
//!
//! **What U-Boot leaves**: any line that nobody has touched since power-on may be dirty in both
//! levels, until all of L1 and then all of L2 was cleaned.

mod kinds;

use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::{Mutex, MutexGuard, PoisonError};

pub use kinds::{Attribute, Counts, Operation};

use crate::memory::{LINE_BYTES, Memory};

/// Someone touched the line since power-on, so the bits below say all.
const KNOWN: u8 = 1 << 0;
const L1_DIRTY: u8 = 1 << 1;
const L2_DIRTY: u8 = 1 << 2;
/// A bus master wrote the line, and the level may still hold what was there before.
const L1_STALE: u8 = 1 << 3;
const L2_STALE: u8 = 1 << 4;
/// Written around the caches, with no barrier since.
const UNORDERED: u8 = 1 << 5;
/// In the list of the level's dirty lines, whether or not it still is.
const L1_LISTED: u8 = 1 << 6;
const L2_LISTED: u8 = 1 << 7;

const DIRTY: u8 = L1_DIRTY | L2_DIRTY;
const STALE: u8 = L1_STALE | L2_STALE;

/// Sets of the L1 data cache: 32 KiB in four ways.
const L1_SETS: usize = 256;
const L1_ALL_WAYS: u8 = 0xF;

struct Lists {
    /// Lines that L1 may hold dirty, by set.
    l1: Vec<Vec<u32>>,
    /// Ways of each set that were cleaned since a line of the set became dirty.
    l1_ways: [u8; L1_SETS],
    /// Sets that were cleaned since power-on.
    l1_sets: [bool; L1_SETS],
    l2: Vec<u32>,
    unordered: Vec<u32>,
    counts: Counts,
}

/// The caches' bookkeeping.
pub struct Caches {
    lists: Mutex<Lists>,
    l2_on: AtomicBool,
    /// Lines of which nothing is known may be dirty in L1, in L2.
    loader_in_l1: AtomicBool,
    loader_in_l2: AtomicBool,
}

impl Caches {
    /// Returns the caches as U-Boot leaves them: both on, and full of its own data.
    pub fn as_uboot_leaves_them() -> Self {
        Self {
            lists: Mutex::new(Lists {
                l1: vec![Vec::new(); L1_SETS],
                l1_ways: [0; L1_SETS],
                l1_sets: [false; L1_SETS],
                l2: Vec::new(),
                unordered: Vec::new(),
                counts: Counts::default(),
            }),
            l2_on: AtomicBool::new(true),
            loader_in_l1: AtomicBool::new(true),
            loader_in_l2: AtomicBool::new(true),
        }
    }

    /// Makes the caches what U-Boot leaves after a reset: nothing is known of any line.
    pub fn restart(&self, memory: &Memory) {
        memory.forget_lines();
        let counts = self.counts();
        let fresh = Self::as_uboot_leaves_them();
        *self.lists() = fresh.lists.into_inner().unwrap_or_else(PoisonError::into_inner);
        self.lists().counts = counts;
        for flag in [&self.l2_on, &self.loader_in_l1, &self.loader_in_l2] {
            flag.store(true, Relaxed);
        }
    }

    /// Says that U-Boot has written its dirty lines back.
    pub fn flush_loader(&self) {
        self.loader_in_l1.store(false, Relaxed);
        self.loader_in_l2.store(false, Relaxed);
    }

    fn lists(&self) -> MutexGuard<'_, Lists> {
        self.lists.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns how often what was done since power-on.
    pub fn counts(&self) -> Counts {
        self.lists().counts
    }

    /// Says whether the L2 cache is on.
    pub fn set_l2(&self, on: bool) {
        self.l2_on.store(on, Relaxed);
    }

    /// Returns the line's state, with what U-Boot may have left in the caches.
    #[inline]
    fn state(&self, memory: &Memory, address: u32) -> u8 {
        let state = memory.line(address).load(Relaxed);
        if state & KNOWN != 0 {
            return state;
        }
        let l1 = if self.loader_in_l1.load(Relaxed) { L1_DIRTY } else { 0 };
        let l2 = if self.loader_in_l2.load(Relaxed) { L2_DIRTY } else { 0 };
        state | l1 | l2
    }

    /// Notes a read by the processor.
    ///
    /// # Errors
    /// What is wrong with it.
    #[inline]
    pub fn read(&self, memory: &Memory, address: u32, cached: bool) -> Result<(), &'static str> {
        let state = self.state(memory, address);
        if cached {
            if state & STALE != 0 {
                return Err(
                    "a bus master wrote this line, and the caches may hold what was there before: invalidate L2, then L1",
                );
            }
            if state & KNOWN != 0 && state & L2_DIRTY != 0 && !self.l2_on.load(Relaxed) {
                return Err("the L2 cache was turned off while it held this line dirty: clean it first");
            }
            return Ok(());
        }
        around(state)
    }

    /// Notes a write by the processor.
    ///
    /// # Errors
    /// What is wrong with it.
    #[inline]
    pub fn write(&self, memory: &Memory, address: u32, attribute: Attribute) -> Result<(), &'static str> {
        let cached = attribute == Attribute::Cached;
        self.read(memory, address, cached)?;
        let line = memory.line(address);
        let state = line.load(Relaxed);
        if cached {
            if state & (KNOWN | L1_DIRTY) != KNOWN | L1_DIRTY {
                self.becomes_dirty(memory, address);
            }
        } else if attribute == Attribute::Uncached && state & UNORDERED == 0 {
            line.store(state | KNOWN | UNORDERED, Relaxed);
            self.lists().unordered.push(address);
        } else if state & KNOWN == 0 {
            line.store(state | KNOWN, Relaxed);
        }
        Ok(())
    }

    #[cold]
    fn becomes_dirty(&self, memory: &Memory, address: u32) {
        let line = memory.line(address);
        let state = self.state(memory, address) | KNOWN | L1_DIRTY | L1_LISTED;
        let before = line.swap(state, Relaxed);
        let set = set_of(address);
        let mut lists = self.lists();
        if before & L1_LISTED == 0 {
            lists.l1[set].push(address);
        }
        if state & L2_DIRTY != 0 && before & L2_LISTED == 0 {
            line.store(state | L2_LISTED, Relaxed);
            lists.l2.push(address);
        }
        lists.l1_ways[set] = 0;
    }

    /// Notes an instruction fetch.
    ///
    /// # Errors
    /// When the line's new contents may not have left the data cache.
    #[inline]
    pub fn fetch(&self, memory: &Memory, address: u32) -> Result<(), &'static str> {
        if !is_fetched(memory.line(address).load(Relaxed)) {
            return Err("the instruction was written and not yet cleaned out of the L1 data cache");
        }
        Ok(())
    }

    /// Notes a barrier (DMB or DSB).
    pub fn barrier(&self, memory: &Memory) {
        let mut lists = self.lists();
        for address in lists.unordered.drain(..) {
            memory.line(address).fetch_and(!UNORDERED, Relaxed);
        }
    }

    /// Does an L1 operation on the line that holds an address.
    pub fn l1_line(&self, memory: &Memory, address: u32, operation: Operation) {
        self.lists().counts.l1_lines += 1;
        let mut state = self.state(memory, address) | KNOWN;
        if operation.clean && state & L1_DIRTY != 0 {
            state &= !L1_DIRTY;
            if self.l2_on.load(Relaxed) {
                state |= L2_DIRTY;
            }
        }
        if operation.invalidate {
            if state & L1_DIRTY != 0 {
                memory.poison(address & !(LINE_BYTES - 1));
                state &= !L1_DIRTY;
            }
            // A stale L2 line may come back at once.
            if state & L2_STALE == 0 {
                state &= !L1_STALE;
            }
        }
        self.store(memory, address, state);
    }

    /// Stores a line's state, and lists it where it is dirty.
    fn store(&self, memory: &Memory, address: u32, state: u8) {
        let mut state = state;
        let mut lists = self.lists();
        if state & (L1_DIRTY | L1_LISTED) == L1_DIRTY {
            lists.l1[set_of(address)].push(address);
            state |= L1_LISTED;
        }
        if state & (L2_DIRTY | L2_LISTED) == L2_DIRTY {
            lists.l2.push(address);
            state |= L2_LISTED;
        }
        memory.line(address).store(state, Relaxed);
    }

    /// Does an L1 operation on one way of one set.
    ///
    /// Which way a line is in nobody knows, so lines are taken for clean when all ways of their set are.
    ///
    /// # Errors
    /// When dirty lines would be lost.
    pub fn l1_set_way(&self, memory: &Memory, set_way: u32, operation: Operation) -> Result<(), String> {
        let (set, way) = (set_of(set_way), set_way >> 30);
        let mut lists = self.lists();
        lists.counts.l1_sets += 1;
        if !operation.clean {
            let dirty = lists.l1[set].iter().filter(|at| memory.line(**at).load(Relaxed) & L1_DIRTY != 0).count();
            if dirty > 0 || self.loader_in_l1.load(Relaxed) && !lists.l1_sets[set] {
                return Err(format!("set {set} of L1 may hold dirty lines that are lost: clean before invalidating"));
            }
        }
        lists.l1_ways[set] |= 1 << way;
        if lists.l1_ways[set] != L1_ALL_WAYS {
            return Ok(());
        }
        lists.l1_ways[set] = 0;
        lists.l1_sets[set] = true;
        let l2_on = self.l2_on.load(Relaxed);
        for address in std::mem::take(&mut lists.l1[set]) {
            let line = memory.line(address);
            let state = line.load(Relaxed);
            let mut next = state & !(L1_DIRTY | L1_LISTED);
            if state & L1_DIRTY != 0 && l2_on {
                next |= L2_DIRTY;
            }
            if next & (L2_DIRTY | L2_LISTED) == L2_DIRTY {
                next |= L2_LISTED;
                lists.l2.push(address);
            }
            line.store(next, Relaxed);
        }
        if lists.l1_sets.iter().all(|cleaned| *cleaned) {
            self.loader_in_l1.store(false, Relaxed);
        }
        Ok(())
    }

    /// Does an L2 operation on the line that holds an address.
    pub fn l2_line(&self, memory: &Memory, address: u32, operation: Operation) {
        self.lists().counts.l2_lines += 1;
        let mut state = self.state(memory, address) | KNOWN;
        if operation.clean {
            state &= !L2_DIRTY;
        }
        if operation.invalidate {
            if state & L2_DIRTY != 0 {
                memory.poison(address & !(LINE_BYTES - 1));
            }
            state &= !(L2_DIRTY | L2_STALE);
        }
        self.store(memory, address, state);
    }

    /// Does an L2 operation on all ways.
    ///
    /// # Errors
    /// When dirty lines would be lost.
    pub fn l2_all(&self, memory: &Memory, operation: Operation) -> Result<(), String> {
        let mut lists = self.lists();
        lists.counts.l2_ways += 1;
        if !operation.clean {
            let dirty = lists.l2.iter().filter(|at| memory.line(**at).load(Relaxed) & L2_DIRTY != 0).count();
            if dirty > 0 || self.loader_in_l2.load(Relaxed) {
                return Err("the L2 cache may hold dirty lines that are lost: clean before invalidating".into());
            }
        }
        for address in lists.l2.drain(..) {
            memory.line(address).fetch_and(!(L2_DIRTY | L2_LISTED), Relaxed);
        }
        // What L1 still holds may reach L2 later.
        if !self.loader_in_l1.load(Relaxed) {
            self.loader_in_l2.store(false, Relaxed);
        }
        Ok(())
    }

    /// Notes that a bus master reads the line that holds an address.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn dma_read(&self, memory: &Memory, address: u32) -> Result<(), &'static str> {
        self.lists().counts.dma_reads += 1;
        let state = self.state(memory, address);
        if state & L1_DIRTY != 0 {
            return Err("the L1 cache may hold newer data than memory: clean L1, then L2, before the transfer");
        }
        if state & L2_DIRTY != 0 {
            return Err("the L2 cache may hold newer data than memory: clean L2 after L1, before the transfer");
        }
        if state & UNORDERED != 0 {
            return Err("the processor wrote this line and no barrier followed: DSB before the transfer");
        }
        Ok(())
    }

    /// Notes that a bus master writes the line that holds an address.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn dma_write(&self, memory: &Memory, address: u32) -> Result<(), &'static str> {
        self.lists().counts.dma_writes += 1;
        let state = self.state(memory, address);
        if state & DIRTY != 0 {
            return Err(
                "a cache may hold this line dirty and write it back over the new data: clean or invalidate before the transfer",
            );
        }
        let l2 = if self.l2_on.load(Relaxed) { L2_STALE } else { 0 };
        memory.line(address).store(state | KNOWN | L1_STALE | l2, Relaxed);
        Ok(())
    }
}

/// Returns whether an instruction of a line in this state can be fetched.
#[inline]
pub(crate) fn is_fetched(line: u8) -> bool {
    line & L1_DIRTY == 0
}

/// Says what is wrong with an access around the caches.
#[inline]
fn around(state: u8) -> Result<(), &'static str> {
    if state & L1_DIRTY != 0 {
        return Err("the access goes around the caches, and L1 may hold this line dirty: clean L1, then L2, first");
    }
    if state & L2_DIRTY != 0 {
        return Err("the access goes around the caches, and L2 may hold this line dirty: clean L2, after L1, first");
    }
    Ok(())
}

fn set_of(address: u32) -> usize {
    (address / LINE_BYTES) as usize % L1_SETS
}
