//! QEMU's raspi2b: the Cortex-A7 of a Raspberry Pi 2, with the DE1-SoC's USB host controller.
//!
//! | line | use |
//! | --- | --- |
//! | mini UART | console: text for people |
//! | UART0 | link: bytes to and from another program |
//!
//! Not supported: the real Raspberry Pi 2, whose pins and clocks QEMU runs without and whose
//! firmware starts the cores in hypervisor mode.

#[cfg(all(target_arch = "arm", feature = "raspi2b"))]
mod board;
pub mod framebuffer;
pub mod interrupt_controller;
#[cfg(all(target_arch = "arm", feature = "raspi2b"))]
mod interrupts;
pub mod mailbox;
pub mod memory_map;
pub mod mini_uart;
pub mod system_timer;
#[cfg(all(target_arch = "arm", feature = "raspi2b"))]
pub mod viewer;

#[cfg(all(target_arch = "arm", feature = "raspi2b"))]
pub use board::{Board, exit};
