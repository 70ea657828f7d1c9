//! Split transactions as the core sends them, and their rules.

use std::collections::HashMap;

use super::Core;
use super::channel::{Program, Split};
use super::registers::*;
use crate::memory::DmaBus;
use crate::split::{Completed, Kind, Start, Started, Token};
use crate::violation::Rule;
use crate::wire::Speed;

/// Failures in a row that end a transfer (USB 2.0 §11.17.1).
const STRIKES: u8 = 3;

/// A split endpoint: hub, address, number, and the direction unless it is a control endpoint.
type Pipe = (u8, u8, u8, bool);

/// A start split that waits for its complete split.
#[derive(Debug, Clone, Copy)]
struct Pending {
    /// Microframes since the port was enabled.
    microframe: u64,
    order: u64,
    /// Bytes that it carried.
    bytes: usize,
    /// Data comes from the device.
    input: bool,
    /// The last complete split failed: the start split may be repeated.
    failed: bool,
    /// Complete splits that failed in a row.
    failures: u8,
}

/// What the core has split so far.
#[derive(Debug, Default)]
pub(super) struct SplitWatch {
    pending: HashMap<Pipe, Pending>,
    starts: u64,
    /// Per hub: microframe, and the order of the last start split that was completed in it.
    completed: HashMap<u8, (u64, u64)>,
}

impl SplitWatch {
    /// The translator was told to forget this endpoint.
    pub fn clear(&mut self, hub: u8, address: u8, endpoint: u8, input: bool) {
        self.pending.retain(|key, pending| (key.0, key.1, key.2, pending.input) != (hub, address, endpoint, input));
    }
}

fn pipe(program: &Program, split: Split) -> Pipe {
    let input = program.input && !program.is_control();
    (split.hub, program.target.address, program.target.endpoint, input)
}

impl Core {
    pub(super) fn split(&mut self, index: usize, program: &Program, split: Split, memory: &mut dyn DmaBus) {
        if split.complete {
            self.complete_split(index, program, split, memory);
        } else {
            self.start_split(index, program, split, memory);
        }
    }

    fn token(&self, program: &Program, split: Split) -> Token {
        let microframe = self.frame_index(self.now);
        Token {
            hub: split.hub,
            port: split.port,
            kind: program.kind.unwrap_or(Kind::Control),
            speed: if program.low_speed { Speed::Low } else { Speed::Full },
            target: program.target,
            input: program.input,
            microframe_start: self.frame_start(microframe),
            microframe: (microframe % 8) as u8,
        }
    }

    fn start_split(&mut self, index: usize, program: &Program, split: Split, memory: &mut dyn DmaBus) {
        self.check_start_split(program, split);
        let token = self.token(program, split);
        let start = if program.input {
            Start::In
        } else {
            let Some(bytes) = self.fetch(index, program.bytes.min(program.packet_bytes), memory) else { return };
            match <[u8; 8]>::try_from(bytes.as_slice()) {
                Ok(packet) if program.is_setup() => Start::Setup(packet),
                _ => Start::Out(program.toggle(), bytes),
            }
        };
        let Some(hub) = self.device.as_mut().and_then(|device| device.translator()) else {
            return self.finish(index, HCINT_NO_ANSWER);
        };
        let answer = hub.start_split(self.now, token, start.clone());
        let heard = match answer {
            // Nobody answers a periodic start split; the core takes it as sent.
            _ if program.periodic() => HCINT_ACK,
            Started::Ack => HCINT_ACK,
            Started::Nak => HCINT_NAK,
            Started::Silent => HCINT_NO_ANSWER,
        };
        if heard == HCINT_ACK {
            self.splits.starts += 1;
            let (microframe, order) = (self.frame_index(self.now), self.splits.starts);
            let key = pipe(program, split);
            let failures = self.splits.pending.get(&key).map_or(0, |pending| pending.failures);
            let (bytes, input) = (program.bytes, program.input);
            let pending = Pending { microframe, order, bytes, input, failed: false, failures };
            self.splits.pending.insert(key, pending);
            if let Start::Setup(packet) = start {
                self.snoop.setup(program, packet);
            }
        }
        self.finish(index, heard);
    }

