//! QEMU's vexpress-a9: a Cortex-A9 with serial lines, a PS/2 keyboard and a display.
//!
//! | line | use |
//! | --- | --- |
//! | UART0 | console: text for people |
//! | UART1 | link: bytes to and from another program |
//! | UART2 | log: defmt frames (rzCOBS) |
//!
//! Not supported: the real Versatile Express's clock generators, which QEMU runs without.

#[cfg(all(target_arch = "arm", feature = "vexpress-a9"))]
mod board;
#[cfg(all(target_arch = "arm", feature = "vexpress-a9"))]
mod interrupts;
pub mod leds;
#[cfg(all(target_arch = "arm", feature = "vexpress-a9"))]
mod log;
pub mod memory_map;
pub mod pl050;
pub mod pl111;
#[cfg(all(target_arch = "arm", feature = "vexpress-a9"))]
pub mod viewer;

#[cfg(all(target_arch = "arm", feature = "vexpress-a9"))]
pub use board::{Board, exit};
#[cfg(all(target_arch = "arm", feature = "vexpress-a9"))]
pub use interrupts::{ticks, unexpected_interrupts};
