//! What goes over the wire: tokens, handshakes, and the device that answers them.
//!
//! One call is one transaction (USB 2.0 §8.5). Time is given, in microseconds since power-on; a
//! device keeps no clock of its own, so a run repeats.

use crate::split::Translator;
use crate::violation::Rule;

/// How fast a device signals.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Speed {
    /// 1.5 Mbit/s.
    Low,
    /// 12 Mbit/s.
    Full,
    /// 480 Mbit/s.
    High,
}

/// The data packet's sequence bit (USB 2.0 §8.6).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Toggle {
    /// DATA0.
    Data0,
    /// DATA1.
    Data1,
}

/// Whom a token is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Target {
    /// Device address, 0…127.
    pub address: u8,
    /// Endpoint number without the direction bit, 0…15.
    pub endpoint: u8,
}

/// Answer to SETUP or to data from the host.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Handshake {
    /// Taken (a repeated toggle is acknowledged too, and its data dropped: §8.6.4).
    Ack,
    /// Not now.
    Nak,
    /// Never, or not this request.
    Stall,
    /// Taken, but no more now (high speed).
    Nyet,
    /// No answer: not its address, unplugged, or broken.
    Silent,
}

/// Answer to an IN token.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Answer {
    /// A data packet, however long: one longer than the endpoint's size is babble.
    Data(Toggle, Vec<u8>),
    /// Nothing now.
    Nak,
    /// Never, or not this request.
    Stall,
    /// No answer.
    Silent,
}

/// A device, or a hub with all that hangs on it, seen from the port it is plugged into.
pub trait Device {
    /// Speed that it connects at, given what its port can do at most.
    fn speed(&self, fastest: Speed) -> Speed;

    /// The port signals reset (§7.1.7.5): address 0, not configured, all toggles DATA0.
    fn reset(&mut self, now: u64, speed: Speed);

    /// A SETUP transaction: always DATA0, eight bytes.
    fn setup(&mut self, now: u64, target: Target, packet: [u8; 8]) -> Handshake;

    /// An IN transaction's token and answer.
    fn data_in(&mut self, now: u64, target: Target) -> Answer;

    /// The host acknowledged the data that [`data_in`](Device::data_in) gave last.
    fn acknowledged(&mut self, now: u64, target: Target);

    /// An OUT transaction.
    fn data_out(&mut self, now: u64, target: Target, toggle: Toggle, bytes: &[u8]) -> Handshake;

    /// The next transaction is for a low-speed device (true: on a full-speed bus a preamble goes before it,
    /// §8.6.5) or for one of the bus's own speed. Only hubs care.
    fn low_speed_next(&mut self, _low: bool) {}

    /// Rules that the host broke since the last call; a hub sees some that nobody else does.
    fn complaints(&mut self) -> Vec<(Rule, String)> {
        Vec::new()
    }

    /// The hub's transaction translator, where it has one.
    fn translator(&mut self) -> Option<&mut dyn Translator> {
        None
    }
}

impl<D: Device + ?Sized> Device for Box<D> {
    fn speed(&self, fastest: Speed) -> Speed {
        (**self).speed(fastest)
    }

    fn reset(&mut self, now: u64, speed: Speed) {
        (**self).reset(now, speed);
    }

    fn setup(&mut self, now: u64, target: Target, packet: [u8; 8]) -> Handshake {
        (**self).setup(now, target, packet)
    }

    fn data_in(&mut self, now: u64, target: Target) -> Answer {
        (**self).data_in(now, target)
    }

    fn acknowledged(&mut self, now: u64, target: Target) {
        (**self).acknowledged(now, target);
    }

    fn data_out(&mut self, now: u64, target: Target, toggle: Toggle, bytes: &[u8]) -> Handshake {
        (**self).data_out(now, target, toggle, bytes)
    }
}
