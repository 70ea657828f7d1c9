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
//! # Why not embassy-usb-host
//!
//! The seam is `embassy-usb-driver`'s host traits, so that its stack runs on the same driver, and this one on others'.
//! `embassy-usb-host` 0.1.0 does not do here. `class/hub.rs` takes only hubs whose interface says protocol 0; one that
//! could have a translator for each port says 1 (USB 2.0 §11.23.1), as the DE1-SoC's USB2512B may. It takes a device's
//! speed from before the port's reset, when one of high speed looks like one of full speed (§7.1.7.5); waits for no
//! connection to settle; resets the port before it takes the lock that guards address 0; and leaves a device that failed
//! enabled there. A port that was cut off or drew too much current ends its `wait_for_event` with an error, and the other
//! changes are lost. `lib.rs` keeps the address of a device that fails at SET_ADDRESS or later, in most places. A
//! device's bytes can make it panic: a configuration descriptor whose bLength is more than its wTotalLength
//! (`descriptor.rs`), a port beyond `MAX_PORTS` (`class/hub.rs`). And it takes its time from `embassy-time`'s global
//! driver.
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
