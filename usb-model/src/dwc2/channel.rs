//! A channel's registers, and what they say.

use super::registers::*;
use crate::split::Kind;
use crate::wire::{Target, Toggle};

/// A channel.
#[derive(Debug, Clone, Default)]
pub(super) struct Channel {
    pub characteristics: u32,
    pub split: u32,
    pub interrupts: u32,
    pub mask: u32,
    pub size: u32,
    pub address: u32,
    pub run: Option<Run>,
    /// Its buffer was lent to the core.
    pub lent: bool,
}

/// A channel that was started.
#[derive(Debug, Clone, Copy)]
pub(super) struct Run {
    /// When it does something next; `None` when it never will.
    pub at: Option<u64>,
    /// The (micro)frame that a periodic transaction belongs to.
    pub frame: Option<u64>,
    /// Which of all starts this was.
    pub order: u64,
    /// It was told to halt.
    pub halting: bool,
}

/// What a channel's registers ask for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Program {
    pub target: Target,
    pub input: bool,
    pub kind: Option<Kind>,
    pub packet_bytes: usize,
    pub count: u32,
    pub low_speed: bool,
    pub odd_frame: bool,
    pub identifier: u32,
    pub packets: u32,
    pub bytes: usize,
    pub ping: bool,
    pub address: u32,
    pub split: Option<Split>,
}

/// What HCSPLT asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Split {
    pub hub: u8,
    pub port: u8,
    pub position: u32,
    pub complete: bool,
}

impl Program {
    pub fn is_setup(&self) -> bool {
        self.identifier == SETUP
    }

    pub fn is_control(&self) -> bool {
        self.kind == Some(Kind::Control)
    }

    pub fn periodic(&self) -> bool {
        self.kind == Some(Kind::Interrupt)
    }

    /// The toggle that it starts with; a SETUP is DATA0.
    pub fn toggle(&self) -> Toggle {
        if self.identifier == DATA1 { Toggle::Data1 } else { Toggle::Data0 }
    }

    pub fn name(&self) -> String {
        let way = if self.input { "IN" } else { "OUT" };
        let split = match self.split {
            Some(split) if split.complete => ", complete split",
            Some(_) => ", start split",
            None => "",
        };
        format!("address {} endpoint {} {way}{split}", self.target.address, self.target.endpoint)
    }
}

impl Channel {
    pub fn program(&self) -> Program {
        let (character, size, split) = (self.characteristics, self.size, self.split);
        Program {
            target: Target { address: (character >> 22 & 0x7f) as u8, endpoint: (character >> 11 & 0xf) as u8 },
            input: character & HCCHAR_INPUT != 0,
            kind: match character >> 18 & 3 {
                0 => Some(Kind::Control),
                2 => Some(Kind::Bulk),
                3 => Some(Kind::Interrupt),
                _ => None,
            },
            packet_bytes: (character & 0x7ff) as usize,
            count: character >> 20 & 3,
            low_speed: character & HCCHAR_LOW_SPEED != 0,
            odd_frame: character & HCCHAR_ODD_FRAME != 0,
            identifier: size >> 29 & 3,
            packets: size >> 19 & 0x3ff,
            bytes: (size & 0x7_ffff) as usize,
            ping: size & HCTSIZ_PING != 0,
            address: self.address,
            split: (split & HCSPLT_ENABLE != 0).then_some(Split {
                hub: (split >> 7 & 0x7f) as u8,
                port: (split & 0x7f) as u8,
                position: split >> 14 & 3,
                complete: split & HCSPLT_COMPLETE != 0,
            }),
        }
    }

    /// Takes `bytes` bytes and a packet off what is left, and turns the toggle over.
    pub fn packet_done(&mut self, bytes: usize) {
        let program = self.program();
        let left = program.bytes.saturating_sub(bytes) as u32;
        let packets = program.packets.saturating_sub(1);
        let identifier = if program.identifier == DATA1 { DATA0 } else { DATA1 };
        self.size = identifier << 29 | packets << 19 | left;
        self.address = self.address.wrapping_add(bytes as u32);
    }
}
