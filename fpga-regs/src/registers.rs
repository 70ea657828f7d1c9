//! The register block on the lightweight HPS-to-FPGA bridge.
//!
//! Offsets are from the start of the agent, which is 0xFF20_0000 on the DE1-SoC. The tables on
//! the generated page `docs/registers.md` come from here.

pub use crate::layout::{Access, RegisterInfo};

/// What ID reads: "HALF" in ASCII, most significant byte first.
pub const ID_HALF: u32 = 0x4841_4c46;
/// The contract's major version: it changes when old software cannot drive new hardware.
pub const VERSION_MAJOR: u16 = 1;
/// The contract's minor version: it grows with every compatible addition.
pub const VERSION_MINOR: u16 = 0;

word! {
    /// VERSION: the contract that this FPGA was built to.
    Version {
        /// Minor version; grows with compatible additions.
        minor / with_minor: [15:0] u16,
        /// Major version; software refuses any but its own.
        major / with_major: [31:16] u16,
    }
}

word! {
    /// CAPABILITIES: what this build of the FPGA has.
    Capabilities {
        /// FIFO depth in words, at least twice the longest packet's.
        fifo_depth / with_fifo_depth: [15:0] u16,
        /// Pixel units: pixels drawn a clock at most.
        pixel_units / with_pixel_units: [23:16] u8,
        /// Whether the low-water interrupt is wired to the processor.
        interrupt / with_interrupt: [24:24] bool,
    }
}

word! {
    /// SCREEN: the framebuffer's size.
    Screen {
        /// Width in pixels.
        width / with_width: [15:0] u16,
        /// Height in pixels.
        height / with_height: [31:16] u16,
    }
}

word! {
    /// CONTROL: what the device is allowed to do.
    Control {
        /// Takes words from the FIFO. While 0 the FIFO fills and nothing is drawn; a packet of which some words have come waits for the others.
        enable / with_enable: [0:0] bool,
        /// Empties the FIFO, forgets the packet under way, clears LOW_WATER, INTERRUPTS, ERRORS, FENCE and all counters; reads 1 until done. The buffers keep their pixels and the front one stays in front; a triangle or clear under way may stay half drawn. The other bits of the same write take effect after it.
        reset / with_reset: [1:1] bool,
        /// Interrupt when the FIFO's level falls to LOW_WATER.
        low_water_interrupt / with_low_water_interrupt: [8:8] bool,
        /// Interrupt when a swap took place.
        swap_interrupt / with_swap_interrupt: [9:9] bool,
        /// Interrupt when a fence was passed.
        fence_interrupt / with_fence_interrupt: [10:10] bool,
        /// Interrupt on any bit of ERRORS.
        error_interrupt / with_error_interrupt: [11:11] bool,
    }
}

word! {
    /// STATUS: one read answers what the driver needs to go on.
    Status {
        /// Words the FIFO takes before it is full.
        fifo_free / with_fifo_free: [15:0] u16,
        /// A packet is under way, one that still lacks words included, or the FIFO holds words.
        busy / with_busy: [16:16] bool,
        /// The buffer that VGA shows: 0 or 1.
        front_buffer / with_front_buffer: [17:17] bool,
        /// VGA is in its vertical blank.
        vertical_blank / with_vertical_blank: [18:18] bool,
        /// A swap waits for the vertical blank.
        swap_pending / with_swap_pending: [19:19] bool,
        /// Some bit of ERRORS is set.
        error / with_error: [20:20] bool,
        /// The stream stands inside a packet: its header has come, not yet all of its words.
        mid_packet / with_mid_packet: [21:21] bool,
    }
}

word! {
    /// INTERRUPTS: what has happened; write one to clear.
    Interrupts {
        /// The FIFO's level fell to LOW_WATER.
        low_water / with_low_water: [0:0] bool,
        /// A swap took place.
        swap / with_swap: [1:1] bool,
        /// A fence was passed.
        fence / with_fence: [2:2] bool,
        /// Something that ERRORS flags happened, whether or not its flag was set already.
        error / with_error: [3:3] bool,
    }
}

word! {
    /// ERRORS: what went wrong since they were last cleared; write one to clear.
    Errors {
        /// A packet of unknown kind, wrong length, with a reserved bit set or a box outside the screen. It was skipped by its length.
        bad_packet / with_bad_packet: [0:0] bool,
        /// A word came while the FIFO was full and the device disabled, or had waited at the full FIFO for 2^22 clocks of the bus, or came after such a one before the FIFO had space again; it was dropped.
        fifo_overflow / with_fifo_overflow: [1:1] bool,
    }
}

