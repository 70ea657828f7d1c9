//! What the processor sees: RAM, and registers behind [`Hardware`].

mod hint;
mod lent;

use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU32, AtomicU64, Ordering::Relaxed};
use std::sync::{Mutex, MutexGuard, PoisonError};

use hint::Hint;
use lent::Lent;

use crate::cache::{Attribute, Caches, Operation};
use crate::devices::{Hardware, ResetCause};
use crate::memory::{LINE_BYTES, Memory};
use crate::time::Clocks;
use crate::violation::{Access, Violation};

/// The SDRAM: 1 GiB at 0, as U-Boot maps it.
const SDRAM_BYTES: u32 = 1 << 30;
/// The on-chip RAM: 64 KiB at the end of the address space.
const OCRAM: (u32, u32) = (0xFFFF_0000, 0x1_0000);
/// Where U-Boot has moved itself; its exception vectors are the first thing there.
pub const UBOOT: u32 = 0x3F00_0000;

/// Beside a page's [`Attribute`]: a bus master has, or had, some of the page.
const LENT: u8 = 1 << 7;

/// Pages in the address space, of 4 KiB.
const PAGES: usize = 1 << 20;

/// The access was refused; the bus knows why.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Refused;

/// Buses, memories and everything on them.
///
/// The processor's library wants to share it, so it takes `&self`; one thread uses it.
pub struct Bus {
    sdram: Memory,
    ocram: Memory,
    /// What the caches may hold.
    pub caches: Caches,
    hardware: Mutex<Hardware>,
    /// [`Attribute`] of each physical page, as its last translation said.
    attributes: Box<[AtomicU8]>,
    mmu_on: AtomicBool,
    data_cache_on: AtomicBool,
    /// The MMU reads its table: through the caches, whatever the program may do with it.
    walking: AtomicBool,
    now: AtomicU64,
    deadline: AtomicU64,
    instruction: AtomicU32,
    /// What was fetched last.
    half: AtomicU32,
    interrupt: AtomicBool,
    violation: Mutex<Option<Violation>>,
    lent: Lent,
}

impl Bus {
    /// Returns the machine's buses after power-on.
    pub fn new(hardware: Hardware) -> Self {
        Self {
            sdram: Memory::new(0, SDRAM_BYTES),
            ocram: Memory::new(OCRAM.0, OCRAM.1),
            caches: Caches::as_uboot_leaves_them(),
            hardware: Mutex::new(hardware),
            attributes: (0..PAGES).map(|_| AtomicU8::new(Attribute::Device as u8)).collect(),
            mmu_on: AtomicBool::new(false),
            data_cache_on: AtomicBool::new(false),
            walking: AtomicBool::new(false),
            now: AtomicU64::new(0),
            deadline: AtomicU64::new(0),
            instruction: AtomicU32::new(0),
            half: AtomicU32::new(0),
            interrupt: AtomicBool::new(false),
            violation: Mutex::new(None),
            lent: Lent::default(),
        }
    }

    /// Returns everything that is not memory.
    pub fn hardware(&self) -> MutexGuard<'_, Hardware> {
        self.hardware.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the SDRAM, for a loader or an onlooker.
    pub fn sdram(&self) -> &Memory {
        &self.sdram
    }

    /// Returns the on-chip RAM.
    pub fn ocram(&self) -> &Memory {
        &self.ocram
    }

    /// Resets everything but memory and time, up to where U-Boot starts the program again.
    pub fn restart(&self, cause: ResetCause) {
        self.hardware().restart(cause, self.now(), self);
        self.lent.clear();
        self.caches.restart(&self.sdram);
        self.set_translation(false, false);
        self.set_interrupt(false);
    }

    /// Returns the time.
    #[inline]
    pub fn now(&self) -> Clocks {
        self.now.load(Relaxed)
    }

    /// Sets the time: an instruction ran, or nothing happens until then.
    #[inline]
    pub fn set_now(&self, now: Clocks) {
        self.now.store(now, Relaxed);
    }

    /// Returns when the processor shall pause.
    #[inline]
    pub fn deadline(&self) -> Clocks {
        self.deadline.load(Relaxed)
    }

    /// Says when the processor shall pause: at 0 after the instruction under way.
    pub fn set_deadline(&self, deadline: Clocks) {
        self.deadline.store(deadline, Relaxed);
    }

    /// Returns the interrupt controller's line to the processor.
    pub fn interrupt(&self) -> bool {
        self.interrupt.load(Relaxed)
    }

    /// Sets the interrupt controller's line to the processor.
    pub fn set_interrupt(&self, level: bool) {
        self.interrupt.store(level, Relaxed);
    }

