//! The DE1-SoC on a PC: runs the unmodified image, at its true addresses, in the state that
//! U-Boot's `go` leaves, with the FPGA as a software model or as verilated SystemVerilog.
//!
//! | module | holds |
//! | --- | --- |
//! | [`machine`] | [`PowerOn`] makes a [`Machine`]: running, restarting, pictures |
//! | [`image`] | the program, from an ELF file or a raw binary |
//! | [`cpu`] | the processor, behind a trait |
//! | [`bus`], [`memory`] | what the processor sees |
//! | [`cache`] | what the caches may hold, and what goes wrong by it |
//! | [`devices`] | every block of registers |
//! | [`fpga`] | the FPGA's design, behind a trait |
//! | [`time`] | virtual time |
//! | [`remote`], `live` | a machine that another program orders about; one in a window (feature `window`) |
//! | [`violation`] | why a run was stopped |
//!
//! An access to something that is not modelled, held in reset, without a clock or behind a closed
//! bridge ends the run with a [`Violation`]: no such access has a result that a program may rely on.

pub mod bus;
pub mod cache;
pub mod cpu;
pub mod devices;
pub mod fpga;
#[cfg(any(test, all(feature = "window", target_os = "linux")))]
mod gamepad_mapping;
pub mod image;
#[cfg(feature = "window")]
pub mod live;
pub mod machine;
pub mod memory;
pub mod remote;
pub mod time;
pub mod violation;

pub use image::Image;
pub use machine::{Event, Machine, PowerOn};
pub use violation::Violation;
