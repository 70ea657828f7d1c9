//! A hub's requests (USB 2.0 §9.4, §11.24.2).

use super::{Hub, descriptors};
use crate::violation::Rule;
use crate::wire::{Speed, Target};

/// Port features (USB 2.0 table 11-17).
const PORT_ENABLE: u16 = 1;
const PORT_RESET: u16 = 4;
const PORT_POWER: u16 = 8;
const CHANGE_FIRST: u16 = 16;
const CHANGE_LAST: u16 = 20;
/// TATTDB, USB 2.0 §7.1.7.3.
const DEBOUNCE_US: u64 = 100_000;

/// A SETUP's fields.
fn fields(packet: [u8; 8]) -> (u8, u8, u16, u16) {
    let word = |at: usize| u16::from_le_bytes([packet[at], packet[at + 1]]);
    (packet[0], packet[1], word(2), word(4))
}

impl Hub {
    /// The data for a request, empty where it has none; `None` refuses it.
    pub(super) fn answer(&mut self, packet: [u8; 8]) -> Option<Vec<u8>> {
        let (kind, request, value, index) = fields(packet);
        let port = usize::from(index).wrapping_sub(1);
        match (kind, request) {
            (0x80, 6) => match value >> 8 {
                1 => Some(descriptors::device(self.speed)),
                2 => Some(descriptors::configuration(self.speed)),
                _ => None,
            },
            (0xa0, 6) => Some(descriptors::hub(self.ports.len())),
            (0x80, 8) => Some(vec![u8::from(self.configured)]),
            (0x80..=0x82, 0) => Some(vec![1, 0]),
            (0x00, 5) => (value <= 127).then(Vec::new),
            (0x00, 9) => (value <= 1).then(Vec::new),
            (0x01, 11) => (value == 0).then(Vec::new),
            (0x02, 1) => Some(Vec::new()),
            (0xa0, 0) => Some(vec![0; 4]),
            (0xa3, 0) => self.ports.get_mut(port).map(|port| {
                port.asked();
                port.status().to_vec()
            }),
            (0x23, 1) => {
                let known = matches!(value, PORT_ENABLE | PORT_POWER | CHANGE_FIRST..=CHANGE_LAST);
                (known && port < self.ports.len()).then(Vec::new)
            }
            (0x23, 3) => {
                let known = matches!(value, PORT_RESET | PORT_POWER);
                (known && port < self.ports.len()).then(Vec::new)
            }
            // Of a translator, which there is at high speed.
            (0x23, 8 | 9) => (self.speed == Speed::High).then(Vec::new),
            _ => None,
        }
    }

    /// A request without data came to its end.
    pub(super) fn take_effect(&mut self, now: u64, packet: [u8; 8]) {
        let (kind, request, value, index) = fields(packet);
        let number = usize::from(index).wrapping_sub(1);
        match (kind, request) {
            (0x00, 5) => self.address = value as u8,
            (0x00, 9) => self.configured = value == 1,
            (0x23, 8) => {
                let target = Target { address: (value >> 4 & 0x7f) as u8, endpoint: (value & 0xf) as u8 };
                self.engine.clear(target, value >> 15 == 1);
            }
            (0x23, 9) => self.engine.reset(),
            (0x23, 1 | 3) => self.set_port_feature(now, request == 3, value, number),
            _ => {}
        }
    }

    fn set_port_feature(&mut self, now: u64, on: bool, feature: u16, number: usize) {
        let Some(port) = self.ports.get_mut(number) else { return };
        match (on, feature) {
            (_, PORT_POWER) => port.set_power(on),
            (false, PORT_ENABLE) => port.disable(),
            (false, CHANGE_FIRST..=CHANGE_LAST) => port.changes &= !(1 << (feature - CHANGE_FIRST)),
            (true, PORT_RESET) => {
                if let Some(stable) = port.known_for(now).filter(|stable| *stable < DEBOUNCE_US) {
                    self.complaints.push((Rule::Debounce, format!("hub port {} after {stable} us", number + 1)));
                }
                port.start_reset(now);
            }
            _ => {}
        }
        self.tick(now);
    }
}
