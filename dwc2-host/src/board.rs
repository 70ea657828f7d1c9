//! What a board gives the driver: registers, memory that the core can reach, and a clock.

/// Bytes that share no cache line with their neighbours: every range that the driver cleans or
/// invalidates begins and ends on a multiple of this. 64 covers every Cortex-A (the Cortex-A9 and its PL310 have 32).
pub const LINE_BYTES: usize = 64;

/// The core's registers.
pub trait Registers {
    /// Reads the 32-bit register at `offset` bytes from the core's base, once.
    fn read_register(&mut self, offset: u32) -> u32;

    /// Writes the 32-bit register at `offset` bytes from the core's base, once.
    ///
    /// Writes reach the core in program order, and after all that [`DmaMemory::clean`] has cleaned.
    fn write_register(&mut self, offset: u32, value: u32);
}

/// A piece of memory that the core reads and writes by DMA. Offsets count bytes from its start.
///
/// Memory that the processor does not cache may do nothing but a barrier in `clean` and `invalidate`.
pub trait DmaMemory {
    /// Length in bytes: at least [`DMA_BYTES`](crate::DMA_BYTES).
    fn length(&self) -> usize;

    /// The address by which the core reaches offset 0: a multiple of [`LINE_BYTES`].
    fn bus_address(&self) -> u32;

    /// Copies `bytes` in at `offset`, through the processor's view.
    fn copy_in(&mut self, offset: usize, bytes: &[u8]);

    /// Copies `bytes.len()` bytes out from `offset`, through the processor's view.
    fn copy_out(&mut self, offset: usize, bytes: &mut [u8]);

    /// Writes `length` bytes from `offset` back to memory; returns when the core can read them.
    fn clean(&mut self, offset: usize, length: usize);

    /// Forgets what caches hold of `length` bytes from `offset`, without writing it back.
    fn invalidate(&mut self, offset: usize, length: usize);
}

/// A clock that never goes back.
pub trait Clock {
    /// Microseconds since some moment before the driver was made.
    fn now_us(&self) -> u64;
}

/// All that a board gives; implemented for whatever implements the three.
pub trait Board: Registers + DmaMemory + Clock {}

impl<T: Registers + DmaMemory + Clock + ?Sized> Board for T {}
