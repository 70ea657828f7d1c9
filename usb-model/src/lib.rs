//! A USB bus on a PC: devices, a hub and a host controller that forgive nothing.
//!
//! | module | holds |
//! | --- | --- |
//! | [`wire`] | what goes over the wire: tokens, handshakes, and [`Device`](wire::Device), which answers them |
//! | [`leaf`] | a device with one configuration: endpoint 0, toggles, the waits that a host owes it |
//! | [`keyboard`] | keyboards: boot, a bit for each key, a list of keys |
//! | [`dualshock3`], [`dualshock4`], [`gamepad`] | pads |
//! | [`storage`] | a memory stick, for anything that is no input device |
//! | [`rogue`] | a device that goes wrong: silent, refusing, babbling, garbling, from a transaction on |
//! | [`mutate`] | descriptors that are wrong |
//! | [`simple_hub`] | a hub that passes tokens on, and watches that they come with the right split |
//! | [`ideal_host`] | a host controller with nothing behind it: `embassy-usb-driver`'s traits over a device |
//! | [`random`] | random numbers that are the same in every run |
#![forbid(unsafe_code)]

pub mod dualshock3;
pub mod dualshock4;
pub mod gamepad;
pub mod ideal_host;
pub mod keyboard;
pub mod leaf;
pub mod mutate;
pub mod random;
pub mod rogue;
pub mod simple_hub;
pub mod storage;
pub mod wire;
