//! Endpoint 0: SETUP, data, status (USB 2.0 §8.5.3).

use super::{ADDRESS_RECOVERY_US, Function, Leaf};
use crate::wire::{Answer, Handshake, Toggle};

/// Where a control transfer is.
#[derive(Debug, Clone, Default)]
pub(super) struct Control {
    setup: [u8; 8],
    stage: Stage,
    toggle_is_one: bool,
}

/// The stage of a control transfer, and what it still has.
#[derive(Debug, Clone, Default)]
enum Stage {
    /// Between transfers.
    #[default]
    Idle,
    /// Bytes that go to the host: how many have been acknowledged, how many are in the packet under way.
    In { data: Vec<u8>, acknowledged: usize, sent: usize, ended: bool },
    /// Bytes that came from the host.
    Out { data: Vec<u8> },
    /// The host reads an empty packet.
    StatusIn,
    /// Refused: until the next SETUP.
    Refused,
}

/// How many bytes a request's data stage has at most.
fn announced(setup: [u8; 8]) -> usize {
    u16::from_le_bytes([setup[6], setup[7]]).into()
}

impl<F: Function> Leaf<F> {
    pub(super) fn begin_control(&mut self, now: u64, setup: [u8; 8]) {
        let length = announced(setup);
        let stage = if setup[0] & 0x80 != 0 && length > 0 {
            match self.answer(now, setup) {
                Some(mut data) => {
                    data.truncate(length);
                    Stage::In { data, acknowledged: 0, sent: 0, ended: false }
                }
                None => Stage::Refused,
            }
        } else if length > 0 {
            Stage::Out { data: Vec::new() }
        } else {
            // Address and configuration change when the status stage is over (§9.4.6); the rest may be refused now.
            let accepted = match (setup[0], setup[1]) {
                (0x00, 5) => setup[3] == 0 && setup[2] < 128,
                (0x00, 9) => true,
                _ => self.act(now, setup, &[]),
            };
            if accepted { Stage::StatusIn } else { Stage::Refused }
        };
        self.control = Control { setup, stage, toggle_is_one: true };
    }

    pub(super) fn control_in(&mut self, now: u64) -> Answer {
        let size = self.control_packet_size();
        let toggle = if self.control.toggle_is_one { Toggle::Data1 } else { Toggle::Data0 };
        match &mut self.control.stage {
            Stage::In { data, acknowledged, sent, ended } if !*ended => {
                *sent = (data.len() - *acknowledged).min(size);
                Answer::Data(toggle, data[*acknowledged..][..*sent].to_vec())
            }
            Stage::StatusIn => Answer::Data(Toggle::Data1, Vec::new()),
            Stage::Out { data } => {
                let (found, setup) = (data.clone(), self.control.setup);
                let wanted = announced(setup);
                if found.len() != wanted {
                    self.blame(format!("a status stage after {} of {wanted} bytes", found.len()));
                    return Answer::Stall;
                }
                if !self.act(now, setup, &found) {
                    self.control.stage = Stage::Refused;
                    return Answer::Stall;
                }
                self.control.stage = Stage::StatusIn;
                Answer::Data(Toggle::Data1, Vec::new())
            }
            Stage::Refused => Answer::Stall,
            Stage::Idle | Stage::In { .. } => {
                self.blame("IN from endpoint 0 that no request asked for");
                Answer::Stall
            }
        }
    }

    pub(super) fn control_acknowledged(&mut self, now: u64) {
        let size = self.control_packet_size();
        let Control { setup, stage, toggle_is_one } = &mut self.control;
        let setup = *setup;
        match stage {
            Stage::In { acknowledged, sent, ended, .. } => {
                *toggle_is_one = !*toggle_is_one;
                *acknowledged += *sent;
                // A packet that is not full ends the stage; so does the last of all that was asked for.
                *ended = *sent < size || *acknowledged == announced(setup);
            }
            Stage::StatusIn => {
                self.control.stage = Stage::Idle;
                match (setup[0], setup[1]) {
                    (0x00, 5) => {
                        self.address = setup[2];
                        self.deaf_until = now + ADDRESS_RECOVERY_US;
                    }
                    (0x00, 9) => self.set_configured(setup[2] != 0),
                    _ => {}
                }
            }
            _ => {}
        }
    }

