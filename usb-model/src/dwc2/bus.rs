//! Transactions: what a running channel does on the wire.

use super::Core;
use super::channel::Program;
use super::registers::*;
use crate::memory::DmaBus;
use crate::violation::Rule;
use crate::wire::{Answer, Handshake, Speed, Toggle};

/// A packet that long spills over the end of any microframe: the port is disabled (USB 2.0 §11.8.1).
pub(crate) const SPILL_BYTES: usize = 1_024;

/// Microseconds that a transaction with `bytes` bytes of data takes, handshake and pauses in.
pub(crate) fn duration(speed: Speed, bytes: usize) -> u64 {
    let bytes = bytes as u64;
    match speed {
        Speed::High => 1 + bytes / 50,
        Speed::Full => 9 + bytes * 4 / 5,
        Speed::Low => 64 + bytes * 32 / 5,
    }
}

impl Core {
    /// Every channel whose moment has come, in the order of their requests.
    pub(super) fn traffic(&mut self, memory: &mut dyn DmaBus) {
        let due = |core: &Self| {
            let ready = core.channels.iter().enumerate().filter_map(|(index, channel)| {
                let run = channel.run?;
                run.at.filter(|at| *at <= core.now).map(|at| (at, run.order, index))
            });
            ready.min()
        };
        while let Some((_, _, index)) = due(self) {
            self.act(index, memory);
        }
    }

    fn act(&mut self, index: usize, memory: &mut dyn DmaBus) {
        let Some(run) = self.channels[index].run else { return };
        if run.halting {
            return self.finish(index, 0);
        }
        let program = self.channels[index].program();
        if self.wire_free > self.now {
            return self.later(index, self.wire_free);
        }
        let bytes = program.bytes.min(program.packet_bytes);
        let speed = self.wire_speed(&program);
        let end = self.frame_start(self.frame_index(self.now) + 1);
        let fits = self.now + duration(speed, bytes) < end;
        if run.frame.is_some_and(|frame| frame != self.frame_index(self.now)) || !fits && run.frame.is_some() {
            return self.finish(index, HCINT_FRAME_OVERRUN);
        }
        if !fits {
            return self.later(index, end + 1);
        }
        self.transactions += 1;
        self.wire_free = self.now + duration(speed, bytes);
        if let Some(device) = &mut self.device {
            device.low_speed_next(self.port.speed == Some(Speed::Full) && program.low_speed);
        }
        match program.split {
            Some(split) => self.split(index, &program, split, memory),
            None if program.is_setup() => self.setup(index, &program, memory),
            None if program.input => self.input(index, &program, memory),
            None => self.output(index, &program, memory),
        }
        self.hear_complaints();
        for (hub, address, endpoint, input) in self.snoop.take_cleared() {
            self.splits.clear(hub, address, endpoint, input);
        }
    }

    /// Puts a channel off.
    fn later(&mut self, index: usize, at: u64) {
        if let Some(run) = &mut self.channels[index].run {
            run.at = Some(at);
        }
    }

    /// The core tries again by itself, in the next (micro)frame.
    fn retry(&mut self, index: usize) {
        let at = self.frame_start(self.frame_index(self.now) + 1) + 1;
        self.later(index, at);
    }

    /// The channel halts.
    pub(super) fn finish(&mut self, index: usize, reasons: u32) {
        let channel = &mut self.channels[index];
        channel.interrupts |= reasons | HCINT_HALTED;
        channel.run = None;
        self.unsettled = true;
    }

    /// Reads what is to be sent; `None` after a bus error, which leaves the channel running for ever.
    pub(super) fn fetch(&mut self, index: usize, length: usize, memory: &mut dyn DmaBus) -> Option<Vec<u8>> {
        let address = self.channels[index].address;
        let mut bytes = vec![0; length];
        let found = length == 0 || memory.read(address, &mut bytes);
        self.bus_ok(index, found, address).then_some(bytes)
    }

    /// Writes what came; false after a bus error.
    pub(super) fn store(&mut self, index: usize, bytes: &[u8], memory: &mut dyn DmaBus) -> bool {
        let address = self.channels[index].address;
        let found = bytes.is_empty() || memory.write(address, bytes);
        self.bus_ok(index, found, address)
    }

