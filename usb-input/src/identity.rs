//! What a device says of itself.

use core::fmt;

use embassy_usb_driver::Speed;

use crate::Text;

/// What a device is served as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Kind {
    /// A hub.
    Hub {
        /// How many ports it has.
        ports: u8,
    },
    /// A keyboard in the boot protocol.
    BootKeyboard,
    /// A keyboard whose report descriptor tells where its keys are.
    ReportKeyboard,
    /// A Sony DualShock 3 (054C:0268).
    DualShock3,
    /// A Sony DualShock 4 (054C:05C4, 054C:09CC).
    DualShock4,
    /// Another pad or joystick, whose report descriptor tells where its sticks and buttons are.
    Gamepad,
}

/// What a device says of itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Identity {
    /// idVendor.
    pub vendor: u16,
    /// idProduct.
    pub product: u16,
    /// bDeviceClass, or its first interface's class where that is 0; see <https://www.usb.org/defined-class-codes>.
    pub class: u8,
    /// How fast it signals.
    pub speed: Speed,
    /// Its maker's name, empty if it tells none.
    pub maker: Text,
    /// Its own name, empty if it tells none.
    pub name: Text,
}

impl fmt::Display for Identity {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { vendor, product, class, speed, maker, name } = self;
        let speed = match speed {
            Speed::Low => "low",
            Speed::Full => "full",
            Speed::High => "high",
        };
        write!(formatter, "{vendor:04x}:{product:04x} class {class:#04x}, {speed} speed")?;
        if !maker.is_empty() {
            write!(formatter, ", {maker}")?;
        }
        if !name.is_empty() {
            write!(formatter, ", {name}")?;
        }
        Ok(())
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Hub { ports } => write!(formatter, "hub with {ports} ports"),
            Self::BootKeyboard => formatter.write_str("keyboard"),
            Self::ReportKeyboard => formatter.write_str("keyboard, by its report descriptor"),
            Self::DualShock3 => formatter.write_str("DualShock 3"),
            Self::DualShock4 => formatter.write_str("DualShock 4"),
            Self::Gamepad => formatter.write_str("pad, by its report descriptor"),
        }
    }
}
