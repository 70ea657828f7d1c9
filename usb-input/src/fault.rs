//! What can go wrong with a device.

use core::fmt;

use embassy_usb_driver::host::PipeError;

/// What went wrong with a device, and what the bus did about it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Fault {
    /// A transfer failed; the device is reset and tried again.
    Transfer {
        /// What was being done.
        doing: Step,
        /// How it failed.
        error: PipeError,
    },
    /// A descriptor makes no sense; the device is reset and tried again.
    Descriptor {
        /// What was being done.
        doing: Step,
    },
    /// It took too long to get ready; it is reset and tried again.
    TooSlow,
    /// It failed so often that it is left alone until it is plugged in again.
    GivenUp,
    /// The controller has no channel left for it.
    NoPipe,
    /// There are as many devices as there is room for; it is left alone.
    TooManyDevices,
    /// It hangs below more hubs than USB allows; it is left alone.
    TooDeep,
    /// A hub has more ports than are served; those above are not.
    TooManyPorts {
        /// How many it has.
        ports: u8,
    },
    /// A hub's port draws too much current, and is off.
    OverCurrent,
    /// A report is shorter than its kind of report is, or empty; it was dropped. Told once.
    Report {
        /// Its length in bytes.
        length: u8,
    },
}

/// What was being done when something went wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Step {
    /// Reading the device descriptor.
    DeviceDescriptor,
    /// Giving it an address.
    Address,
    /// Reading the configuration descriptor.
    ConfigurationDescriptor,
    /// Choosing the configuration.
    Configuration,
    /// Reading the report descriptor.
    ReportDescriptor,
    /// Choosing the boot protocol.
    Protocol,
    /// Reading the hub descriptor.
    HubDescriptor,
    /// Asking about or setting a hub's port.
    Port,
    /// Waiting for a port's reset to end.
    PortReset,
    /// Waking a DualShock 3.
    Wake,
    /// Reading reports.
    Reports,
}

impl fmt::Display for Fault {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Transfer { doing, error } => write!(formatter, "{doing} failed ({error:?}): trying again"),
            Self::Descriptor { doing } => write!(formatter, "{doing} gave nonsense: trying again"),
            Self::TooSlow => formatter.write_str("not ready within 5 s: trying again"),
            Self::GivenUp => formatter.write_str("given up: unplug it, and plug it in again or elsewhere"),
            Self::NoPipe => formatter.write_str("the controller has no channel left: unplug something"),
            Self::TooManyDevices => formatter.write_str("too many devices: unplug one, and plug this in again"),
            Self::TooDeep => formatter.write_str("below more than 5 hubs: plug it in nearer to the board"),
            Self::TooManyPorts { ports } => {
                write!(formatter, "hub has {ports} ports, the first {} are served", crate::HUB_PORTS_MAXIMUM)
            }
            Self::OverCurrent => formatter.write_str("a port draws too much current: unplug what is there"),
            Self::Report { length } => write!(formatter, "report of {length} bytes is too short: dropped"),
        }
    }
}

impl fmt::Display for Step {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::DeviceDescriptor => "reading the device descriptor",
            Self::Address => "giving an address",
            Self::ConfigurationDescriptor => "reading the configuration descriptor",
            Self::Configuration => "choosing the configuration",
            Self::ReportDescriptor => "reading the report descriptor",
            Self::Protocol => "choosing the boot protocol",
            Self::HubDescriptor => "reading the hub descriptor",
            Self::Port => "handling a port",
            Self::PortReset => "resetting a port",
            Self::Wake => "waking the pad",
            Self::Reports => "reading reports",
        })
    }
}

impl core::error::Error for Fault {}
