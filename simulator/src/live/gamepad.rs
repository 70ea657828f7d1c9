//! A gamepad of the PC, as Linux' event devices have it.

use std::io::ErrorKind;

use controls::DualShock3Report;
use evdev::{Device, KeyCode};

use crate::gamepad_mapping::Mapping;

/// A gamepad.
pub(super) struct Gamepad {
    device: Device,
    mapping: Mapping,
}

impl Gamepad {
    /// Returns the first gamepad that may be read, and its name.
    pub(super) fn find() -> Option<(Self, String)> {
        evdev::enumerate().map(|(_, device)| device).find_map(|device| {
            let is_gamepad = device.supported_keys().is_some_and(|keys| keys.contains(KeyCode::BTN_SOUTH));
            if !is_gamepad {
                return None;
            }
            device.set_nonblocking(true).ok()?;
            let name = device.name().unwrap_or("a gamepad").to_string();
            let axes = device.get_absinfo().ok()?;
            let axes: Vec<_> = axes.map(|(code, axis)| (code.0, [axis.minimum(), axis.maximum()])).collect();
            Some((Self { device, mapping: Mapping::new(axes) }, name))
        })
    }

    /// Takes what the gamepad has sent, and returns the report that a DualShock 3 would send; `None` when it has gone.
    pub(super) fn report(&mut self) -> Option<[u8; DualShock3Report::LENGTH]> {
        match self.device.fetch_events() {
            Ok(events) => {
                events.for_each(|event| self.mapping.take(event.event_type().0, event.code(), event.value()));
            }
            Err(error) if error.kind() == ErrorKind::WouldBlock => {}
            Err(_) => return None,
        }
        Some(self.mapping.report())
    }
}
