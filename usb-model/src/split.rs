//! Split transactions: what a host says to a high-speed hub about a slower device behind it (USB 2.0 §11.14–11.22).

use crate::wire::{Speed, Target, Toggle};

/// Kind of endpoint, as the SPLIT token names it (USB 2.0 §8.4.2.2).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Control.
    Control,
    /// Bulk.
    Bulk,
    /// Interrupt.
    Interrupt,
}

/// A SPLIT token and the token after it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Token {
    /// Address of the hub that is to split.
    pub hub: u8,
    /// Its port.
    pub port: u8,
    /// Kind of the endpoint.
    pub kind: Kind,
    /// Speed of the device: low or full.
    pub speed: Speed,
    /// The device's endpoint.
    pub target: Target,
    /// The data comes from the device.
    pub input: bool,
    /// When this microframe began, in microseconds since power-on.
    pub microframe_start: u64,
    /// Number of this microframe within its frame, 0…7.
    pub microframe: u8,
}

/// What a start split brings.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Start {
    /// A SETUP packet.
    Setup([u8; 8]),
    /// Data for the device.
    Out(Toggle, Vec<u8>),
    /// The wish for data.
    In,
}

/// Answer to a start split. Interrupt endpoints get none on the wire (§11.20): then `Ack` says that a hub heard it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Started {
    /// Taken.
    Ack,
    /// All buffers are taken.
    Nak,
    /// Nobody there.
    Silent,
}

/// Answer to a complete split.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Completed {
    /// The device's data.
    Data(Toggle, Vec<u8>),
    /// The first part of it: MDATA.
    Part(Vec<u8>),
    /// The device took the data.
    Ack,
    /// The device answered NAK.
    Nak,
    /// Not done yet, or unknown.
    Nyet,
    /// The device answered STALL.
    Stall,
    /// The device did not answer: ERR.
    Error,
    /// No hub there.
    Silent,
}

/// A hub with a transaction translator, or one with such hubs behind it.
pub trait Translator {
    /// A start split.
    fn start_split(&mut self, now: u64, token: Token, start: Start) -> Started;

    /// A complete split.
    fn complete_split(&mut self, now: u64, token: Token) -> Completed;
}
