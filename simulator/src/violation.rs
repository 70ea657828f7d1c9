//! Why a run was stopped: something that would not work, or not surely, on the board.

use std::fmt;

use crate::time::{Clocks, in_milliseconds};

/// What the processor did to an address.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Access {
    /// Fetched an instruction.
    Fetch,
    /// Read so many bytes.
    Read(u32),
    /// Wrote so many bytes of this value.
    Write(u32, u32),
    /// Did cache maintenance by address, or read and wrote a coprocessor's register.
    Maintenance,
    /// A bus master other than the processor read.
    DmaRead,
    /// A bus master other than the processor wrote.
    DmaWrite,
    /// Broke a rule of a bus that the block drives.
    Protocol,
}

impl fmt::Display for Access {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fetch => write!(out, "instruction fetch from"),
            Self::Read(bytes) => write!(out, "{bytes}-byte read from"),
            Self::Write(bytes, value) => write!(out, "{bytes}-byte write of {value:#x} to"),
            Self::Maintenance => write!(out, "maintenance of"),
            Self::DmaRead => write!(out, "DMA read from"),
            Self::DmaWrite => write!(out, "DMA write to"),
            Self::Protocol => write!(out, "broken rule at"),
        }
    }
}

/// An access that the simulator refuses, and the run ends with.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Violation {
    /// What was done.
    pub access: Access,
    /// The physical address.
    pub address: u32,
    /// What lies there, as the board's documents name it.
    pub block: String,
    /// What is wrong, and what the access needed.
    pub needed: String,
    /// The instruction's address, or the last one's where a bus master did it.
    pub instruction: u32,
    /// The instruction as text, where it can be read.
    pub disassembly: String,
    /// When.
    pub time: Clocks,
}

impl fmt::Display for Violation {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { access, address, block, needed, .. } = self;
        writeln!(out, "{access} {address:#010x} ({block}): {needed}")?;
        write!(out, "  instruction at {:#010x}", self.instruction)?;
        if !self.disassembly.is_empty() {
            write!(out, ": {}", self.disassembly)?;
        }
        write!(out, "; {:.3} ms after power-on", in_milliseconds(self.time))
    }
}

impl std::error::Error for Violation {}
