//! The interfaces and endpoints that a configuration's descriptors name (USB 2.0 §9.6).

use usb_model::wire::Speed;

/// Interfaces, and endpoints of one direction, that the protocol has room for.
pub const MAXIMUM: usize = 32;
const INTERFACE: u8 = 4;
const ENDPOINT: u8 = 5;

/// An interface, in its first alternate setting.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Interface {
    /// Its number.
    pub number: u8,
    /// Class, subclass, protocol.
    pub class: [u8; 3],
}

/// An endpoint other than 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Endpoint {
    /// bEndpointAddress: the number, and bit 7 for IN.
    pub address: u8,
    /// Transfer type: 0 control, 1 isochronous, 2 bulk, 3 interrupt.
    pub kind: u8,
    /// wMaxPacketSize's lower eleven bits.
    pub packet_size: u16,
    /// bInterval.
    pub interval: u8,
    /// The interface that it belongs to.
    pub interface: u8,
}

impl Endpoint {
    /// Returns the endpoint's number.
    pub const fn number(self) -> u8 {
        self.address & 0x0F
    }

    /// Returns whether it sends to the host.
    pub const fn is_in(self) -> bool {
        self.address & 0x80 != 0
    }

    /// Returns its place in tables of 32: OUT 0 to 15, then IN 0 to 15.
    pub const fn index(self) -> usize {
        index(self.address)
    }

    /// Returns how often an interrupt endpoint wants to be asked, in microseconds (§9.6.6, bInterval).
    pub const fn period_microseconds(self, speed: Speed) -> u64 {
        let interval = if self.interval == 0 { 1 } else { self.interval };
        match speed {
            Speed::Low | Speed::Full => 1_000 * interval as u64,
            Speed::High => 125 << if interval > 16 { 15 } else { interval - 1 },
        }
    }
}

/// Returns the place of an endpoint's address in tables of 32.
pub const fn index(address: u8) -> usize {
    (address & 0x0F | (address & 0x80) >> 3) as usize
}

/// What a configuration has.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Configuration {
    /// Its interfaces, at most [`MAXIMUM`].
    pub interfaces: Vec<Interface>,
    /// Their endpoints.
    pub endpoints: Vec<Endpoint>,
}

impl Configuration {
    /// Reads a configuration's descriptors, as far as they can be read. Alternate settings other
    /// than 0 are left out.
    pub fn parse(mut bytes: &[u8]) -> Self {
        let mut found = Self::default();
        let mut first_setting = false;
        while let Some((&length, &kind)) = bytes.first().zip(bytes.get(1)) {
            let Some((descriptor, rest)) = bytes.split_at_checked(usize::from(length).max(2)) else { break };
            bytes = rest;
            match (kind, descriptor) {
                (INTERFACE, &[_, _, number, setting, _, class, subclass, protocol, ..]) => {
                    first_setting = setting == 0 && found.interfaces.len() < MAXIMUM;
                    if first_setting {
                        found.interfaces.push(Interface { number, class: [class, subclass, protocol] });
                    }
                }
                (ENDPOINT, &[_, _, address, attributes, low, high, interval, ..]) if first_setting => {
                    let packet_size = u16::from_le_bytes([low, high]) & 0x7FF;
                    let interface = found.interfaces.last().map_or(0, |interface| interface.number);
                    found.endpoints.push(Endpoint { address, kind: attributes & 3, packet_size, interval, interface });
                }
                _ => {}
            }
        }
        found
    }

    /// Returns the endpoint of an address.
    pub fn endpoint(&self, address: u8) -> Option<Endpoint> {
        self.endpoints.iter().copied().find(|endpoint| endpoint.address == address)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A DualShock 3's, as it was captured.
    const DUALSHOCK3: [u8; 41] = [
        9, 2, 41, 0, 1, 1, 0, 0x80, 0xFA, 9, 4, 0, 0, 2, 3, 0, 0, 0, 9, 0x21, 0x11, 1, 0, 1, 0x22, 0x94, 0, 7, 5, 2, 3,
        0x40, 0, 1, 7, 5, 0x81, 3, 0x40, 0, 1,
    ];

    #[test]
    fn a_dualshock_3_has_an_interface_and_two_endpoints() {
        let found = Configuration::parse(&DUALSHOCK3);
        assert_eq!(found.interfaces, [Interface { number: 0, class: [3, 0, 0] }]);
        let endpoint = |address| Endpoint { address, kind: 3, packet_size: 64, interval: 1, interface: 0 };
        assert_eq!(found.endpoints, [endpoint(0x02), endpoint(0x81)]);
        assert_eq!((endpoint(0x81).index(), endpoint(0x81).number(), endpoint(0x81).is_in()), (17, 1, true));
        assert_eq!(found.endpoint(0x81), Some(endpoint(0x81)));
    }

    #[test]
    fn descriptors_that_end_early_or_have_no_length_are_read_as_far_as_they_go() {
        for cut in 0..DUALSHOCK3.len() {
            let endpoints = Configuration::parse(&DUALSHOCK3[..cut]).endpoints.len();
            assert_eq!(endpoints, usize::from(cut >= 34), "{cut} bytes");
        }
        assert_eq!(Configuration::parse(&[0; 100]), Configuration::default());
    }

    #[test]
    fn periods_are_milliseconds_or_powers_of_a_microframe() {
        let every = |interval, speed| {
            Endpoint { address: 0x81, kind: 3, packet_size: 8, interval, interface: 0 }.period_microseconds(speed)
        };
        assert_eq!((every(10, Speed::Full), every(10, Speed::Low), every(0, Speed::Full)), (10_000, 10_000, 1_000));
        assert_eq!((every(1, Speed::High), every(7, Speed::High), every(255, Speed::High)), (125, 8_000, 4_096_000));
    }
}
