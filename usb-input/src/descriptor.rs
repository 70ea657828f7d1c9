//! What a device's descriptors say. Nothing here trusts a length, a count or an order.

mod configuration;
mod device;
mod text;

pub(crate) use configuration::{Configuration, Endpoint, HidInterface, PACKET_MAXIMUM};
pub(crate) use device::Device;
pub(crate) use text::{STRING_BYTES, language, text};
