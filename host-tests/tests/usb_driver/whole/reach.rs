//! How far a device gets that is wrong.

use usb_input::{Event, Fault, Place, Step};

/// The furthest that a device has come in any of its attempts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reach {
    /// Not past its device descriptor and its address.
    DeviceDescriptor,
    /// Not past its configuration descriptor and being configured.
    Configuration,
    /// Not past what its class is asked for.
    Class,
    /// It is named, and let be.
    Named,
    /// It is served as a keyboard, a pad or a hub.
    Served,
}

/// One more than the last of them.
pub const REACHES: usize = Reach::Served as usize + 1;

impl Reach {
    /// How far whoever was at a place has come.
    pub fn of(events: &[Event], here: Place) -> Self {
        let reach = |event: &Event| match *event {
            Event::Attached { device, .. } if device == here => Some(Self::Served),
            Event::Unsupported { device, .. } if device == here => Some(Self::Named),
            Event::Fault { device, fault: Fault::Transfer { doing, .. } | Fault::Descriptor { doing } }
                if device == here =>
            {
                Some(match doing {
                    Step::DeviceDescriptor | Step::Address => Self::DeviceDescriptor,
                    Step::ConfigurationDescriptor | Step::Configuration => Self::Configuration,
                    _ => Self::Class,
                })
            }
            _ => None,
        };
        events.iter().filter_map(reach).max().unwrap_or(Self::DeviceDescriptor)
    }
}
