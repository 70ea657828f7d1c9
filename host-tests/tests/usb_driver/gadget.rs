//! A device for tests: control requests with data both ways, an interrupt endpoint each way, a bulk loop.

use std::collections::VecDeque;

use usb_model::wire::{Answer, Device, Handshake, Speed, Target, Toggle};

/// Vendor requests: keep these bytes, give them back, be slow.
pub const KEEP: u8 = 1;
pub const GIVE: u8 = 2;

#[derive(Debug, Clone, PartialEq, Eq)]
enum Stage {
    Idle,
    In(Vec<u8>, Toggle),
    Out(Vec<u8>, usize, Toggle),
    StatusIn,
    StatusOut,
    Refused,
}

/// The device.
pub struct Gadget {
    fastest: Speed,
    pub packet_bytes: usize,
    pub address: u8,
    pub configured: bool,
    setup: [u8; 8],
    stage: Stage,
    /// What the vendor requests keep.
    pub kept: Vec<u8>,
    /// NAKs before each control data and status packet.
    pub hesitation: u32,
    naks: u32,
    /// Reports for interrupt endpoint 1.
    pub reports: VecDeque<Vec<u8>>,
    /// A report that it has from this moment on.
    pub pressed: Option<(u64, Vec<u8>)>,
    /// Makes a report whenever it is asked.
    pub counting: Option<u32>,
    pub in_toggle: Toggle,
    /// Polls of interrupt endpoint 1: when.
    pub polls: Vec<u64>,
    /// What came to interrupt endpoint 2.
    pub received: Vec<Vec<u8>>,
    out_toggle: Toggle,
    /// What went into bulk endpoint 3 and is to come out of it.
    pub bulk: VecDeque<u8>,
    bulk_in: Toggle,
    bulk_out: Toggle,
    /// NYET after every bulk packet taken (high speed).
    pub nyet: bool,
    /// SETUPs that came.
    pub setups: u32,
}

fn other(toggle: Toggle) -> Toggle {
    match toggle {
        Toggle::Data0 => Toggle::Data1,
        Toggle::Data1 => Toggle::Data0,
    }
}

impl Gadget {
    pub fn new(fastest: Speed) -> Self {
        let packet_bytes = if fastest == Speed::Low { 8 } else { 64 };
        Self {
            fastest,
            packet_bytes,
            address: 0,
            configured: false,
            setup: [0; 8],
            stage: Stage::Idle,
            kept: Vec::new(),
            hesitation: 0,
            naks: 0,
            reports: VecDeque::new(),
            pressed: None,
            counting: None,
            in_toggle: Toggle::Data0,
            polls: Vec::new(),
            received: Vec::new(),
            out_toggle: Toggle::Data0,
            bulk: VecDeque::new(),
            bulk_in: Toggle::Data0,
            bulk_out: Toggle::Data0,
            nyet: false,
            setups: 0,
        }
    }

    /// A device that gives the reports 0, 1, 2… as it is asked.
    pub fn counting(fastest: Speed) -> Self {
        Self { counting: Some(0), ..Self::new(fastest) }
    }

    pub fn bulk_bytes(&self) -> usize {
        if self.fastest == Speed::High { 512 } else { 64 }
    }

    fn device_descriptor(&self) -> Vec<u8> {
        vec![18, 1, 0, 2, 0, 0, 0, self.packet_bytes as u8, 0x34, 0x12, 0x78, 0x56, 0, 1, 0, 0, 0, 1]
    }

    fn answer(&self, packet: [u8; 8]) -> Option<Stage> {
        let length = usize::from(u16::from_le_bytes([packet[6], packet[7]]));
        let give = |mut data: Vec<u8>| {
            data.truncate(length);
            Some(Stage::In(data, Toggle::Data1))
        };
        match (packet[0], packet[1]) {
            (0x80, 6) if packet[3] == 1 => give(self.device_descriptor()),
            (0x80, 6) if packet[3] == 2 => give(vec![9, 2, 9, 0, 0, 1, 0, 0x80, 50]),
            (0x00, 5 | 9) | (0x02, 1) => Some(Stage::StatusIn),
            (0x40, KEEP) if length > 0 => Some(Stage::Out(Vec::new(), length, Toggle::Data1)),
            (0x40, KEEP) => Some(Stage::StatusIn),
            (0xc0, GIVE) => give(self.kept.clone()),
            _ => None,
        }
    }

    fn hesitates(&mut self) -> bool {
        let more = self.naks < self.hesitation;
        self.naks = if more { self.naks + 1 } else { 0 };
        more
    }

    fn take_effect(&mut self) {
        match (self.setup[0], self.setup[1]) {
            (0x00, 5) => self.address = self.setup[2],
            (0x00, 9) => {
                self.configured = true;
                (self.in_toggle, self.out_toggle) = (Toggle::Data0, Toggle::Data0);
                (self.bulk_in, self.bulk_out) = (Toggle::Data0, Toggle::Data0);
            }
            _ => {}
        }
    }

