//! Keyboards and pads on a DWC2 host controller, served by interrupts.
//!
//! | file | what it holds |
//! | --- | --- |
//! | `service` | driver and bus as the interrupt handler and the main loop see them |
//! | `take_in` | what a frame takes in: news told, reports merged and accepted |
//! | `dwc2` | what the driver asks of a board: registers, DMA memory, a clock |
//! | `forever` | room for a value that stays |
//! | `words` | what the bus tells, for a person |
//!
//! The board's timer interrupt calls [`Service::tick`] a thousand times a second, the controller's
//! [`Service::on_interrupt`]; so neither a long frame holds the bus up nor the bus a frame. The main
//! loop takes events when it likes.

mod dwc2;
mod forever;
mod service;
mod take_in;
mod words;

pub use dwc2::{Dwc2Core, Now};
pub use forever::Forever;
pub use service::{Config, News, Room, Service};
pub use take_in::{Taken, take_in};

/// How often [`Service::tick`] is to be called, in microseconds.
pub const TICK_MICROSECONDS: u64 = 1_000;
