//! What is cached, what is done to caches, and how often it was.

use serde::{Deserialize, Serialize};

/// What an address's translation says, as far as caches go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Attribute {
    /// Device or strongly ordered memory, or any with the MMU off.
    Device,
    /// Normal memory that is not cached.
    Uncached,
    /// Normal memory that both levels may cache.
    Cached,
}

/// An operation on a line by its address, or on lines by their place in the cache.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Operation {
    /// Writes dirty lines back.
    pub clean: bool,
    /// Forgets lines.
    pub invalidate: bool,
}

/// How often what was done.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// L1 operations by address.
    pub l1_lines: u64,
    /// L1 operations by set and way.
    pub l1_sets: u64,
    /// L2 operations by address.
    pub l2_lines: u64,
    /// L2 operations by way.
    pub l2_ways: u64,
    /// Lines that bus masters read.
    pub dma_reads: u64,
    /// Lines that bus masters wrote.
    pub dma_writes: u64,
}
