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
#![forbid(unsafe_code)]

pub mod dwc2;
pub mod faulty;
pub mod hub;
pub mod memory;
pub mod shared;
pub mod split;
pub mod violation;
pub mod wire;
