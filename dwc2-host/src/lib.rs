//! USB host driver for the Synopsys DWC2 ("OTG") core in buffer-DMA mode.
//!
//! It implements the host traits of `embassy-usb-driver`; enumeration, hubs and classes are a stack's matter above it.
//! It stands on three small traits of the board's ([`Registers`], [`DmaMemory`], [`Clock`]) and on nothing else:
//! no allocator, no executor, no `unsafe`. The core must be out of reset, with its PHY clocked, before the first call.
//!
//! It does control, bulk and interrupt transfers, one packet of interrupt data a request, with low-, full- and
//! high-speed devices, directly or through hubs: by split transactions behind a high-speed hub with one transaction
//! translator, by preambles behind a full-speed one. It does not do isochronous transfers, high-bandwidth endpoints,
//! suspend and resume, or the device's role. Nor does it talk to hubs: a control or bulk transfer by splits that fails,
//! but for STALL, may leave its translator's buffer taken, and the stack sends the hub CLEAR_TT_BUFFER before the
//! endpoint's next transfer (USB 2.0 §11.24.2.3).
//!
//! # How it runs
//!
//! [`Dwc2::on_interrupt`] and [`Dwc2::poll`] take what the core reports, go on with every transfer and with the root
//! port, and wake whoever waits. Neither ever waits. Call `poll` at 1 kHz (time-outs, the port's delays and the turns
//! of slow endpoints live on it), and `on_interrupt` from the core's interrupt. The start of a frame interrupts only while
//! somebody waits for one: least often where `poll` comes in the first microframes of a frame, which start splits go
//! out in.
//!
//! Without the interrupt everything works but interrupt endpoints behind a transaction translator: their complete splits are
//! due within microframes. A board without it takes [`SpeedLimit::Full`].
//!
//! The futures only watch, so any executor serves, and so does a main loop that polls them with a waker that does nothing.
#![no_std]
#![forbid(unsafe_code)]

mod board;
mod channels;
mod config;
mod driver;
mod endpoint;
mod error;
mod hardware;
mod outcome;
mod pipe;
mod port;
mod registers;
mod slot;
mod start;
mod state;
mod timing;
mod transfer;
mod word;

pub use crate::board::{Board, Clock, DmaMemory, LINE_BYTES, Registers};
pub use crate::config::{Config, SpeedLimit};
pub use crate::driver::{Allocator, Controller, Dwc2};
pub use crate::error::{Fault, TransferError};
pub use crate::pipe::Pipe;

/// Pipes that can be allocated at once.
pub const PIPES: usize = 16;
/// Bytes that one pipe has for its data: a packet of any speed, or several.
pub const PIPE_BUFFER_BYTES: usize = 512;
/// Bytes of DMA memory that the driver needs: for each pipe its data, and a SETUP packet on a line of its own.
pub const DMA_BYTES: usize = PIPES * (PIPE_BUFFER_BYTES + LINE_BYTES);
