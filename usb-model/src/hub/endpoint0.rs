//! A control endpoint: stages and toggles (USB 2.0 §8.5.3).

use crate::wire::{Answer, Handshake, Toggle};

/// Where the endpoint stands.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Stage {
    Idle,
    /// Data to the host: what is left, and the next packet's toggle.
    In(Vec<u8>, Toggle),
    /// The host ends a transfer that gave it data.
    StatusOut,
    /// The device ends a transfer that took effect.
    StatusIn,
    /// The request was refused, until the next SETUP.
    Refused,
}

/// A control endpoint whose requests carry no data to the device.
#[derive(Debug, Clone)]
pub(super) struct Endpoint0 {
    packet_bytes: usize,
    stage: Stage,
    setup: [u8; 8],
}

fn other(toggle: Toggle) -> Toggle {
    match toggle {
        Toggle::Data0 => Toggle::Data1,
        Toggle::Data1 => Toggle::Data0,
    }
}

impl Endpoint0 {
    pub fn new(packet_bytes: usize) -> Self {
        Self { packet_bytes, stage: Stage::Idle, setup: [0; 8] }
    }

    /// A SETUP came; `answer` is the data for the host, or `None` to refuse.
    pub fn setup(&mut self, packet: [u8; 8], answer: Option<Vec<u8>>) -> Handshake {
        let length = usize::from(u16::from_le_bytes([packet[6], packet[7]]));
        self.setup = packet;
        self.stage = match answer {
            None => Stage::Refused,
            Some(mut data) if packet[0] & 0x80 != 0 && length > 0 => {
                data.truncate(length);
                Stage::In(data, Toggle::Data1)
            }
            Some(_) => Stage::StatusIn,
        };
        Handshake::Ack
    }

    pub fn data_in(&self) -> Answer {
        match &self.stage {
            Stage::In(data, toggle) => Answer::Data(*toggle, data[..data.len().min(self.packet_bytes)].to_vec()),
            Stage::StatusIn => Answer::Data(Toggle::Data1, Vec::new()),
            Stage::Refused => Answer::Stall,
            Stage::Idle | Stage::StatusOut => Answer::Nak,
        }
    }

    /// The host has the last packet; the request that takes effect now, if one does.
    pub fn acknowledged(&mut self) -> Option<[u8; 8]> {
        match &mut self.stage {
            Stage::In(data, toggle) => {
                let sent = data.len().min(self.packet_bytes);
                data.drain(..sent);
                *toggle = other(*toggle);
                if sent < self.packet_bytes || data.is_empty() {
                    self.stage = Stage::StatusOut;
                }
                None
            }
            Stage::StatusIn => {
                self.stage = Stage::Idle;
                Some(self.setup)
            }
            _ => None,
        }
    }

    pub fn data_out(&mut self, bytes: &[u8]) -> Handshake {
        match self.stage {
            Stage::StatusOut | Stage::In(..) if bytes.is_empty() => {
                self.stage = Stage::Idle;
                Handshake::Ack
            }
            Stage::Idle => Handshake::Ack,
            _ => Handshake::Stall,
        }
    }
}
