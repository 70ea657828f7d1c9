//! Where everything is (ARM DUI 0448, "CoreTile Express A9x4", and its motherboard's legacy map).

use crate::armv7a::translation_table::{Memory, Region, TranslationTable};
use crate::cortex_a9::Cluster;
use crate::cortex_a9::gic::InterruptId;
use crate::vexpress_a9::pl111::FRAME_PIXELS;

/// The processor cluster. QEMU's timers count 10 ns ticks, whatever the real board's do.
pub const CLUSTER: Cluster =
    Cluster { private_region: 0x1E00_0000, l2_cache_controller: 0x1E00_A000, timer_hertz: 100_000_000 };

/// User LEDs register, SYS_LED: eight bits.
pub const USER_LEDS: usize = 0x1000_0008;
/// KMI0: the keyboard's PL050.
pub const KEYBOARD: usize = 0x1000_6000;
/// UART0: the console's PL011.
pub const CONSOLE: usize = 0x1000_9000;
/// UART1: the link's PL011.
pub const LINK: usize = 0x1000_A000;
/// UART2: the log's PL011.
pub const LOG: usize = 0x1000_B000;
/// The core tile's PL111.
pub const DISPLAY: usize = 0x1002_0000;

/// The frames that the display reads.
pub const FRAMES: [usize; 2] = [0x6800_0000, 0x6820_0000];
const _: () = assert!(FRAMES[1] - FRAMES[0] >= FRAME_PIXELS * 4, "the frames overlap");

/// Clock of the UARTs, in hertz.
pub const UART_HERTZ: u32 = 24_000_000;
/// Clock of the keyboard interface, in hertz.
pub const KEYBOARD_HERTZ: u32 = 24_000_000;

/// UART1's interrupt.
pub const LINK_INTERRUPT: InterruptId = InterruptId(38);
/// KMI0's interrupt.
pub const KEYBOARD_INTERRUPT: InterruptId = InterruptId(44);

/// Where a mesh file may be left before the start, and the end of the room for it.
pub const MESH_FILE: core::ops::Range<usize> = 0x6900_0000..0x6900_0000 + (112 << 20);

/// What the MMU maps; the linker's view is `memory.x` with the numbers of `build.rs`.
pub static TRANSLATION_TABLE: TranslationTable = TranslationTable::new(&[
    Region { start: 0x1000_0000, sections: 1, memory: Memory::Device },
    Region { start: 0x1E00_0000, sections: 1, memory: Memory::Device },
    Region { start: 0x6000_0000, sections: 16, memory: Memory::Code },
    Region { start: 0x6100_0000, sections: 112, memory: Memory::Data },
    // The stack guard, 8 MiB below the end of the data.
    Region { start: 0x6780_0000, sections: 1, memory: Memory::Fault },
    Region { start: 0x6800_0000, sections: 4, memory: Memory::Uncached },
    Region { start: MESH_FILE.start as u32, sections: 112, memory: Memory::Constants },
]);
