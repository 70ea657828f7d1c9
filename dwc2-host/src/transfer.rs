//! A transfer's stages: what to program next, and what a program's end means. No registers here.

use crate::TransferError;
use crate::endpoint::{Endpoint, Kind};
use crate::hardware::Buffer;

/// HCTSIZ's packet identifiers.
const DATA0: u8 = 0;
const DATA1: u8 = 2;
const SETUP: u8 = 3;

/// Where a transfer stands. One without SETUP has only a data stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stage {
    Setup,
    Data,
    Status,
}

/// A transfer under way.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Transfer {
    pub(crate) stage: Stage,
    control: bool,
    /// Direction of the data stage.
    input: bool,
    /// Bytes asked for.
    total: usize,
    /// Bytes of the chunks before this one.
    moved: usize,
    /// Bytes of this chunk.
    chunk: usize,
    /// Bytes of this chunk that have moved.
    at: usize,
    /// Ends with an empty packet, where the last one is full.
    zero_packet: bool,
}

/// What a channel is told to do once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Program {
    pub(crate) identifier: u8,
    pub(crate) input: bool,
    pub(crate) bytes: usize,
    pub(crate) packets: u16,
    pub(crate) buffer: Buffer,
}

/// What comes after a program that ended well.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Next {
    /// Another program.
    Program,
    /// The caller fills or empties the buffer first.
    Exchange,
    /// Nothing: so many bytes moved, or why not.
    End(Result<usize, TransferError>),
}

impl Transfer {
    /// A transfer of data alone.
    pub(crate) fn data(endpoint: &Endpoint, input: bool, total: usize, zero_packet: bool) -> Self {
        // An interrupt endpoint gives one packet a poll, and the poll is the request.
        let limit = match (endpoint.kind, input) {
            (Kind::Interrupt, true) => usize::from(endpoint.packet_bytes),
            _ => endpoint.chunk_bytes(),
        };
        let zero_packet = zero_packet && total > 0 && total.is_multiple_of(endpoint.packet_bytes.into());
        let chunk = total.min(limit);
        Self { stage: Stage::Data, control: false, input, total, moved: 0, chunk, at: 0, zero_packet }
    }

    /// The same, after a SETUP.
    #[must_use]
    pub(crate) fn with_setup(self) -> Self {
        Self { control: true, stage: Stage::Setup, ..self }
    }

    /// It has a SETUP.
    pub(crate) fn is_control(&self) -> bool {
        self.control
    }

    /// Its data comes from the device.
    pub(crate) fn input(&self) -> bool {
        self.input
    }

    /// It has a data stage.
    pub(crate) fn has_data(&self) -> bool {
        self.total > 0
    }

    /// The part of the caller's bytes that this chunk is.
    pub(crate) fn span(&self) -> (usize, usize) {
        (self.moved, if self.input { self.at.min(self.total - self.moved) } else { self.chunk })
    }

    /// The caller has seen to the buffer: the next chunk.
    pub(crate) fn exchanged(&mut self, endpoint: &Endpoint) {
        self.moved += self.at;
        self.at = 0;
        self.chunk = (self.total - self.moved).min(endpoint.chunk_bytes());
    }

    /// The packet that this transfer is for came before it, and lies in the buffer.
    pub(crate) fn take_kept(&mut self, length: usize) -> Result<usize, TransferError> {
        self.at = length;
        if length > self.total { Err(TransferError::BufferOverflow) } else { Ok(length) }
    }

    /// What to program next; `toggle` is DATA1.
    pub(crate) fn program(&self, endpoint: &Endpoint, toggle: bool) -> Program {
        let packet = usize::from(endpoint.packet_bytes);
        let identifier = if toggle { DATA1 } else { DATA0 };
        match self.stage {
            Stage::Setup => Program { identifier: SETUP, input: false, bytes: 8, packets: 1, buffer: Buffer::Setup },
            Stage::Data => {
                let one = endpoint.paced() || endpoint.periodic();
                let left = self.chunk - self.at;
                let left = if one { left.min(packet) } else { left };
                let packets = left.div_ceil(packet).max(1);
                let bytes = if self.input { packets * packet } else { left };
                Program { identifier, input: self.input, bytes, packets: packets as u16, buffer: Buffer::Data(self.at) }
            }
            Stage::Status => {
                // Opposite to the data; without data, from the device (USB 2.0 §8.5.3).
                let input = !(self.input && self.total > 0);
                let bytes = if input { packet } else { 0 };
                // An empty packet needs no memory, but one that is not empty must not write over anything.
                Program { identifier: DATA1, input, bytes, packets: 1, buffer: Buffer::Data(0) }
            }
        }
    }

    /// A program ended well and left `left` bytes of it.
    pub(crate) fn complete(&mut self, endpoint: &Endpoint, toggle: &mut bool, program: Program, left: usize) -> Next {
        match self.stage {
            Stage::Setup => {
                *toggle = true;
                self.stage = if self.total == 0 { Stage::Status } else { Stage::Data };
                Next::Program
            }
            Stage::Data => self.data_complete(endpoint, toggle, program, left),
            Stage::Status => Next::End(Ok(self.moved + self.at)),
        }
    }

    fn data_complete(&mut self, endpoint: &Endpoint, toggle: &mut bool, program: Program, left: usize) -> Next {
        let packet = usize::from(endpoint.packet_bytes);
        let got = if self.input { program.bytes.saturating_sub(left) } else { program.bytes };
        let short = self.input && got < program.bytes;
        // A short packet, even an empty one, is a packet.
        let packets = if short || program.bytes == 0 { got / packet + 1 } else { got.div_ceil(packet) };
        *toggle ^= packets % 2 == 1;
        self.at += got;
        let all = self.moved + self.at;
        if self.input && all > self.total {
            return Next::End(Err(TransferError::BufferOverflow));
        }
        let ended = if self.input {
            short || all == self.total || endpoint.periodic()
        } else {
            all == self.total && (!self.zero_packet || program.bytes == 0)
        };
        match ended {
            true if self.control => {
                self.stage = Stage::Status;
                Next::Program
            }
            true => Next::End(Ok(all)),
            false if self.at == self.chunk && all < self.total => Next::Exchange,
            false => Next::Program,
        }
    }

    /// A program broke off with `left` packets of it undone; those before have moved.
    pub(crate) fn broke_off(&mut self, endpoint: &Endpoint, toggle: &mut bool, program: Program, left: u16) {
        if self.stage == Stage::Data {
            let done = program.packets.saturating_sub(left);
            *toggle ^= done % 2 == 1;
            self.at = (self.at + usize::from(done) * usize::from(endpoint.packet_bytes)).min(self.chunk);
        }
    }
}
