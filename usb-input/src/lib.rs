//! Keyboards and pads on a USB host controller: enumeration, hubs, HID, and what `controls` takes.
//!
//! Works over any controller that implements `embassy-usb-driver`'s host traits. No heap, no
//! executor: a main loop or a timer's interrupt polls it.
//!
//! ```no_run
//! # use embassy_usb_driver::host::UsbHostController;
//! # fn example<'d>(controller: impl UsbHostController<'d>, clock: impl usb_input::Clock) {
//! use core::pin::pin;
//! use usb_input::{Config, Memory, UsbInput};
//!
//! let mut controls = controls::Controls::new(controls::Config::default());
//! let memory = Memory::new(Config::default());
//! let bus = pin!(usb_input::run(controller, clock, &memory));
//! let mut usb = UsbInput::new(bus, &memory);
//! loop {
//!     usb.poll(); // once a millisecond, say
//!     while let Some(event) = usb.next_event() {
//!         if let Some(report) = event.report() {
//!             let _ = controls.accept(report);
//!         } // else: for the console
//!     }
//! }
//! # }
//! ```
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod clock;
mod config;
mod event;
mod fault;
mod identity;
mod memory;
mod place;
mod run;
mod usb_input;

pub use clock::Clock;
pub use config::Config;
pub use event::Event;
pub use fault::{Fault, Step};
pub use identity::{Identity, Kind, TEXT_BYTES};
pub use memory::Memory;
pub use place::Place;
pub use run::run;
pub use usb_input::UsbInput;

/// Ports of a hub that are served, from port 1 on.
pub const HUB_PORTS_MAXIMUM: u8 = 8;
