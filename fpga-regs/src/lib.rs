//! What software and the FPGA agree on, written once.
//!
//! | module | holds |
//! | --- | --- |
//! | [`registers`] | the register block, its offsets and fields |
//! | [`packet`] | the command packets that travel in the FIFO, word by word |
//! | [`screen`] | sizes and number formats that both sides hard-code |
//! | [`port`] | the seam between the driver and the bridge ([`Port`]) |
//! | [`board_io`] | the board's keys, switches, lights and displays, an agent of their own |
//! | [`de1_soc`] | where the DE1-SoC's FPGA has all of this |
//! | [`mmio`] | the bridge itself ([`MmioPort`]); the only `unsafe` of this crate |
//! | [`renderer`] | the driver: identity check, flow control, time-outs, recovery |
//! | [`layout`] | the tables that `cargo xtask generate` turns into a page and SystemVerilog packages |
//! | `mock` | a host stand-in with a journal (feature `mock`) |
//!
//! The registers are 32 bits wide and little-endian. Commands do not go through them: they are
//! packets of 32-bit words, written anywhere in the FIFO's address aperture, in order.
#![cfg_attr(not(any(test, feature = "mock")), no_std)]
#![deny(unsafe_code)]

pub mod error;
#[macro_use]
pub mod layout;
pub mod board_io;
pub mod de1_soc;
pub mod mmio;
#[cfg(any(test, feature = "mock"))]
pub mod mock;
pub mod packet;
pub mod port;
pub mod registers;
pub mod renderer;
pub mod screen;

pub use error::RenderError;
pub use mmio::MmioPort;
pub use port::{Port, Wait};
pub use renderer::{Counters, Renderer, Timeouts};
