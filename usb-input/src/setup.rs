//! The SETUP packets that are sent (USB 2.0 §9.3).

/// A SETUP packet without its length, which is the data's.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Setup {
    /// bmRequestType.
    pub(crate) kind: u8,
    /// bRequest.
    pub(crate) request: u8,
    /// wValue.
    pub(crate) value: u16,
    /// wIndex.
    pub(crate) index: u16,
}

/// Types of descriptor (USB 2.0 §9.4 table 9-5, §11.23.2.1; HID 1.11 §7.1).
pub(crate) mod descriptor {
    pub(crate) const DEVICE: u8 = 1;
    pub(crate) const CONFIGURATION: u8 = 2;
    pub(crate) const STRING: u8 = 3;
    pub(crate) const INTERFACE: u8 = 4;
    pub(crate) const ENDPOINT: u8 = 5;
    pub(crate) const HID: u8 = 0x21;
    pub(crate) const REPORT: u8 = 0x22;
    pub(crate) const HUB: u8 = 0x29;
}

/// A HID report's type (HID 1.11 §7.2.1).
#[derive(Debug, Clone, Copy)]
pub(crate) enum ReportType {
    Output = 2,
    Feature = 3,
}

impl Setup {
    /// The packet's eight bytes, for `length` bytes of data.
    pub(crate) const fn bytes(self, length: u16) -> [u8; 8] {
        let [value, index, length] = [self.value.to_le_bytes(), self.index.to_le_bytes(), length.to_le_bytes()];
        [self.kind, self.request, value[0], value[1], index[0], index[1], length[0], length[1]]
    }

    /// Whether its data comes from the device.
    pub(crate) const fn reads(self) -> bool {
        self.kind & 0x80 != 0
    }

    const fn new(kind: u8, request: u8, value: u16, index: u16) -> Self {
        Self { kind, request, value, index }
    }

    /// GET_DESCRIPTOR of the device (§9.4.3); `language` for strings, else 0.
    pub(crate) const fn descriptor(kind: u8, index: u8, language: u16) -> Self {
        Self::new(0x80, 6, u16::from_be_bytes([kind, index]), language)
    }

    /// GET_DESCRIPTOR of an interface: its report descriptor (HID 1.11 §7.1.1).
    pub(crate) const fn report_descriptor(interface: u8) -> Self {
        Self::new(0x81, 6, u16::from_be_bytes([descriptor::REPORT, 0]), interface as u16)
    }

    /// GET_DESCRIPTOR of a hub (§11.24.2.5).
    pub(crate) const fn hub_descriptor() -> Self {
        Self::new(0xA0, 6, u16::from_be_bytes([descriptor::HUB, 0]), 0)
    }

    /// SET_ADDRESS (§9.4.6).
    pub(crate) const fn address(address: u8) -> Self {
        Self::new(0x00, 5, address as u16, 0)
    }

    /// SET_CONFIGURATION (§9.4.7).
    pub(crate) const fn configuration(value: u8) -> Self {
        Self::new(0x00, 9, value as u16, 0)
    }

    /// CLEAR_FEATURE(ENDPOINT_HALT) (§9.4.1, §9.4.5).
    pub(crate) const fn clear_halt(endpoint_address: u8) -> Self {
        Self::new(0x02, 1, 0, endpoint_address as u16)
    }

    /// GET_REPORT (HID 1.11 §7.2.1).
    pub(crate) const fn get_report(kind: ReportType, id: u8, interface: u8) -> Self {
        Self::new(0xA1, 1, u16::from_be_bytes([kind as u8, id]), interface as u16)
    }

    /// SET_REPORT (HID 1.11 §7.2.2).
    pub(crate) const fn set_report(kind: ReportType, id: u8, interface: u8) -> Self {
        Self::new(0x21, 9, u16::from_be_bytes([kind as u8, id]), interface as u16)
    }

    /// SET_IDLE(0): report changes alone (HID 1.11 §7.2.4).
    pub(crate) const fn report_changes_only(interface: u8) -> Self {
        Self::new(0x21, 10, 0, interface as u16)
    }

