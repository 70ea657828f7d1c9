//! The application, once, and one thin module per board.
//!
//! | module | what it holds |
//! | --- | --- |
//! | [`app`] | the application: controllers in, frames out |
//! | [`viewer`], [`act`], [`scene`], [`style`], [`legend`] | what there is to look at: the crate `scenes` |
//! | [`frame`] | one frame: a stage to packets, and these to the FPGA |
//! | [`inbox`], [`hush`] | bytes that were read and not looked at yet; complaints, one a second |
//! | [`intake`] | what controllers say, taken in and tallied |
//! | [`left_in_memory`] | what somebody left in memory before the start |
//! | [`link`] | messages between a board and a PC |
//! | [`board`] | what the application asks of a board |
//! | [`armv7a`] | what every board shares: start-up, MMU, L1 caches, fault reports |
//! | [`cortex_a9`] | what every Cortex-A9 shares: its start, L2 cache, GIC, timers |
//! | `cortex_a7` | the Cortex-A7's start |
//! | [`vexpress_a9`] | QEMU's vexpress-a9: keyboard, display, log |
//! | [`raspi2b`] | QEMU's raspi2b: timer, interrupts, display, USB |
//! | [`de1_soc`] | the DE1-SoC: its start, the way to its FPGA, its console, keys and lights |
//! | [`software_fpga`] | the FPGA's stand-in on a board that has none |
//! | [`serial`], [`pl011`] | serial lines, and a UART for them |
//! | `usb` | keyboards and pads on a DWC2 host controller |
//! | [`ps2`] | PS/2 scan codes to USB keyboard reports |
//! | [`mmio`] | typed access to memory-mapped registers |
//!
//! All that touches no processor instruction builds and is tested on the host.

#![no_std]

#[cfg(any(
    all(feature = "vexpress-a9", feature = "de1-soc"),
    all(feature = "vexpress-a9", feature = "raspi2b"),
    all(feature = "raspi2b", feature = "de1-soc")
))]
compile_error!("of the features `vexpress-a9`, `raspi2b` and `de1-soc` each names a board: choose one");

pub mod app;
pub mod armv7a;
pub mod board;
#[cfg(target_arch = "arm")]
pub mod cortex_a7;
pub mod cortex_a9;
pub mod de1_soc;
pub mod frame;
pub mod hush;
pub mod inbox;
pub mod intake;
pub mod left_in_memory;
pub mod link;
pub mod mmio;
pub mod pl011;
pub mod ps2;
pub mod raspi2b;
pub mod serial;
pub mod software_fpga;
#[cfg(all(target_arch = "arm", feature = "usb"))]
pub mod usb;
pub mod vexpress_a9;

pub use scenes::{act, legend, scene, style, viewer};
