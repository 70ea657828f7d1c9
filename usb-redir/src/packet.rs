//! The protocol's packets: what QEMU sends and what it is sent.
//!
//! A packet is a header (kind, length of what follows, id; 32 bits each, the id 64 once both sides
//! said so) and its content, little endian. Source: usbredir's protocol description, version 0.7.

use usb_model::wire::Speed;

use crate::descriptors::{Configuration, Endpoint, MAXIMUM};
use crate::host::{Request, TransferError};

/// A packet's kind.
pub mod kind {
    pub const HELLO: u32 = 0;
    pub const DEVICE_CONNECT: u32 = 1;
    pub const DEVICE_DISCONNECT: u32 = 2;
    pub const RESET: u32 = 3;
    pub const INTERFACE_INFO: u32 = 4;
    pub const ENDPOINT_INFO: u32 = 5;
    pub const SET_CONFIGURATION: u32 = 6;
    pub const GET_CONFIGURATION: u32 = 7;
    pub const CONFIGURATION_STATUS: u32 = 8;
    pub const SET_ALTERNATE_SETTING: u32 = 9;
    pub const GET_ALTERNATE_SETTING: u32 = 10;
    pub const ALTERNATE_SETTING_STATUS: u32 = 11;
    pub const START_INTERRUPT_RECEIVING: u32 = 15;
    pub const STOP_INTERRUPT_RECEIVING: u32 = 16;
    pub const INTERRUPT_RECEIVING_STATUS: u32 = 17;
    pub const DEVICE_DISCONNECT_ACKNOWLEDGED: u32 = 24;
    pub const CONTROL: u32 = 100;
    pub const INTERRUPT: u32 = 103;
}

/// What a side can do, a bit each.
pub mod capability {
    /// DEVICE_CONNECT carries bcdDevice.
    pub const CONNECT_DEVICE_VERSION: u32 = 1 << 1;
    /// DEVICE_DISCONNECT is acknowledged.
    pub const DISCONNECT_ACKNOWLEDGED: u32 = 1 << 3;
    /// ENDPOINT_INFO carries packet sizes.
    pub const PACKET_SIZES: u32 = 1 << 4;
    /// Ids have 64 bits.
    pub const LONG_IDS: u32 = 1 << 5;
    /// What this side can do.
    pub const OURS: u32 = CONNECT_DEVICE_VERSION | DISCONNECT_ACKNOWLEDGED | PACKET_SIZES | LONG_IDS;
}

/// Bytes of a version text in HELLO.
const VERSION_BYTES: usize = 64;
/// A transfer type that says: no such endpoint.
const NO_ENDPOINT: u8 = 255;

/// A packet as it came.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Packet {
    pub kind: u32,
    pub id: u64,
    pub content: Vec<u8>,
}

impl Packet {
    /// Returns the first `N` bytes and the others, or what is wrong.
    pub fn head<const N: usize>(&self) -> Result<(&[u8; N], &[u8]), String> {
        self.content.split_first_chunk().ok_or_else(|| {
            format!("QEMU's packet of kind {} has {} bytes, at least {N} expected", self.kind, self.content.len())
        })
    }
}

/// Returns how a transfer ended, as the protocol numbers it.
pub fn status<T>(result: &Result<T, TransferError>) -> u8 {
    match result {
        Ok(_) => 0,
        Err(TransferError::Silent | TransferError::Toggle) => 3,
        Err(TransferError::Stall) => 4,
        Err(TransferError::Timeout) => 5,
        Err(TransferError::Babble) => 6,
    }
}

pub fn hello() -> Vec<u8> {
    let mut content = b"halfspace".to_vec();
    content.resize(VERSION_BYTES, 0);
    content.extend(capability::OURS.to_le_bytes());
    content
}

/// Returns the capabilities of a side's HELLO; one without any is an old side.
pub fn capabilities(packet: &Packet) -> Result<u32, String> {
    let (_, rest) = packet.head::<VERSION_BYTES>()?;
    Ok(rest.first_chunk().map_or(0, |bytes| u32::from_le_bytes(*bytes)))
}

/// DEVICE_CONNECT, from a device descriptor.
pub fn device_connect(speed: Speed, descriptor: &[u8]) -> Result<Vec<u8>, String> {
    let Some(&[_, _, _, _, class, subclass, protocol, _, v0, v1, p0, p1, d0, d1]) = descriptor.first_chunk() else {
        return Err(format!("the device descriptor has {} bytes, not 18", descriptor.len()));
    };
    let speed = match speed {
        Speed::Low => 0,
        Speed::Full => 1,
        Speed::High => 2,
    };
    Ok(vec![speed, class, subclass, protocol, v0, v1, p0, p1, d0, d1])
}

pub fn interface_info(configuration: &Configuration) -> Vec<u8> {
    let mut table = [[0; MAXIMUM]; 4];
    for (index, interface) in configuration.interfaces.iter().enumerate() {
        let [class, subclass, protocol] = interface.class;
        for (row, value) in table.iter_mut().zip([interface.number, class, subclass, protocol]) {
            row[index] = value;
        }
    }
    let count = configuration.interfaces.len() as u32;
    [&count.to_le_bytes()[..], table.as_flattened()].concat()
}