    fn check_start_split(&mut self, program: &Program, split: Split) {
        let microframe = self.frame_index(self.now);
        let owed = self.splits.pending.get(&pipe(program, split));
        match owed.map(|pending| (pending.failed, pending.failures)) {
            _ if program.periodic() => {}
            Some((false, _)) => self.blame(Rule::SplitRestarted, program.name()),
            Some((true, STRIKES..)) => self.blame(Rule::TtNotCleared, program.name()),
            _ => {}
        }
        if program.periodic() && microframe % 8 == 6 {
            self.blame(Rule::StartSplitFrame, format!("{} in microframe {microframe}", program.name()));
        }
    }

    fn complete_split(&mut self, index: usize, program: &Program, split: Split, memory: &mut dyn DmaBus) {
        self.check_complete_split(program, split);
        let token = self.token(program, split);
        let Some(hub) = self.device.as_mut().and_then(|device| device.translator()) else {
            return self.finish(index, HCINT_NO_ANSWER);
        };
        let answer = hub.complete_split(self.now, token);
        let key = pipe(program, split);
        match answer {
            Completed::Nyet => {
                // The translator lives; a SETUP's failures stay counted (EHCI 1.0 §4.12.1).
                if let Some(pending) = self.splits.pending.get_mut(&key).filter(|_| !program.is_setup()) {
                    pending.failures = 0;
                }
                return self.finish(index, HCINT_NYET);
            }
            Completed::Error | Completed::Silent => {
                if let Some(pending) = self.splits.pending.get_mut(&key) {
                    pending.failed = true;
                    pending.failures = pending.failures.saturating_add(1);
                }
                return self.finish(index, HCINT_NO_ANSWER);
            }
            _ => {}
        }
        let carried = self.splits.pending.remove(&key).map_or(0, |pending| pending.bytes);
        match answer {
            Completed::Data(toggle, bytes) => {
                self.split_data(index, program, toggle == program.toggle(), &bytes, memory)
            }
            Completed::Part(bytes) if bytes.len() > program.packet_bytes => self.finish(index, HCINT_BABBLE),
            Completed::Part(bytes) => {
                self.snoop.part(program);
                if self.store(index, &bytes, memory) {
                    let channel = &mut self.channels[index];
                    channel.packet_done(bytes.len());
                    channel.size |= MDATA << 29;
                    self.finish(index, HCINT_COMPLETE | HCINT_ACK);
                }
            }
            Completed::Ack => {
                // A SETUP was noted when its start split was taken.
                if !program.is_setup() {
                    self.snoop.packet(program, carried, false);
                }
                self.channels[index].packet_done(0);
                self.finish(index, HCINT_COMPLETE | HCINT_ACK);
            }
            Completed::Nak => self.finish(index, HCINT_NAK),
            _ => {
                self.snoop.stall(program);
                self.finish(index, HCINT_STALL);
            }
        }
    }

    fn split_data(&mut self, index: usize, program: &Program, right: bool, bytes: &[u8], memory: &mut dyn DmaBus) {
        if bytes.len() > program.packet_bytes {
            return self.finish(index, HCINT_BABBLE);
        }
        if !right {
            return self.finish(index, HCINT_TOGGLE | HCINT_ACK);
        }
        if self.store(index, bytes, memory) {
            self.snoop.packet(program, bytes.len(), false);
            self.channels[index].packet_done(bytes.len());
            self.finish(index, HCINT_COMPLETE | HCINT_ACK);
        }
    }

    fn check_complete_split(&mut self, program: &Program, split: Split) {
        let microframe = self.frame_index(self.now);
        let Some(pending) = self.splits.pending.get(&pipe(program, split)).copied() else {
            return self.blame(Rule::CompleteWithoutStart, program.name());
        };
        if !program.periodic() {
            return;
        }
        let since = microframe - pending.microframe;
        if !(2..=4).contains(&since) {
            self.blame(Rule::CompleteSplitFrame, format!("{} {since} microframes after its start", program.name()));
        }
        let last = self.splits.completed.entry(split.hub).or_default();
        let out_of_order = last.0 == microframe && last.1 > pending.order;
        *last = (microframe, pending.order.max(if last.0 == microframe { last.1 } else { 0 }));
        if out_of_order {
            self.blame(Rule::CompleteSplitOrder, program.name());
        }
    }
}