    fn control_in(&mut self) -> Answer {
        if matches!(self.stage, Stage::In(..) | Stage::StatusIn) && self.hesitates() {
            return Answer::Nak;
        }
        match &self.stage {
            Stage::In(data, toggle) => Answer::Data(*toggle, data[..data.len().min(self.packet_bytes)].to_vec()),
            Stage::StatusIn => Answer::Data(Toggle::Data1, Vec::new()),
            Stage::Refused => Answer::Stall,
            _ => Answer::Nak,
        }
    }

    fn control_acknowledged(&mut self) {
        let packet = self.packet_bytes;
        match &mut self.stage {
            Stage::In(data, toggle) => {
                let sent = data.len().min(packet);
                data.drain(..sent);
                *toggle = other(*toggle);
                if sent < packet || data.is_empty() {
                    self.stage = Stage::StatusOut;
                }
            }
            Stage::StatusIn => {
                self.take_effect();
                self.stage = Stage::Idle;
            }
            _ => {}
        }
    }

    fn control_out(&mut self, toggle: Toggle, bytes: &[u8]) -> Handshake {
        let ready = matches!(self.stage, Stage::Out(..) | Stage::StatusOut);
        if ready && self.hesitates() {
            return Handshake::Nak;
        }
        match &mut self.stage {
            Stage::Out(data, length, expected) => {
                if toggle == *expected {
                    data.extend_from_slice(bytes);
                    *expected = other(*expected);
                }
                if data.len() >= *length {
                    self.kept = std::mem::take(data);
                    self.stage = Stage::StatusIn;
                }
                Handshake::Ack
            }
            Stage::StatusOut if bytes.is_empty() && toggle == Toggle::Data1 => {
                self.stage = Stage::Idle;
                Handshake::Ack
            }
            Stage::Idle => Handshake::Ack,
            _ => Handshake::Stall,
        }
    }

    fn report(&mut self) -> Option<Vec<u8>> {
        match self.counting {
            Some(count) => Some(count.to_le_bytes().to_vec()),
            None => self.reports.front().cloned(),
        }
    }
}

impl Device for Gadget {
    fn speed(&self, fastest: Speed) -> Speed {
        match (self.fastest, fastest) {
            (Speed::High, Speed::Full) => Speed::Full,
            (speed, _) => speed,
        }
    }

    fn reset(&mut self, _now: u64, _speed: Speed) {
        self.address = 0;
        self.configured = false;
        self.stage = Stage::Idle;
        (self.in_toggle, self.out_toggle) = (Toggle::Data0, Toggle::Data0);
        (self.bulk_in, self.bulk_out) = (Toggle::Data0, Toggle::Data0);
    }

    fn setup(&mut self, _now: u64, target: Target, packet: [u8; 8]) -> Handshake {
        if target.address != self.address || target.endpoint != 0 {
            return Handshake::Silent;
        }
        self.setups += 1;
        self.setup = packet;
        self.naks = 0;
        self.stage = self.answer(packet).unwrap_or(Stage::Refused);
        Handshake::Ack
    }

    fn data_in(&mut self, now: u64, target: Target) -> Answer {
        if target.address != self.address {
            return Answer::Silent;
        }
        match target.endpoint {
            0 => self.control_in(),
            1 if self.configured => {
                self.polls.push(now);
                if let Some((_, report)) = self.pressed.take_if(|(from, _)| *from <= now) {
                    self.reports.push_back(report);
                }
                self.report().map_or(Answer::Nak, |report| Answer::Data(self.in_toggle, report))
            }
            3 if self.configured => {
                let length = self.bulk.len().min(self.bulk_bytes());
                if length == 0 {
                    return Answer::Nak;
                }
                Answer::Data(self.bulk_in, self.bulk.iter().take(length).copied().collect())
            }
            _ => Answer::Silent,
        }
    }

    fn acknowledged(&mut self, _now: u64, target: Target) {
        match target.endpoint {
            0 => self.control_acknowledged(),
            1 => {
                self.in_toggle = other(self.in_toggle);
                match &mut self.counting {
                    Some(count) => *count += 1,
                    None => drop(self.reports.pop_front()),
                }
            }
            _ => {
                let length = self.bulk.len().min(self.bulk_bytes());
                self.bulk.drain(..length);
                self.bulk_in = other(self.bulk_in);
            }
        }
    }

    fn data_out(&mut self, _now: u64, target: Target, toggle: Toggle, bytes: &[u8]) -> Handshake {
        if target.address != self.address {
            return Handshake::Silent;
        }
        match target.endpoint {
            0 => self.control_out(toggle, bytes),
            2 if self.configured => {
                if toggle == self.out_toggle {
                    self.received.push(bytes.to_vec());
                    self.out_toggle = other(self.out_toggle);
                }
                Handshake::Ack
            }
            3 if self.configured => {
                if toggle == self.bulk_out {
                    self.bulk.extend(bytes);
                    self.bulk_out = other(self.bulk_out);
                }
                if self.nyet { Handshake::Nyet } else { Handshake::Ack }
            }
            _ => Handshake::Silent,
        }
    }
}