    pub(super) fn control_out(&mut self, toggle: Toggle, bytes: &[u8]) -> Handshake {
        let size = self.control_packet_size();
        match &mut self.control.stage {
            // The status stage of a transfer that read; it may come before all was read (§8.5.3.1).
            Stage::In { .. } => {
                if toggle != Toggle::Data1 || !bytes.is_empty() {
                    self.blame("a status stage that is not an empty DATA1");
                }
                self.control.stage = Stage::Idle;
                Handshake::Ack
            }
            // The host did not hear the acknowledgement of its status stage.
            Stage::Idle if toggle == Toggle::Data1 && bytes.is_empty() => Handshake::Ack,
            Stage::Out { data } => {
                if (toggle == Toggle::Data1) == self.control.toggle_is_one {
                    self.control.toggle_is_one = !self.control.toggle_is_one;
                    data.extend_from_slice(bytes);
                    if bytes.len() > size || data.len() > announced(self.control.setup) {
                        self.blame("more data than was announced, or than a packet holds");
                        self.control.stage = Stage::Refused;
                        return Handshake::Stall;
                    }
                }
                Handshake::Ack
            }
            Stage::Refused => Handshake::Stall,
            Stage::Idle | Stage::StatusIn => {
                self.blame("OUT to endpoint 0 that no request announced");
                Handshake::Stall
            }
        }
    }

    /// Answers a request that reads; `None` refuses it.
    fn answer(&mut self, now: u64, setup: [u8; 8]) -> Option<Vec<u8>> {
        let [kind, request, low, high, index, ..] = setup;
        match (kind, request, high) {
            (0x80, 6, 1) => Some(self.descriptors.device.clone()),
            (0x80, 6, 2) if low == 0 => Some(self.descriptors.configuration.clone()),
            (0x80, 6, 3) if low == 0 && !self.descriptors.strings.is_empty() => Some(vec![4, 3, 0x09, 0x04]),
            (0x80, 6, 3) => {
                let text = self.descriptors.strings.get(usize::from(low).checked_sub(1)?)?;
                let units: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
                Some([&[(2 + units.len()) as u8, 3][..], &units].concat())
            }
            (0x80, 0, _) => Some(vec![0, 0]),
            (0x80, 8, _) => Some(vec![u8::from(self.is_configured())]),
            (0x81, 6, 0x22) => {
                if !self.is_configured() {
                    self.blame("a report descriptor was asked for before SET_CONFIGURATION");
                }
                self.descriptors.reports.get(usize::from(index)).filter(|bytes| !bytes.is_empty()).cloned()
            }
            (0x81 | 0xA1, _, _) if !self.is_configured() => {
                self.blame("an interface was asked before SET_CONFIGURATION");
                None
            }
            _ => self.function.request_in(now, setup),
        }
    }

    /// Does what a request that writes asks for; false refuses it.
    fn act(&mut self, now: u64, setup: [u8; 8], data: &[u8]) -> bool {
        match (setup[0], setup[1]) {
            // CLEAR_FEATURE(ENDPOINT_HALT): the toggle is DATA0 again (§9.4.5).
            (0x02, 1) => {
                let side = if setup[4] & 0x80 == 0 { &mut self.outputs } else { &mut self.inputs };
                side[usize::from(setup[4] & 0xF)] = Default::default();
                true
            }
            (0x21, _) if !self.is_configured() => {
                self.blame("an interface was told something before SET_CONFIGURATION");
                false
            }
            _ => self.function.request_out(now, setup, data),
        }
    }
}
