//! What the driver asks of a board: registers, DMA memory, a clock.

use crate::mmio::{Register, Registers};
use core::ptr::NonNull;
use dwc2_host::{DMA_BYTES, LINE_BYTES};

/// A register of the core, by its offset.
#[derive(Clone, Copy)]
struct Offset(u32);

impl Register for Offset {
    fn offset(self) -> usize {
        self.0 as usize
    }
}

/// The board's clock: microseconds since some moment before.
pub trait Now: Copy {
    /// Returns the time.
    fn microseconds(self) -> u64;
}

/// A DWC2 core whose DMA memory the processor does not cache.
pub struct Dwc2Core<T> {
    registers: Registers<Offset>,
    memory: NonNull<[u8; DMA_BYTES]>,
    clock: T,
    barrier: fn(),
}

// SAFETY: the core owns its device and its memory.
unsafe impl<T: Send> Send for Dwc2Core<T> {}

impl<T: Now> Dwc2Core<T> {
    /// Returns the core whose registers are at `address`, with its DMA memory. `barrier` returns when all stores
    /// to the memory have arrived there, and no load from it has been made early.
    ///
    /// # Safety
    /// - A DWC2 core answers at `address`, out of reset, and no other driver writes to it.
    /// - At `memory`, [`DMA_BYTES`] of RAM lie that nothing else uses, mapped uncached, and the core
    ///   reaches them by the same address.
    ///
    /// # Panics
    /// When `memory` is 0 or not on a cache line ([`LINE_BYTES`]).
    #[must_use]
    pub unsafe fn at(address: usize, memory: usize, clock: T, barrier: fn()) -> Self {
        assert!(memory.is_multiple_of(LINE_BYTES), "DMA memory starts on a cache line");
        let memory = NonNull::new(core::ptr::with_exposed_provenance_mut(memory));
        // SAFETY: the caller's promise is the same.
        let registers = unsafe { Registers::at(address) };
        Self { registers, memory: memory.expect("DMA memory is not at address 0"), clock, barrier }
    }

    /// Returns where `length` bytes from `offset` lie.
    ///
    /// # Panics
    /// When they are not inside the memory.
    fn bytes(&self, offset: usize, length: usize) -> *mut u8 {
        assert!(offset <= DMA_BYTES && length <= DMA_BYTES - offset, "DMA memory ends at {DMA_BYTES}");
        // SAFETY: the assertion above.
        unsafe { self.memory.as_ptr().cast::<u8>().add(offset) }
    }
}

impl<T> dwc2_host::Registers for Dwc2Core<T> {
    fn read_register(&mut self, offset: u32) -> u32 {
        self.registers.read(Offset(offset))
    }

    fn write_register(&mut self, offset: u32, value: u32) {
        self.registers.write(Offset(offset), value);
    }
}

impl<T: Now> dwc2_host::DmaMemory for Dwc2Core<T> {
    fn length(&self) -> usize {
        DMA_BYTES
    }

    fn bus_address(&self) -> u32 {
        self.memory.addr().get() as u32
    }

    fn copy_in(&mut self, offset: usize, bytes: &[u8]) {
        let memory = self.bytes(offset, bytes.len());
        // SAFETY: `bytes` checked that they fit; `at`'s caller gave the memory to this core alone.
        unsafe { memory.copy_from_nonoverlapping(bytes.as_ptr(), bytes.len()) };
    }

    fn copy_out(&mut self, offset: usize, bytes: &mut [u8]) {
        let memory = self.bytes(offset, bytes.len());
        // SAFETY: as above.
        unsafe { memory.copy_to_nonoverlapping(bytes.as_mut_ptr(), bytes.len()) };
    }

    /// Orders what was stored before the register that starts the transfer: one is Normal memory, the
    /// other Device memory.
    fn clean(&mut self, _: usize, _: usize) {
        (self.barrier)();
    }

    /// Orders the register that tells a transfer's end before what is loaded after.
    fn invalidate(&mut self, _: usize, _: usize) {
        (self.barrier)();
    }
}

impl<T: Now> dwc2_host::Clock for Dwc2Core<T> {
    fn now_us(&self) -> u64 {
        self.clock.microseconds()
    }
}