    /// Takes the reason why the run must stop, if there is one.
    pub fn take_violation(&self) -> Option<Violation> {
        self.violation.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// Notes what the system control register says of MMU and data cache.
    pub fn set_translation(&self, mmu_on: bool, data_cache_on: bool) {
        self.mmu_on.store(mmu_on, Relaxed);
        self.data_cache_on.store(data_cache_on, Relaxed);
    }

    /// Says whether the reads that come are the MMU's.
    pub fn set_walking(&self, walking: bool) {
        self.walking.store(walking, Relaxed);
    }

    /// Notes what a translation says of a physical page.
    pub fn set_attribute(&self, address: u32, attribute: Attribute) {
        let page = &self.attributes[(address >> 12) as usize];
        page.store(page.load(Relaxed) & LENT | attribute as u8, Relaxed);
    }

    /// Returns what kind of memory an address is now.
    #[inline]
    fn attribute(&self, address: u32) -> Attribute {
        if !self.mmu_on.load(Relaxed) {
            return Attribute::Device;
        }
        match self.attributes[(address >> 12) as usize].load(Relaxed) & !LENT {
            2 if self.data_cache_on.load(Relaxed) => Attribute::Cached,
            1 | 2 => Attribute::Uncached,
            _ => Attribute::Device,
        }
    }

    /// Says what is wrong with an access by the processor to what a bus master has.
    #[inline]
    fn check_lent(&self, address: u32, bytes: u32, writes: bool) -> Result<(), &'static str> {
        if self.attributes[(address >> 12) as usize].load(Relaxed) & LENT == 0 {
            return Ok(());
        }
        self.lent.check(address, bytes, writes)
    }

    #[inline]
    fn ram(&self, address: u32) -> Option<&Memory> {
        if self.sdram.contains(address) {
            return Some(&self.sdram);
        }
        self.ocram.contains(address).then_some(&self.ocram)
    }

    /// Notes which instruction the accesses that come are of, by its physical address.
    #[inline]
    pub fn set_instruction(&self, address: u32) {
        self.instruction.store(address, Relaxed);
    }

    /// Returns whether a program's code may lie at an address.
    pub fn is_code(&self, address: u32) -> bool {
        (0..UBOOT).contains(&address)
    }

    /// Does what DSB and DMB do.
    pub fn barrier(&self) {
        self.caches.barrier(&self.sdram);
    }

    /// Fetches an instruction.
    ///
    /// # Errors
    /// When the run must stop.
    #[inline]
    pub fn fetch(&self, address: u32, bytes: u32) -> Result<u32, Refused> {
        self.set_instruction(address);
        let Some(ram) = self.ram(address) else {
            return Err(self.refuse(Access::Fetch, address, "no memory to fetch from", "a jump to code"));
        };
        if (UBOOT..SDRAM_BYTES).contains(&address) {
            let needed = "an exception was taken, or a jump made, into U-Boot, which is gone: set VBAR first";
            return Err(self.refuse(Access::Fetch, address, "U-Boot's memory", needed));
        }
        if let Err(needed) = self.caches.fetch(ram, address) {
            return Err(self.refuse(Access::Fetch, address, "memory", needed));
        }
        let word = ram.read(address, bytes);
        // Thumb code comes in halves.
        let before = self.half.swap(word, Relaxed);
        match if bytes == 2 { hint::of_thumb(before, word) } else { hint::of(word) } {
            Some(Hint::Wait) => self.set_deadline(0),
            Some(Hint::Barrier) => self.barrier(),
            Some(Hint::Exclusive) if !self.mmu_on.load(Relaxed) => {
                let needed =
                    "the MMU on: without, memory is strongly ordered, where an exclusive access need not succeed";
                return Err(self.refuse(Access::Fetch, address, "an exclusive access", needed));
            }
            Some(Hint::Exclusive) | None => {}
        }
        Ok(word)
    }

    /// Reads for the processor: 1, 2 or 4 bytes that do not cross a word.
    ///
    /// # Errors
    /// When the run must stop.
    #[inline]
    pub fn read(&self, address: u32, bytes: u32) -> Result<u32, Refused> {
        if let Some(ram) = self.ram(address) {
            if self.walking.load(Relaxed) {
                return Ok(ram.read(address, bytes));
            }
            let cached = self.attribute(address) == Attribute::Cached;
            let done = self.check_lent(address, bytes, false).and_then(|()| self.caches.read(ram, address, cached));
            return match done {
                Ok(()) => Ok(ram.read(address, bytes)),
                Err(needed) => Err(self.refuse(Access::Read(bytes), address, "memory", needed)),
            };
        }
        self.registers(Access::Read(bytes), address)
    }

    /// Writes for the processor: 1, 2 or 4 bytes that do not cross a word.
    ///
    /// # Errors
    /// When the run must stop.
    #[inline]
    pub fn write(&self, address: u32, bytes: u32, value: u32) -> Result<(), Refused> {
        if let Some(ram) = self.ram(address) {
            let attribute = self.attribute(address);
            let done = self.check_lent(address, bytes, true).and_then(|()| self.caches.write(ram, address, attribute));
            return match done {
                Ok(()) => {
                    ram.write(address, bytes, value);
                    Ok(())
                }
                Err(needed) => Err(self.refuse(Access::Write(bytes, value), address, "memory", needed)),
            };
        }
        self.registers(Access::Write(bytes, value), address).map(|_| ())
    }

