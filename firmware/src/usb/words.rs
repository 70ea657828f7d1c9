//! What the bus tells, for a person.

use core::fmt::{self, Write};

use usb_input::Event;

use super::service::News;

/// Writes a line about what happened; nothing about a report.
///
/// # Errors
/// The console's.
pub fn tell(news: &News, console: &mut impl Write) -> fmt::Result {
    let event = match news {
        News::Device(event) => event,
        News::Controller(fault) => return writeln!(console, "usb: {fault}"),
        News::FullSpeed => {
            return writeln!(
                console,
                "usb: nothing has worked at high speed: the bus goes on at full speed (`go … usb full` begins so)"
            );
        }
    };
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
