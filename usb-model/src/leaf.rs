//! A device with one configuration: endpoint 0, toggles, and the waits that a host owes it.
//!
//! It answers as USB 2.0 §8 and §9 say and writes down what a host does wrong
//! ([`Leaf::violations`]), so that a test can ask for none.

mod control;

use std::collections::VecDeque;

use crate::wire::{Answer, Device, Handshake, Speed, Target, Toggle};
use control::Control;

/// After a reset a device may be deaf this long (USB 2.0 §7.1.7.5).
pub const RESET_RECOVERY_US: u64 = 10_000;
/// After SET_ADDRESS a device may be deaf this long (USB 2.0 §9.2.6.3).
pub const ADDRESS_RECOVERY_US: u64 = 2_000;

/// What a device tells of itself.
#[derive(Debug, Clone, Default)]
pub struct Descriptors {
    /// The device descriptor.
    pub device: Vec<u8>,
    /// The configuration descriptor with all that belongs to it.
    pub configuration: Vec<u8>,
    /// Strings from index 1 on.
    pub strings: Vec<String>,
    /// Report descriptors by interface.
    pub reports: Vec<Vec<u8>>,
}

/// What a device does beyond being a device.
pub trait Function {
    /// Answers a request of a class or a vendor, or for an interface, that reads; `None` refuses it.
    fn request_in(&mut self, now: u64, setup: [u8; 8]) -> Option<Vec<u8>>;

    /// Answers one that writes, with its data; false refuses it.
    fn request_out(&mut self, now: u64, setup: [u8; 8], data: &[u8]) -> bool;

    /// Returns what an interrupt or bulk IN endpoint has now; `None` for nothing yet.
    fn input(&mut self, now: u64, endpoint: u8) -> Option<Vec<u8>>;

    /// Takes what came to an OUT endpoint, a packet.
    fn output(&mut self, _now: u64, _endpoint: u8, _packet: &[u8]) {}

    /// The port was reset.
    fn reset(&mut self) {}
}

/// One direction of an endpoint.
#[derive(Debug, Clone, Default)]
struct Pipe {
    toggle_is_one: bool,
    halted: bool,
    /// Packets of the report that is under way.
    packets: VecDeque<Vec<u8>>,
}

/// A device with one configuration.
pub struct Leaf<F> {
    /// What it does.
    pub function: F,
    /// What it tells of itself.
    pub descriptors: Descriptors,
    speed: Speed,
    address: u8,
    configured: bool,
    control: Control,
    inputs: [Pipe; 16],
    outputs: [Pipe; 16],
    deaf_until: u64,
    violations: Vec<String>,
}

impl<F: Function> Leaf<F> {
    /// Returns a device that signals at a speed, or slower if its port does.
    pub fn new(speed: Speed, descriptors: Descriptors, function: F) -> Self {
        Self {
            function,
            descriptors,
            speed,
            address: 0,
            configured: false,
            control: Control::default(),
            inputs: Default::default(),
            outputs: Default::default(),
            deaf_until: 0,
            violations: Vec::new(),
        }
    }

    /// What the host has done wrong so far.
    pub fn violations(&self) -> &[String] {
        &self.violations
    }

    /// Whether SET_CONFIGURATION has chosen its configuration.
    pub fn is_configured(&self) -> bool {
        self.configured
    }

    /// Its address; 0 until it has one.
    pub fn address(&self) -> u8 {
        self.address
    }

    /// Halts an IN endpoint, until the host clears that (USB 2.0 §9.4.5).
    pub fn halt(&mut self, endpoint: u8) {
        self.inputs[usize::from(endpoint)].halted = true;
    }

    fn blame(&mut self, what: impl Into<String>) {
        self.violations.push(what.into());
    }

    /// Tells whether a token is for it, and it listens.
    fn listens(&mut self, now: u64, target: Target) -> bool {
        if target.address != self.address {
            return false;
        }
        if now < self.deaf_until {
            let early = self.deaf_until - now;
            self.blame(format!("a token {early} µs before the end of a recovery"));
            return false;
        }
        true
    }

