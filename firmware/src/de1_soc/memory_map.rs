//! Where everything is on the Cyclone V's processor side, as U-Boot leaves it.
//!
//! Sources: the base addresses of U-Boot's `base_addr_ac5.h` and Intel's `hps.h`; clocks as
//! U-Boot's SPL sets them on this board.

use crate::armv7a::translation_table::{Memory, Region, TranslationTable};
use crate::cortex_a9::Cluster;

/// The processor cluster. PERIPHCLK is a quarter of the processor's 800 MHz.
pub const CLUSTER: Cluster =
    Cluster { private_region: 0xFFFE_C000, l2_cache_controller: 0xFFFE_F000, timer_hertz: 200_000_000 };

/// UART0: the console's DesignWare 16550.
pub const CONSOLE: usize = 0xFFC0_2000;
/// Clock of the UARTs (l4_sp), in hertz.
pub const UART_HERTZ: u32 = 100_000_000;

/// What the MMU maps; the linker's view is `memory.x`.
///
/// The FPGA's windows are mapped although nothing may answer there: an access before the FPGA is
/// configured and the bridge is open hangs the bus, and no table can prevent that.
pub static TRANSLATION_TABLE: TranslationTable = TranslationTable::new(&[
    Region { start: 0x0100_0000, sections: 16, memory: Memory::Code },
    Region { start: 0x0280_0000, sections: 64, memory: Memory::Data },
    // The stack guard, 8 MiB below the end of the data.
    Region { start: 0x0600_0000, sections: 1, memory: Memory::Fault },
    // The HPS-to-FPGA bridge: the first of its 960 MiB.
    Region { start: 0xC000_0000, sections: 16, memory: Memory::Device },
    // The lightweight bridge (2 MiB at 0xFF200000), peripherals, on-chip RAM.
    Region { start: 0xFF20_0000, sections: 14, memory: Memory::Device },
]);
