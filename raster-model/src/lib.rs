//! The FPGA in software: takes the same words as the hardware and gives the same pixels, depths,
//! registers and counters, bit for bit.
//!
//! | module | holds |
//! | --- | --- |
//! | [`device`] | [`Device`]: registers, FIFO and the [`Port`](fpga_regs::Port) that the driver talks to |
//! | [`memory`] | [`Memory`]: the two colour buffers and the depth buffer, lent by the caller |
//! | [`decoder`] | [`MidPacket`]; words in, packets out, bad packets skipped by their length |
//! | `engine` | what each packet does |
//! | `fifo` | the words that wait while the device is disabled |
//! | `triangle` | which pixels a triangle changes |
//! | `paint` | the colour of each of them |
//! | `crossing` | where an edge cuts a row, without division |
//! | [`checksum`] | [`picture_checksum`]: one number that names a picture |
//!
//! What the model leaves out is time. It has no clock: a packet is done as soon as its last word
//! has come, a swap does not wait for the vertical blank, BUSY_CYCLES and STALLED_CYCLES read 0.
//! See [`Device`] for what that makes of each register.
//!
//! No allocation and no `unsafe`: it runs on the host in tests and in the guest on a QEMU board.
#![no_std]
#![forbid(unsafe_code)]

pub mod checksum;
mod crossing;
pub mod decoder;
pub mod device;
mod engine;
mod fifo;
pub mod memory;
mod paint;
mod triangle;

pub use checksum::picture_checksum;
pub use decoder::MidPacket;
pub use device::Device;
pub use memory::{Memory, SizeError};
