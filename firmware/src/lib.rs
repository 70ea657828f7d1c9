//! The application, once, and one thin module per board.
//!
//! | module | what it holds |
//! | --- | --- |
//! | [`app`] | the application: controllers in, frames out |
//! | [`viewer`] | from what the controllers say to matrices |
//! | [`scene`] | what there is to look at |
//! | [`frame`] | one frame: a mesh to packets, and these to the FPGA |
//! | [`link`] | messages between a board and a PC |
//! | [`board`] | what the application asks of a board |
//! | [`cortex_a9`] | what every Cortex-A9 shares: start-up, MMU, caches, GIC, timers, fault reports |
//! | [`vexpress_a9`] | QEMU's vexpress-a9: serial lines, keyboard, display, log |
//! | [`de1_soc`] | the DE1-SoC: its addresses and its serial console |
//! | [`ps2`] | PS/2 scan codes to USB keyboard reports |
//! | [`mmio`] | typed access to memory-mapped registers |
//!
//! All that touches no processor instruction builds and is tested on the host.

#![no_std]

#[cfg(all(feature = "vexpress-a9", feature = "de1-soc"))]
compile_error!("features `vexpress-a9` and `de1-soc` name two boards: choose one");

pub mod app;
pub mod board;
pub mod cortex_a9;
pub mod de1_soc;
pub mod frame;
pub mod link;
pub mod mmio;
pub mod ps2;
pub mod scene;
pub mod vexpress_a9;
pub mod viewer;
