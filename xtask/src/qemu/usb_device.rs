//! What QEMU plugs into a machine's USB bus.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::options::comma_doubled;

/// What a device is.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Kind {
    /// QEMU's full-speed hub with eight ports.
    Hub,
    /// QEMU's keyboard.
    Keyboard,
    /// What a usbredir server at a Unix socket has. QEMU calls again, once a second, while nobody
    /// answers there.
    Served(PathBuf),
    /// A device of this computer's own, whenever one of these ids is plugged in; the computer's own
    /// driver loses it.
    OfThisComputer(UsbIds),
}

/// A device's ids, idVendor and idProduct.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UsbIds {
    /// idVendor.
    pub vendor: u16,
    /// idProduct.
    pub product: u16,
}

/// A device and the port that it hangs on: `1` is the machine's root port, `1.3` the third port of
/// the hub there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UsbDevice {
    kind: Kind,
    port: String,
}

impl UsbDevice {
    /// Returns a hub.
    pub fn hub(port: &str) -> Self {
        Self { kind: Kind::Hub, port: port.into() }
    }

    /// Returns a keyboard, which gets the keys of the window and of [`Qmp::keys`](crate::qmp::Qmp::keys).
    pub fn keyboard(port: &str) -> Self {
        Self { kind: Kind::Keyboard, port: port.into() }
    }

    /// Returns what the usbredir server at `socket` has.
    pub fn served(socket: impl AsRef<Path>, port: &str) -> Self {
        Self { kind: Kind::Served(socket.as_ref().into()), port: port.into() }
    }

    /// Returns this computer's own device of these ids.
    pub fn of_this_computer(ids: UsbIds, port: &str) -> Self {
        Self { kind: Kind::OfThisComputer(ids), port: port.into() }
    }

    /// Returns QEMU's name for the device, by which it is taken out.
    pub(super) fn id(&self) -> String {
        format!("usb{}", self.port)
    }

    fn driver(&self) -> &'static str {
        match self.kind {
            Kind::Hub => "usb-hub",
            Kind::Keyboard => "usb-kbd",
            Kind::Served(_) => "usb-redir",
            Kind::OfThisComputer(_) => "usb-host",
        }
    }

    fn server(&self) -> String {
        format!("server-{}", self.id())
    }

    /// Returns QEMU's arguments that plug it in from the start.
    pub(super) fn arguments(&self) -> Vec<String> {
        let device = format!("{},id={},port={}", self.driver(), self.id(), self.port);
        match &self.kind {
            Kind::Hub | Kind::Keyboard => vec!["-device".into(), device],
            Kind::Served(socket) => vec![
                "-chardev".into(),
                format!("socket,id={},path={},reconnect=1", self.server(), comma_doubled(socket)),
                "-device".into(),
                format!("{device},chardev={}", self.server()),
            ],
            Kind::OfThisComputer(UsbIds { vendor, product }) => {
                vec!["-device".into(), format!("{device},vendorid={vendor:#06x},productid={product:#06x}")]
            }
        }
    }

    /// Returns the arguments of QMP's `device_add`.
    ///
    /// # Panics
    /// For what is not QEMU's own: its source belongs to the start.
    pub(super) fn plug(&self) -> Value {
        assert!(matches!(self.kind, Kind::Hub | Kind::Keyboard), "{self:?} is plugged in at its source");
        json!({ "driver": self.driver(), "id": self.id(), "port": self.port })
    }
}