    fn bus_ok(&mut self, index: usize, found: bool, address: u32) -> bool {
        if !found {
            self.blame(Rule::DmaOutside, format!("HCDMA {address:#010x}"));
        }
        let ok = found && !self.defects.bus_error;
        if !ok {
            let channel = &mut self.channels[index];
            channel.interrupts |= HCINT_BUS_ERROR;
            if let Some(run) = &mut channel.run {
                run.at = None;
            }
        }
        ok
    }

    fn setup(&mut self, index: usize, program: &Program, memory: &mut dyn DmaBus) {
        let Some(bytes) = self.fetch(index, program.bytes.min(8), memory) else { return };
        let mut packet = [0; 8];
        packet[..bytes.len()].copy_from_slice(&bytes);
        let Some(device) = &mut self.device else { return };
        match device.setup(self.now, program.target, packet) {
            Handshake::Ack => {
                self.snoop.setup(program, packet);
                self.channels[index].packet_done(8);
                self.finish(index, HCINT_COMPLETE | HCINT_ACK);
            }
            // A device may not answer SETUP with anything but ACK (§8.5.3); what else comes is an error.
            _ => self.finish(index, HCINT_NO_ANSWER),
        }
    }

    fn output(&mut self, index: usize, program: &Program, memory: &mut dyn DmaBus) {
        let length = program.bytes.min(program.packet_bytes);
        let Some(bytes) = self.fetch(index, length, memory) else { return };
        let Some(device) = &mut self.device else { return };
        match device.data_out(self.now, program.target, program.toggle(), &bytes) {
            answer @ (Handshake::Ack | Handshake::Nyet) => {
                let nyet = answer == Handshake::Nyet;
                self.snoop.packet(program, length, nyet);
                self.channels[index].packet_done(length);
                if nyet {
                    self.channels[index].interrupts |= HCINT_NYET;
                }
                if program.packets > 1 {
                    self.later(index, self.wire_free);
                } else {
                    self.finish(index, HCINT_COMPLETE | HCINT_ACK);
                }
            }
            Handshake::Nak if program.periodic() => self.finish(index, HCINT_NAK),
            Handshake::Nak => self.retry(index),
            Handshake::Stall => {
                self.snoop.stall(program);
                self.finish(index, HCINT_STALL);
            }
            Handshake::Silent => self.finish(index, HCINT_NO_ANSWER),
        }
    }

    fn input(&mut self, index: usize, program: &Program, memory: &mut dyn DmaBus) {
        let Some(device) = &mut self.device else { return };
        match device.data_in(self.now, program.target) {
            Answer::Data(toggle, bytes) => self.received(index, program, toggle, &bytes, memory),
            Answer::Nak if program.periodic() => self.finish(index, HCINT_NAK),
            Answer::Nak => self.retry(index),
            Answer::Stall => {
                self.snoop.stall(program);
                self.finish(index, HCINT_STALL);
            }
            Answer::Silent => self.finish(index, HCINT_NO_ANSWER),
        }
    }

    fn received(&mut self, index: usize, program: &Program, toggle: Toggle, bytes: &[u8], memory: &mut dyn DmaBus) {
        if bytes.len() > program.packet_bytes {
            self.finish(index, HCINT_BABBLE);
            if bytes.len() > SPILL_BYTES {
                self.disable_port();
            }
            return;
        }
        self.wire_free = self.now + duration(self.wire_speed(program), bytes.len());
        if let Some(device) = &mut self.device {
            device.acknowledged(self.now, program.target);
        }
        if toggle != program.toggle() {
            return self.finish(index, HCINT_TOGGLE | HCINT_ACK);
        }
        if !self.store(index, bytes, memory) {
            return;
        }
        self.snoop.packet(program, bytes.len(), false);
        self.channels[index].packet_done(bytes.len());
        if program.packets > 1 && bytes.len() == program.packet_bytes {
            self.later(index, self.wire_free);
        } else {
            self.finish(index, HCINT_COMPLETE | HCINT_ACK);
        }
    }

    fn hear_complaints(&mut self) {
        let complaints = self.device.as_mut().map(|device| device.complaints());
        for (rule, detail) in complaints.unwrap_or_default() {
            self.blame(rule, detail);
        }
    }
}
