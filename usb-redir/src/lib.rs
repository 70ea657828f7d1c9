//! Plugs a model of a USB device into QEMU.
//!
//! QEMU's device `usb-redir` speaks the usbredir protocol (0.7) over a socket: whoever answers there
//! is a USB device to the machine. Here answers any [`Device`](usb_model::wire::Device) of `usb-model`.
//!
//! | module | its one idea |
//! | --- | --- |
//! | [`Socket`] | a Unix socket where devices are plugged in and out |
//! | `host` | transfers to a device: what a host controller and its driver make of transactions |
//! | `descriptors` | the interfaces and endpoints that a device's descriptors name |
//! | `packet`, `connection` | the protocol's packets, and reading and writing them |
//! | `session`, `plugged` | one conversation with QEMU; a device that QEMU has |
//!
//! ```no_run
//! # fn device() -> Box<dyn usb_model::wire::Device + Send> { unimplemented!() }
//! use std::path::Path;
//! use usb_redir::Socket;
//!
//! let socket = Socket::bind(Path::new("/tmp/pad"))?;
//! // qemu-system-arm -M raspi2b … -chardev socket,id=pad,path=/tmp/pad -device usb-redir,chardev=pad
//! socket.plug_in(device());
//! # Ok::<(), std::io::Error>(())
//! ```
#![forbid(unsafe_code)]

mod connection;
mod descriptors;
mod host;
mod packet;
mod plugged;
mod session;
mod socket;

pub use socket::Socket;
