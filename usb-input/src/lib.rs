//! Keyboards and pads on a USB host controller: enumeration, hubs, HID, and what `controls` takes.
//!
//! Works over any controller that implements `embassy-usb-driver`'s host traits. No heap, no
//! executor: a main loop or a timer's interrupt polls it.
//!
//! ```no_run
//! # use embassy_usb_driver::host::UsbHostController;
//! # fn example<'d>(controller: impl UsbHostController<'d>, clock: impl usb_input::Clock) {
//! use core::pin::pin;
//! use usb_input::{Config, Memory, Merge, UsbInput};
//!
//! let mut controls = controls::Controls::new(controls::Config::default());
//! let memory = Memory::new(Config::default());
//! let bus = pin!(usb_input::run(controller, clock, &memory));
//! let mut usb = UsbInput::new(bus, &memory);
//! let mut merge = Merge::default();
//! loop {
//!     usb.poll(); // once a millisecond, say
//!     while let Some(event) = usb.next_event() {
//!         if let Some(report) = merge.report(&event) {
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

mod bring_up;
mod carrier;
mod clock;
mod config;
mod descriptor;
mod dualshock3;
mod dualshock4;
mod ear;
mod event;
mod fallback;
mod fault;
mod hid;
mod hub;
mod identity;
mod input;
mod link;
mod mailbox;
mod memory;
mod merge;
mod place;
mod reader;
mod root;
mod route;
mod run;
mod setup;
mod slots;
mod stack;
mod talk;
mod text;
mod timing;
mod usb_input;

pub use clock::Clock;
pub use config::Config;
pub use event::Event;
pub use fallback::Fallback;
pub use fault::{Fault, Step};
pub use hub::HUB_PORTS_MAXIMUM;
pub use identity::{Identity, Kind};
pub use memory::Memory;
pub use merge::Merge;
pub use place::Place;
pub use run::run;
pub use slots::DEVICES_MAXIMUM;
pub use text::Text;
pub use timing::SETTLED_WITHIN_US;
pub use usb_input::UsbInput;