/// ENDPOINT_INFO: endpoint 0 both ways, and the configuration's. Packet sizes only for a side that knows them.
pub fn endpoint_info(configuration: &Configuration, packet_sizes: bool) -> Vec<u8> {
    let (mut kinds, mut intervals, mut interfaces) = ([NO_ENDPOINT; MAXIMUM], [0; MAXIMUM], [0; MAXIMUM]);
    let mut sizes = [[0; 2]; MAXIMUM];
    for index in [0, 16] {
        kinds[index] = 0;
        sizes[index] = 64_u16.to_le_bytes();
    }
    for endpoint in &configuration.endpoints {
        let Endpoint { kind, packet_size, interval, interface, .. } = *endpoint;
        let index = endpoint.index();
        kinds[index] = kind;
        // 0 is refused for an interrupt endpoint.
        intervals[index] = interval.max(1);
        interfaces[index] = interface;
        sizes[index] = packet_size.to_le_bytes();
    }
    let mut content = [kinds, intervals, interfaces].concat();
    if packet_sizes {
        content.extend(sizes.as_flattened());
    }
    content
}

/// A control packet's head: endpoint, request, status, and the data's length.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Control {
    pub endpoint: u8,
    pub request: Request,
}

impl Control {
    pub const BYTES: usize = 10;

    pub fn parse(bytes: &[u8; Self::BYTES]) -> Self {
        let [endpoint, request, request_type, _, v0, v1, i0, i1, l0, l1] = *bytes;
        let word = |low, high| u16::from_le_bytes([low, high]);
        let request = Request { request_type, request, value: word(v0, v1), index: word(i0, i1), length: word(l0, l1) };
        Self { endpoint, request }
    }

    /// The answer: the same head with a status and the length of what came in, or went out.
    pub fn answer(self, status: u8, length: u16, data: &[u8]) -> Vec<u8> {
        let Request { request_type, request, value, index, .. } = self.request;
        let head = [self.endpoint, request, request_type, status];
        [&head[..], &value.to_le_bytes(), &index.to_le_bytes(), &length.to_le_bytes(), data].concat()
    }
}

/// A packet of an interrupt endpoint, or the answer to one.
pub fn interrupt(endpoint: u8, status: u8, length: u16, data: &[u8]) -> Vec<u8> {
    [&[endpoint, status][..], &length.to_le_bytes(), data].concat()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::descriptors::Interface;

    fn configuration() -> Configuration {
        let endpoint = |address, interval| Endpoint { address, kind: 3, packet_size: 64, interval, interface: 0 };
        let interfaces = vec![Interface { number: 0, class: [3, 1, 2] }];
        Configuration { interfaces, endpoints: vec![endpoint(0x02, 1), endpoint(0x81, 0)] }
    }

    /// Lengths and offsets written out from the protocol's description.
    #[test]
    fn tables_have_the_protocol_s_layout() {
        let info = interface_info(&configuration());
        assert_eq!((info.len(), &info[..5]), (132, &[1, 0, 0, 0, 0][..]));
        assert_eq!((info[36], info[68], info[100]), (3, 1, 2));
        let info = endpoint_info(&configuration(), true);
        assert_eq!(info.len(), 32 + 32 + 32 + 64);
        assert_eq!((info[0], info[1], info[2], info[16], info[17], info[18]), (0, 255, 3, 0, 3, 255));
        assert_eq!((info[32 + 2], info[32 + 17]), (1, 1));
        assert_eq!(info[96 + 2 * 17..][..2], [64, 0]);
        assert_eq!(endpoint_info(&configuration(), false).len(), 96);
        assert_eq!(hello().len(), 68);
    }

    #[test]
    fn a_control_packet_is_answered_in_kind() {
        // GET_REPORT of a DualShock 3's report 0xF2.
        let head = [0x80, 1, 0xA1, 0, 0xF2, 3, 0, 0, 17, 0];
        let control = Control::parse(&head);
        let request = Request { request_type: 0xA1, request: 1, value: 0x03F2, index: 0, length: 17 };
        assert_eq!(control, Control { endpoint: 0x80, request });
        assert_eq!(control.answer(4, 2, &[7, 8]), [0x80, 1, 0xA1, 4, 0xF2, 3, 0, 0, 2, 0, 7, 8]);
    }

    #[test]
    fn what_is_too_short_is_named() {
        let packet = Packet { kind: 100, id: 1, content: vec![0; 9] };
        assert_eq!(packet.head::<10>().unwrap_err(), "QEMU's packet of kind 100 has 9 bytes, at least 10 expected");
        assert!(device_connect(Speed::Full, &[18, 1]).unwrap_err().contains("has 2 bytes"));
        let descriptor = [18, 1, 0, 2, 0, 0, 0, 64, 0x4C, 0x05, 0x68, 0x02, 0, 1, 1, 2, 0, 1];
        assert_eq!(device_connect(Speed::Full, &descriptor), Ok(vec![1, 0, 0, 0, 0x4C, 0x05, 0x68, 0x02, 0, 1]));
    }
}
