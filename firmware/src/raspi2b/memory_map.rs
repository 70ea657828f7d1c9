//! Where everything is (Broadcom, "BCM2835 ARM Peripherals"; the BCM2836 has the same peripherals,
//! their bus addresses 0x7Ennnnnn at 0x3Fnnnnnn).
//!
//! Code and data lie where the DE1-SoC has them: `memory.x` as it is.

use super::interrupt_controller::Interrupt;
use crate::armv7a::translation_table::{Memory, Region, TranslationTable};

/// The system timer: 1 MHz.
pub const SYSTEM_TIMER: usize = 0x3F00_3000;
/// The interrupt controller.
pub const INTERRUPT_CONTROLLER: usize = 0x3F00_B200;
/// The mailboxes to the GPU.
pub const MAILBOX: usize = 0x3F00_B880;
/// UART0: the link's PL011.
pub const LINK: usize = 0x3F20_1000;
/// The auxiliary block, with the console's mini UART.
pub const AUXILIARY: usize = 0x3F21_5000;
/// The USB host controller.
pub const USB: usize = 0x3F98_0000;

/// Clock of UART0, in hertz.
pub const LINK_HERTZ: u32 = 48_000_000;
/// Clock of the mini UART, the GPU's core clock, in hertz.
pub const CONSOLE_HERTZ: u32 = 250_000_000;

/// The system timer's second comparator; the GPU has the first and the third.
pub const TIMER_INTERRUPT: Interrupt = Interrupt(1);
/// The USB host controller's.
pub const USB_INTERRUPT: Interrupt = Interrupt(9);
/// UART0's.
pub const LINK_INTERRUPT: Interrupt = Interrupt(57);

/// Where messages to the GPU are written: uncached, for it reads the SDRAM itself.
pub const MAILBOX_MESSAGE: usize = 0x0700_0000;
/// Where the USB host controller reads and writes.
pub const USB_MEMORY: usize = 0x0701_0000;
/// First byte of what the GPU keeps for itself, the framebuffer among it.
pub const GPU_MEMORY: usize = 0x3C00_0000;
/// One more than its last.
pub const GPU_MEMORY_END: usize = 0x3F00_0000;

/// Where a mesh file may be left before the start, and the end of the room for it.
pub const MESH_FILE: core::ops::Range<usize> = 0x0800_0000..0x0800_0000 + (128 << 20);

/// What the MMU maps; the linker's view is `memory.x`.
pub static TRANSLATION_TABLE: TranslationTable = TranslationTable::new(&[
    Region { start: 0x0100_0000, sections: 16, memory: Memory::Code },
    Region { start: 0x0280_0000, sections: 64, memory: Memory::Data },
    // The stack guard, 8 MiB below the end of the data.
    Region { start: 0x0600_0000, sections: 1, memory: Memory::Fault },
    // What devices read and write themselves.
    Region { start: 0x0700_0000, sections: 1, memory: Memory::Uncached },
    Region { start: MESH_FILE.start as u32, sections: 128, memory: Memory::Constants },
    Region { start: 0x3C00_0000, sections: 48, memory: Memory::Uncached },
    Region { start: 0x3F00_0000, sections: 16, memory: Memory::Device },
]);
