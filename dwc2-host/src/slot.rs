//! One pipe's place in the driver: its endpoint, its transfer, and who waits for it.

use core::task::Waker;

use crate::TransferError;
use crate::endpoint::Endpoint;
use crate::transfer::{Program, Transfer};

/// What a pipe is at.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Activity {
    /// Nothing.
    Idle,
    /// Wants a channel, from this moment on.
    Waiting { from: u64 },
    /// On a channel.
    Running { channel: u8, program: Program },
    /// On a channel that was told to halt and has until then.
    Halting { channel: u8, program: Program, until: u64 },
    /// The caller has to fill or empty the buffer.
    Exchange,
    /// Ended.
    Done(Result<usize, TransferError>),
    /// A packet of so many bytes came when nobody waited any more: it is the next request's.
    Kept(usize),
}

/// How far a split transaction is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Split {
    /// The start split is next.
    Start,
    /// The start split went out in this microframe; complete splits are next.
    Complete { start: u16 },
}

/// Whether a transfer is to go on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Fate {
    /// It is.
    Wanted,
    /// Its caller is gone: it ends, and nobody hears of it, as soon as its channel is free.
    Cancelled,
    /// It ends with this as soon as its channel is free.
    Failed(TransferError),
}

/// A transfer that was begun, and how it fares.
pub(crate) struct Effort {
    pub(crate) transfer: Transfer,
    /// It has been on the bus.
    pub(crate) begun: bool,
    pub(crate) split: Split,
    pub(crate) fate: Fate,
    /// Strikes in a row.
    pub(crate) errors: u8,
    /// NAKs in a row that a split met.
    pub(crate) naks: u8,
    /// Turns in a row in which no complete split brought an answer.
    pub(crate) misses: u8,
    /// It fails with `Timeout` when it has not moved by then.
    pub(crate) deadline: Option<u64>,
    /// By then its present channel has halted by itself.
    pub(crate) halts_by: Option<u64>,
    /// When its fate is sealed: by then its channel is told to halt, whatever it is at.
    pub(crate) drained_by: u64,
}

/// A pipe.
pub(crate) struct Slot {
    pub(crate) endpoint: Endpoint,
    /// Its owner is gone: it is given back when its channel is free.
    pub(crate) orphan: bool,
    /// The port was reset since it was allocated.
    pub(crate) stale: bool,
    /// The next data packet is DATA1.
    pub(crate) toggle: bool,
    /// The next data to the device starts with a PING (USB 2.0 §8.5.1).
    pub(crate) ping: bool,
    /// Time-outs of control transfers with data and without, in microseconds.
    pub(crate) timeouts: (u64, u64),
    /// From when on a periodic endpoint may be asked again.
    pub(crate) next_turn: u64,
    /// (Micro)frame of a paced endpoint's last step.
    pub(crate) last_frame: Option<u16>,
    /// Microframe of a periodic endpoint's last start split.
    pub(crate) last_start: Option<u16>,
    pub(crate) activity: Activity,
    /// Meaningful unless `activity` is `Idle` or `Done`.
    pub(crate) effort: Effort,
    pub(crate) waker: Option<Waker>,
}

impl Fate {
    /// How a transfer of this fate ends.
    pub(crate) fn result(self) -> Result<usize, TransferError> {
        Err(match self {
            Self::Failed(error) => error,
            Self::Wanted | Self::Cancelled => TransferError::Disconnected,
        })
    }
}

impl Slot {
    pub(crate) fn new(endpoint: Endpoint) -> Self {
        Self {
            endpoint,
            orphan: false,
            stale: false,
            toggle: false,
            ping: false,
            timeouts: (0, 0),
            next_turn: 0,
            last_frame: None,
            last_start: None,
            activity: Activity::Idle,
            effort: Effort::new(Transfer::data(&endpoint, true, 0, false)),
            waker: None,
        }
    }

    /// A transfer of it is under way, on the bus or between two visits there.
    pub(crate) fn busy(&self) -> bool {
        !matches!(self.activity, Activity::Idle | Activity::Done(_) | Activity::Kept(_))
    }
}

impl Effort {
    pub(crate) fn new(transfer: Transfer) -> Self {
        Self {
            transfer,
            begun: false,
            split: Split::Start,
            fate: Fate::Wanted,
            errors: 0,
            naks: 0,
            misses: 0,
            deadline: None,
            halts_by: None,
            drained_by: 0,
        }
    }
}