    /// Accesses a register.
    fn registers(&self, access: Access, address: u32) -> Result<u32, Refused> {
        if self.attribute(address) != Attribute::Device {
            let needed = "the MMU maps registers as normal memory, where accesses are merged, repeated and made early";
            return Err(self.refuse(access, address, "registers", needed));
        }
        let mut hardware = self.hardware();
        let before = self.now();
        match hardware.access(access, address, before, self) {
            Ok((value, cost)) => {
                self.set_now(before + cost);
                // Something may be due sooner now.
                self.set_deadline(self.deadline().min(hardware.next_event(before + cost)));
                if hardware.interrupt() != self.interrupt() || hardware.attention() {
                    self.set_deadline(0);
                }
                self.set_interrupt(hardware.interrupt());
                Ok(value)
            }
            Err((block, needed)) => {
                drop(hardware);
                Err(self.refuse(access, address, &block, &needed))
            }
        }
    }

    /// Does an L1 operation by address, as the processor asks for it.
    ///
    /// # Errors
    /// When the run must stop.
    pub fn l1_line(&self, address: u32, operation: Operation) -> Result<(), Refused> {
        match self.ram(address) {
            Some(ram) => {
                self.caches.l1_line(ram, address, operation);
                Ok(())
            }
            None => Err(self.refuse(Access::Maintenance, address, "no memory", "an address in memory")),
        }
    }

    /// Does an L1 operation by set and way.
    ///
    /// # Errors
    /// When the run must stop.
    pub fn l1_set_way(&self, set_way: u32, operation: Operation) -> Result<(), Refused> {
        self.caches
            .l1_set_way(&self.sdram, set_way, operation)
            .map_err(|needed| self.refuse(Access::Maintenance, set_way, "L1 data cache", &needed))
    }

    /// Reads memory for a bus master.
    ///
    /// # Errors
    /// When the run must stop.
    pub fn dma_read(&self, address: u32, bytes: &mut [u8]) -> Result<(), Refused> {
        for (index, (address, byte)) in (address..).zip(bytes).enumerate() {
            let Some(ram) = self.ram(address) else {
                return Err(self.refuse(Access::DmaRead, address, "no memory", "an address in memory"));
            };
            let new_line = index == 0 || address.is_multiple_of(LINE_BYTES);
            if new_line && let Err(needed) = self.caches.dma_read(ram, address) {
                return Err(self.refuse(Access::DmaRead, address, "memory", needed));
            }
            *byte = ram.read(address, 1) as u8;
        }
        Ok(())
    }

    /// Writes memory for a bus master.
    ///
    /// # Errors
    /// When the run must stop.
    pub fn dma_write(&self, address: u32, bytes: &[u8]) -> Result<(), Refused> {
        for (index, (address, byte)) in (address..).zip(bytes).enumerate() {
            let Some(ram) = self.ram(address) else {
                return Err(self.refuse(Access::DmaWrite, address, "no memory", "an address in memory"));
            };
            let new_line = index == 0 || address.is_multiple_of(LINE_BYTES);
            if new_line && let Err(needed) = self.caches.dma_write(ram, address) {
                return Err(self.refuse(Access::DmaWrite, address, "memory", needed));
            }
            ram.write(address, 1, u32::from(*byte));
        }
        Ok(())
    }

    /// Lends memory to a bus master's channel, which writes there or only reads.
    pub fn lend(&self, channel: usize, address: u32, bytes: u32, writes: bool) {
        self.lent.add(channel, address, bytes, writes);
        for page in address >> 12..=address.saturating_add(bytes.saturating_sub(1)) >> 12 {
            self.attributes[page as usize].fetch_or(LENT, Relaxed);
        }
    }

    /// Takes back what a bus master's channel was lent.
    pub fn give_back(&self, channel: usize) {
        self.lent.remove(channel);
    }

    /// Returns whether the run is about to stop.
    pub fn is_refusing(&self) -> bool {
        self.violation.lock().unwrap_or_else(PoisonError::into_inner).is_some()
    }

    /// Stops the run; the first reason counts.
    pub fn refuse(&self, access: Access, address: u32, block: &str, needed: &str) -> Refused {
        self.set_deadline(0);
        let mut violation = self.violation.lock().unwrap_or_else(PoisonError::into_inner);
        violation.get_or_insert_with(|| Violation {
            access,
            address,
            block: block.into(),
            needed: needed.into(),
            instruction: self.instruction.load(Relaxed),
            disassembly: String::new(),
            time: self.now(),
        });
        Refused
    }
}