    /// SET_PROTOCOL(boot) (HID 1.11 §7.2.6).
    pub(crate) const fn boot_protocol(interface: u8) -> Self {
        Self::new(0x21, 11, 0, interface as u16)
    }

    /// GET_STATUS of a hub's port, or of the hub for port 0 (§11.24.2.6, §11.24.2.7).
    pub(crate) const fn hub_status(port: u8) -> Self {
        Self::new(Self::hub_kind(port) | 0x80, 0, 0, port as u16)
    }

    /// SET_FEATURE of a hub's port (§11.24.2.13).
    pub(crate) const fn set_port_feature(feature: u8, port: u8) -> Self {
        Self::new(Self::hub_kind(port), 3, feature as u16, port as u16)
    }

    /// CLEAR_FEATURE of a hub's port, or of the hub for port 0 (§11.24.2.1, §11.24.2.2).
    pub(crate) const fn clear_hub_feature(feature: u8, port: u8) -> Self {
        Self::new(Self::hub_kind(port), 1, feature as u16, port as u16)
    }

    /// CLEAR_TT_BUFFER of a hub with one translator for all its ports: what it holds for endpoint 0 of a device, in one
    /// direction (§11.24.2.3).
    pub(crate) const fn clear_tt_buffer(address: u8, input: bool) -> Self {
        Self::new(0x23, 8, (input as u16) << 15 | (address as u16) << 4, 1)
    }

    const fn hub_kind(port: u8) -> u8 {
        if port == 0 { 0x20 } else { 0x23 }
    }
}

#[cfg(test)]
mod tests {
    use super::{ReportType, Setup, descriptor};

    /// Bytes as they were seen on the wire or stand in the specification.
    #[test]
    fn packets_are_as_on_the_wire() {
        let get_device = Setup::descriptor(descriptor::DEVICE, 0, 0);
        assert_eq!(get_device.bytes(18), [0x80, 6, 0, 1, 0, 0, 18, 0]);
        let name = Setup::descriptor(descriptor::STRING, 2, 0x0409);
        assert_eq!(name.bytes(0x1FF), [0x80, 6, 2, 3, 0x09, 0x04, 0xFF, 0x01]);
        assert_eq!(Setup::get_report(ReportType::Feature, 0xF2, 0).bytes(17), [0xA1, 1, 0xF2, 3, 0, 0, 17, 0]);
        assert_eq!(Setup::set_report(ReportType::Feature, 0xF4, 0).bytes(4), [0x21, 9, 0xF4, 3, 0, 0, 4, 0]);
        assert_eq!(Setup::report_descriptor(1).bytes(63), [0x81, 6, 0, 0x22, 1, 0, 63, 0]);
        assert_eq!(Setup::boot_protocol(2).bytes(0), [0x21, 0x0B, 0, 0, 2, 0, 0, 0]);
        assert_eq!(Setup::report_changes_only(2).bytes(0), [0x21, 0x0A, 0, 0, 2, 0, 0, 0]);
        assert_eq!(Setup::hub_descriptor().bytes(9), [0xA0, 6, 0, 0x29, 0, 0, 9, 0]);
        assert_eq!(Setup::hub_status(3).bytes(4), [0xA3, 0, 0, 0, 3, 0, 4, 0]);
        assert_eq!(Setup::hub_status(0).bytes(4), [0xA0, 0, 0, 0, 0, 0, 4, 0]);
        assert_eq!(Setup::set_port_feature(8, 3).bytes(0), [0x23, 3, 8, 0, 3, 0, 0, 0]);
        assert_eq!(Setup::clear_hub_feature(20, 3).bytes(0), [0x23, 1, 20, 0, 3, 0, 0, 0]);
        assert_eq!(Setup::clear_tt_buffer(5, false).bytes(0), [0x23, 8, 0x50, 0, 1, 0, 0, 0]);
        assert_eq!(Setup::clear_tt_buffer(5, true).bytes(0), [0x23, 8, 0x50, 0x80, 1, 0, 0, 0]);
        assert_eq!(Setup::clear_halt(0x81).bytes(0), [0x02, 1, 0, 0, 0x81, 0, 0, 0]);
    }
}