registers! {
    /// The registers as they lie in memory.
    ///
    /// Never made: a [`MmioPort`](crate::MmioPort) points at the real one.
    RegisterBlock
    /// A register by name; the discriminant is its byte offset.
    Register REGISTERS;
    /// Identity: reads 0x48414C46, "HALF". Checked before anything else is touched.
    0x00 ID Id id: RO ReadOnly Some(ID_HALF), &[];
    /// Version of the contract.
    0x04 VERSION Version version: RO ReadOnly Some((VERSION_MAJOR as u32) << 16 | VERSION_MINOR as u32), Version::FIELDS;
    /// What this build has.
    0x08 CAPABILITIES Capabilities capabilities: RO ReadOnly None, Capabilities::FIELDS;
    /// Framebuffer size.
    0x0c SCREEN Screen screen: RO ReadOnly None, Screen::FIELDS;
    /// Enable, reset and interrupt enables.
    0x10 CONTROL Control control: RW ReadWrite Some(0), Control::FIELDS;
    /// FIFO space and state.
    0x14 STATUS Status status: RO ReadOnly None, Status::FIELDS;
    /// Low-water mark in words: when the FIFO's level falls from above it to it, the low-water interrupt is raised.
    0x18 LOW_WATER LowWater low_water: RW ReadWrite Some(0), &[];
    /// Interrupt status. A bit is set whether or not CONTROL enables its interrupt.
    0x1c INTERRUPTS Interrupts interrupts: RW WriteOneToClear Some(0), Interrupts::FIELDS;
    /// Error flags.
    0x20 ERRORS Errors errors: RW WriteOneToClear Some(0), Errors::FIELDS;
    /// The tag of the last fence that the stream passed.
    0x24 FENCE Fence fence: RO ReadOnly Some(0), &[];
    /// Triangle packets taken since reset, bad ones left out, whether or not they covered a pixel; wraps.
    0x28 TRIANGLES Triangles triangles: RO ReadOnly Some(0), &[];
    /// Pixels that triangles covered since reset, with keep_depth too, though their depth is not tested then; wraps.
    0x2c PIXELS_TESTED PixelsTested pixels_tested: RO ReadOnly Some(0), &[];
    /// Those of PIXELS_TESTED that were nearer than what was there, and with keep_depth all of them; keep_colour changes nothing in this. Since reset; wraps. Clears do not count.
    0x30 PIXELS_WRITTEN PixelsWritten pixels_written: RO ReadOnly Some(0), &[];
    /// Clocks in which a packet was under way, since reset; wraps. The software model has no clock and reads 0.
    0x34 BUSY_CYCLES BusyCycles busy_cycles: RO ReadOnly Some(0), &[];
    /// Clocks in which a swap waited for the vertical blank alone, all before it being drawn, since reset; wraps. Nothing ever waits for memory. The software model reads 0.
    0x38 STALLED_CYCLES StalledCycles stalled_cycles: RO ReadOnly Some(0), &[];
    /// Swaps that took place since reset; wraps.
    0x3c FRAMES_SHOWN FramesShown frames_shown: RO ReadOnly Some(0), &[];
    /// Bad packets since reset; wraps.
    0x40 BAD_PACKETS BadPackets bad_packets: RO ReadOnly Some(0), &[];
}

/// Bytes that the register block takes.
pub const REGISTER_BYTES: usize = core::mem::size_of::<RegisterBlock>();

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_in_offset_order_and_finds_itself() {
        for (index, register) in Register::ALL.iter().enumerate() {
            assert_eq!(REGISTERS[index].offset, index * 4);
            assert_eq!(Register::at(index * 4), Some(*register));
            assert_eq!(register.info().offset, *register as usize);
        }
        assert_eq!(Register::at(REGISTER_BYTES), None);
        assert_eq!(Register::at(2), None);
    }

    #[test]
    fn no_two_fields_of_a_register_share_a_bit() {
        for info in REGISTERS {
            let mut taken = 0u32;
            for field in info.fields {
                let mask = crate::layout::mask(field.high, field.low) << field.low;
                assert_eq!(taken & mask, 0, "{}.{}", info.name, field.name);
                taken |= mask;
            }
        }
    }

    #[test]
    fn a_status_word_reads_back_field_by_field() {
        let status = Status::default().with_fifo_free(1000).with_swap_pending(true);
        assert_eq!(status.0, 1000 | 1 << 19);
        assert_eq!((status.fifo_free(), status.swap_pending(), status.busy()), (1000, true, false));
        assert_eq!(Status(u32::MAX).with_busy(false).0, !(1 << 16));
    }
}
