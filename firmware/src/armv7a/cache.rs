//! L1 cache maintenance of this core (ARM DDI 0406, §B4.2.1).
//!
//! The Cortex-A9 knows nothing of the PL310 behind it: to hand memory to a device that reads the
//! SDRAM itself, clean L1 and then L2; to take it back, invalidate L2 and then L1.

use super::cache_geometry::{Geometry, lines};
use cortex_ar::asm::{dsb, isb};
use cortex_ar::register::{BpIAll, Ccsidr, Csselr, Dccimvac, Dccisw, Dccmvac, Dcimvac, Dcisw, SysReg, SysRegWrite};

/// ICIALLU: invalidates all of the instruction cache.
struct InvalidateInstructions;

impl SysReg for InvalidateInstructions {
    const CP: u32 = 15;
    const CRN: u32 = 7;
    const OP1: u32 = 0;
    const CRM: u32 = 5;
    const OP2: u32 = 0;
}

impl SysRegWrite for InvalidateInstructions {}

/// Reads the L1 data cache's shape.
#[must_use]
pub fn data_cache_geometry() -> Geometry {
    // SAFETY: selects the L1 data cache for the read of CCSIDR; nothing else here uses CSSELR.
    unsafe { <Csselr as SysRegWrite>::write_raw(0) };
    isb();
    Geometry::from_ccsidr(Ccsidr::read().raw_value())
}

/// Invalidates the instruction cache and the branch predictor.
pub fn invalidate_instructions() {
    // SAFETY: drops copies of instructions, which are fetched anew from memory.
    unsafe { InvalidateInstructions::write_raw(0) };
    BpIAll::write();
    dsb();
    isb();
}

/// Invalidates the L1 data cache, dropping what was written and not yet cleaned.
///
/// # Safety
/// The cache is off and holds nothing that memory lacks, as after reset or after `_start`.
pub unsafe fn invalidate_data() {
    let geometry = data_cache_geometry();
    for set in 0..geometry.sets {
        for way in 0..geometry.ways {
            // SAFETY: the caller vouches that no line holds anything that is needed.
            unsafe { Dcisw::write(Dcisw(geometry.set_way(set, way))) };
        }
    }
    dsb();
}

/// Writes all of the L1 data cache back to the next level and empties it.
pub fn clean_and_invalidate_data() {
    let geometry = data_cache_geometry();
    for set in 0..geometry.sets {
        for way in 0..geometry.ways {
            // SAFETY: writes a line back; no data is lost.
            unsafe { Dccisw::write(Dccisw(geometry.set_way(set, way))) };
        }
    }
    dsb();
}

/// Writes the lines of a range back to the next level; they stay valid.
/// For memory that a device is going to read.
pub fn clean(address: u32, bytes: u32) {
    for line in lines(address, bytes) {
        // SAFETY: writes a line back; no data is lost.
        unsafe { <Dccmvac as SysRegWrite>::write_raw(line) };
    }
    dsb();
}

/// Writes the lines of a range back to the next level and drops them.
/// For memory that a device is going to read and to write.
pub fn clean_and_invalidate(address: u32, bytes: u32) {
    for line in lines(address, bytes) {
        // SAFETY: writes a line back before it is dropped; no data is lost.
        unsafe { <Dccimvac as SysRegWrite>::write_raw(line) };
    }
    dsb();
}

/// Drops the lines of a range, with what was written to them. For memory that a device wrote.
///
/// # Safety
/// Nothing else lies in the lines that the range touches: it starts and ends on a line (32 bytes),
/// and what the processor wrote there last may be lost.
pub unsafe fn invalidate(address: u32, bytes: u32) {
    for line in lines(address, bytes) {
        // SAFETY: the caller vouches for the lines.
        unsafe { <Dcimvac as SysRegWrite>::write_raw(line) };
    }
    dsb();
}
