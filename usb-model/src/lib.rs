//! A USB bus on a PC: devices, a hub and a host controller that forgive nothing.
//!
//! | module | holds |
//! | --- | --- |
//! | [`wire`] | what goes over the wire: tokens, handshakes, and [`Device`](wire::Device), which answers them |
//! | [`split`] | split transactions, and [`Translator`](split::Translator), which a high-speed hub is |
//! | [`hub`] | a hub: four ports, power, changes, reset, a transaction translator |
//! | [`faulty`] | a device that misbehaves at a chosen moment |
//! | [`shared`] | a device that the bus and a test hold at once |
//! | [`dwc2`] | the DWC2 core, strict: registers in, transactions out |
//! | [`memory`] | memory between caches and DMA, strict |
//! | [`violation`] | the rules, and the record of those that were broken |
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
pub mod dwc2;
pub mod faulty;
pub mod gamepad;
pub mod hub;
pub mod ideal_host;
pub mod keyboard;
pub mod leaf;
pub mod memory;
pub mod mutate;
pub mod random;
pub mod rogue;
pub mod shared;
pub mod simple_hub;
pub mod split;
pub mod storage;
pub mod violation;
pub mod wire;
