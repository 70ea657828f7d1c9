//! A USB bus on a PC: devices, a hub and a host controller that forgive nothing.
//!
//! | module | holds |
//! | --- | --- |
//! | [`wire`] | what goes over the wire: tokens, handshakes, and [`Device`](wire::Device), which answers them |
#![forbid(unsafe_code)]

pub mod wire;
