//! What the bus tells, for a person.

use core::fmt::{self, Write};

use usb_input::Event;

/// Writes a line about an event; nothing about a report.
///
/// # Errors
/// The console's.
pub fn tell(event: &Event, console: &mut impl Write) -> fmt::Result {
    match event {
        Event::Attached { device, kind, identity } => writeln!(console, "usb {device}: {kind} ({identity})"),
        Event::Unsupported { device, identity } => {
            writeln!(console, "usb {device}: nothing that Halfspace reads ({identity})")
        }
        Event::Detached { device, kind: Some(kind) } => writeln!(console, "usb {device}: {kind} has gone"),
        Event::Detached { device, kind: None } => writeln!(console, "usb {device}: has gone"),
        Event::Fault { device, fault } => writeln!(console, "usb {device}: {fault}"),
        Event::BatteryLow { device, battery } => {
            writeln!(console, "usb {device}: the pad's battery is low ({battery:?}): charge it")
        }
        _ => Ok(()),
    }
}