    /// Packet size of an endpoint, from its descriptor; `None` if there is no such endpoint.
    fn packet_size(&self, address: u8) -> Option<usize> {
        let mut rest = &self.descriptors.configuration[..];
        while let [length, kind, ..] = *rest {
            let length = usize::from(length);
            if length < 2 || length > rest.len() {
                return None;
            }
            if kind == 5 && length >= 7 && rest[2] == address {
                return Some(usize::from(u16::from_le_bytes([rest[4], rest[5]]) & 0x7FF));
            }
            rest = &rest[length..];
        }
        None
    }

    fn control_packet_size(&self) -> usize {
        self.descriptors.device.get(7).map_or(8, |&size| usize::from(size).max(1))
    }

    fn set_configured(&mut self, configured: bool) {
        self.configured = configured;
        self.inputs = Default::default();
        self.outputs = Default::default();
    }
}

impl<F: Function> Device for Leaf<F> {
    fn speed(&self, fastest: Speed) -> Speed {
        match (self.speed, fastest) {
            (Speed::High, Speed::Full) => Speed::Full,
            (speed, _) => speed,
        }
    }

    fn reset(&mut self, now: u64, _speed: Speed) {
        self.address = 0;
        self.control = Control::default();
        self.set_configured(false);
        self.deaf_until = now + RESET_RECOVERY_US;
        self.function.reset();
    }

    fn setup(&mut self, now: u64, target: Target, packet: [u8; 8]) -> Handshake {
        if !self.listens(now, target) {
            return Handshake::Silent;
        }
        if target.endpoint != 0 {
            self.blame("SETUP to an endpoint other than 0");
            return Handshake::Silent;
        }
        self.begin_control(now, packet);
        Handshake::Ack
    }

    fn data_in(&mut self, now: u64, target: Target) -> Answer {
        if !self.listens(now, target) {
            return Answer::Silent;
        }
        if target.endpoint == 0 {
            return self.control_in(now);
        }
        let index = usize::from(target.endpoint);
        let Some(size) = self.packet_size(0x80 | target.endpoint).filter(|_| self.configured && index < 16) else {
            self.blame(format!("IN from endpoint {index}, which there is not"));
            return Answer::Silent;
        };
        if self.inputs[index].halted {
            return Answer::Stall;
        }
        if self.inputs[index].packets.is_empty() {
            let Some(report) = self.function.input(now, target.endpoint) else { return Answer::Nak };
            self.inputs[index].packets.extend(report.chunks(size.max(1)).map(<[u8]>::to_vec));
        }
        let pipe = &self.inputs[index];
        let toggle = if pipe.toggle_is_one { Toggle::Data1 } else { Toggle::Data0 };
        Answer::Data(toggle, pipe.packets.front().cloned().unwrap_or_default())
    }

    fn acknowledged(&mut self, now: u64, target: Target) {
        if target.address != self.address {
            return;
        }
        if target.endpoint == 0 {
            self.control_acknowledged(now);
        } else {
            let pipe = &mut self.inputs[usize::from(target.endpoint & 0xF)];
            if pipe.packets.pop_front().is_some() {
                pipe.toggle_is_one = !pipe.toggle_is_one;
            }
        }
    }

    fn data_out(&mut self, now: u64, target: Target, toggle: Toggle, bytes: &[u8]) -> Handshake {
        if !self.listens(now, target) {
            return Handshake::Silent;
        }
        if target.endpoint == 0 {
            return self.control_out(toggle, bytes);
        }
        let index = usize::from(target.endpoint);
        let Some(size) = self.packet_size(target.endpoint).filter(|_| self.configured && index < 16) else {
            self.blame(format!("OUT to endpoint {index}, which there is not"));
            return Handshake::Silent;
        };
        if bytes.len() > size {
            self.blame(format!("{} bytes to an endpoint of {size}", bytes.len()));
            return Handshake::Silent;
        }
        let pipe = &mut self.outputs[index];
        if pipe.halted {
            return Handshake::Stall;
        }
        if (toggle == Toggle::Data1) == pipe.toggle_is_one {
            pipe.toggle_is_one = !pipe.toggle_is_one;
            self.function.output(now, target.endpoint, bytes);
        }
        Handshake::Ack
    }
}
