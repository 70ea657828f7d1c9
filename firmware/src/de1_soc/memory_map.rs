//! Where everything is on the Cyclone V's processor side, as U-Boot leaves it.
//!
//! Sources: the base addresses of U-Boot's `base_addr_ac5.h` and Intel's `hps.h`; clocks as
//! U-Boot's SPL sets them on this board; interrupts of Intel's `alt_int_device.h`. The FPGA's
//! side is in [`fpga_regs::de1_soc`].

use crate::armv7a::translation_table::{Memory, Region};
use crate::cortex_a9::Cluster;
use crate::cortex_a9::gic::InterruptId;

/// The processor cluster. PERIPHCLK is a quarter of the processor's 800 MHz.
pub const CLUSTER: Cluster =
    Cluster { private_region: 0xFFFE_C000, l2_cache_controller: 0xFFFE_F000, timer_hertz: 200_000_000 };

/// The FPGA manager: what the FPGA does, and its configuration.
pub const FPGA_MANAGER: usize = 0xFF70_6000;
/// GPIO1: the pins HPS_GPIO29 to HPS_GPIO57.
pub const GPIO1: usize = 0xFF70_9000;
/// The L3 interconnect's global view: its first register, REMAP, opens the bridges' windows.
pub const INTERCONNECT: usize = 0xFF80_0000;
/// Where the FPGA manager takes the words of an FPGA image.
pub const FPGA_IMAGE_SINK: usize = 0xFFB9_0000;
/// USB1: the host controller behind the board's two connectors.
pub const USB: usize = 0xFFB4_0000;
/// UART0: a DesignWare 16550, console and link in one.
pub const UART: usize = 0xFFC0_2000;
/// The first of the two L4 watchdogs.
pub const WATCHDOG: usize = 0xFFD0_2000;
/// The reset manager.
pub const RESET_MANAGER: usize = 0xFFD0_5000;
/// The system manager.
pub const SYSTEM_MANAGER: usize = 0xFFD0_8000;

/// Clock of the UARTs (l4_sp), in hertz.
pub const UART_HERTZ: u32 = 100_000_000;
/// Clock of the L4 watchdogs (osc1), in hertz.
pub const WATCHDOG_HERTZ: u32 = 25_000_000;

/// The rasterizer's interrupt.
pub const FPGA_INTERRUPT: InterruptId = InterruptId(fpga_regs::de1_soc::INTERRUPT as u16);
/// USB1's interrupt.
pub const USB_INTERRUPT: InterruptId = InterruptId(160);
/// UART0's interrupt.
pub const UART_INTERRUPT: InterruptId = InterruptId(194);

/// Bit of GPIO1 that lights the HPS's LED (HPS_GPIO53).
pub const LED_BIT: u32 = 24;
/// Bit of GPIO1 that reads 0 while the HPS's key is pressed (HPS_GPIO54).
pub const KEY_BIT: u32 = 25;

/// Where the USB host controller reads and writes.
pub const USB_MEMORY: usize = 0x0700_0000;
/// First byte of where U-Boot may leave files for the program: an FPGA image, a mesh file.
pub const FPGA_IMAGE: u32 = 0x0800_0000;
/// One more than its last.
pub const FPGA_IMAGE_END: u32 = 0x1000_0000;

/// What the MMU maps; the linker's view is `memory.x`.
///
/// The FPGA's windows are mapped although nothing may answer there: an access before the FPGA is
/// configured and the bridge is open hangs the bus, and no table can prevent that.
pub const REGIONS: &[Region] = &[
    Region { start: 0x0100_0000, sections: 16, memory: Memory::Code },
    Region { start: 0x0280_0000, sections: 64, memory: Memory::Data },
    // The stack guard, 8 MiB below the end of the data.
    Region { start: 0x0600_0000, sections: 1, memory: Memory::Fault },
    // What a bus master reads and writes itself, past the caches.
    Region { start: 0x0700_0000, sections: 1, memory: Memory::Uncached },
    Region { start: FPGA_IMAGE, sections: (FPGA_IMAGE_END - FPGA_IMAGE) >> 20, memory: Memory::Constants },
    // The HPS-to-FPGA bridge: of its 960 MiB the one that has the FIFO aperture.
    Region { start: 0xC000_0000, sections: 1, memory: Memory::Device },
    // The lightweight bridge (2 MiB at 0xFF200000), peripherals, on-chip RAM.
    Region { start: 0xFF20_0000, sections: 14, memory: Memory::Device },
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::armv7a::translation_table::TranslationTable;

    static TRANSLATION_TABLE: TranslationTable = TranslationTable::new(REGIONS);

    #[test]
    fn what_the_program_touches_is_mapped_and_its_guard_is_not() {
        for address in [FPGA_MANAGER, INTERCONNECT, FPGA_IMAGE_SINK, USB, USB_MEMORY, UART, RESET_MANAGER] {
            assert!(!TRANSLATION_TABLE.is_hole(address as u32), "{address:#x}");
        }
        for address in [fpga_regs::de1_soc::REGISTERS, fpga_regs::de1_soc::FIFO_APERTURE, FPGA_IMAGE_END as usize - 1] {
            assert!(!TRANSLATION_TABLE.is_hole(address as u32), "{address:#x}");
        }
        for address in [0, 0x0080_0000, 0x0210_0000, 0x0600_0000, 0x0680_0000, FPGA_IMAGE_END, 0xC010_0000] {
            assert!(TRANSLATION_TABLE.is_hole(address), "{address:#x}");
        }
    }
}
