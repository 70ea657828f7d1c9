//! Why a channel halted, and what becomes of the transfer: the retry rules.

use crate::TransferError;
use crate::registers::{Hcint, Hctsiz};
use crate::slot::{Fate, Slot, Split};
use crate::timing::NAK_PAUSE_US;
use crate::transfer::{Next, Program, Stage};

/// Strikes in a row that end a transfer: USB 2.0 §8.5.1 and §11.17.1; hardware facts §4.7.
const STRIKES: u8 = 3;
/// NAKs in a row after which a split pauses: Linux, `hcd_intr.c`.
const NAKS_BEFORE_PAUSE: u8 = 3;
/// The first microframe for a complete split, counted from the start split (EHCI 1.0 §4.12.2).
pub(crate) const FIRST_COMPLETE_SPLIT: u16 = 2;
/// The last one counted from the start split (USB 2.0 §11.18.4; Linux's 4 microframes).
pub(crate) const LAST_COMPLETE_SPLIT: u16 = 4;
/// HCTSIZ's packet identifier after part of a packet came (USB 2.0 §8.4.4).
const MDATA: u8 = 3;
/// HFNUM counts modulo this.
pub(crate) const FRAME_NUMBERS: u16 = 0x4000;

/// Why a channel halted, the most telling reason first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Outcome {
    Complete,
    Stall,
    NoAnswer,
    Babble,
    FrameOverrun,
    WrongToggle,
    Nyet,
    Nak,
    Ack,
    Unknown,
}

/// What becomes of the transfer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// Back on a channel, from this moment on.
    Wait(u64),
    /// The caller sees to the buffer.
    Exchange,
    /// It is over.
    End(Result<usize, TransferError>),
}

impl Outcome {
    fn of(interrupts: Hcint) -> Self {
        let reasons = [
            (interrupts.complete(), Self::Complete),
            (interrupts.stall(), Self::Stall),
            (interrupts.transaction_error(), Self::NoAnswer),
            (interrupts.babble(), Self::Babble),
            (interrupts.frame_overrun(), Self::FrameOverrun),
            (interrupts.toggle_error(), Self::WrongToggle),
            (interrupts.nyet(), Self::Nyet),
            (interrupts.nak(), Self::Nak),
            (interrupts.ack(), Self::Ack),
        ];
        reasons.into_iter().find(|(set, _)| *set).map_or(Self::Unknown, |(_, outcome)| outcome)
    }
}

/// Microframes from `start` to `frame`.
pub(crate) fn frames_since(frame: u16, start: u16) -> u16 {
    frame.wrapping_sub(start) % FRAME_NUMBERS
}

impl Slot {
    /// The channel that ran `program` halted at `now` for reasons `interrupts`, with `left` undone.
    pub(crate) fn halted(&mut self, program: Program, interrupts: Hcint, left: Hctsiz, now: u64) -> Verdict {
        let outcome = Outcome::of(interrupts);
        if matches!(outcome, Outcome::Complete | Outcome::Stall | Outcome::WrongToggle)
            || outcome == Outcome::Nak && self.effort.split != Split::Start
        {
            self.effort.misses = 0;
        }
        let verdict = match outcome {
            Outcome::Complete => self.complete(program, interrupts, left, now),
            Outcome::Stall => Verdict::End(Err(TransferError::Stall)),
            Outcome::Babble => Verdict::End(Err(TransferError::Babble)),
            Outcome::NoAnswer => self.strike(program, left, now),
            Outcome::Nyet | Outcome::Nak | Outcome::Ack => self.handshake(outcome, program, left, now),
            // A periodic transaction that missed its frame; nothing went out. A complete split may have another frame.
            Outcome::FrameOverrun | Outcome::Unknown if self.endpoint.periodic() => Verdict::Wait(now),
            // The packet was a repeated one and was dropped (USB 2.0 §8.6.4): the next one is due.
            Outcome::WrongToggle if self.endpoint.periodic() => self.again(self.next_turn),
            Outcome::FrameOverrun | Outcome::Unknown | Outcome::WrongToggle => self.strike(program, left, now),
        };
        self.seal(verdict)
    }

    fn complete(&mut self, program: Program, interrupts: Hcint, left: Hctsiz, now: u64) -> Verdict {
        let slot = &mut *self;
        slot.effort.errors = 0;
        slot.effort.naks = 0;
        slot.effort.split = Split::Start;
        if slot.endpoint.periodic() && slot.endpoint.splits() && program.input && left.identifier() == MDATA {
            // Part of a packet: the rest is still on the slow bus. The device believes it delivered; better no report
            // than half of one.
            slot.toggle = !slot.toggle;
            return Verdict::Wait(slot.next_turn);
        }
        slot.ping = slot.endpoint.high_speed && !program.input && interrupts.nyet();
        slot.touch(now);
        match slot.effort.transfer.complete(&slot.endpoint, &mut slot.toggle, program, left.bytes() as usize) {
            Next::Program => Verdict::Wait(slot.turn(now)),
            Next::Exchange => Verdict::Exchange,
            Next::End(result) => Verdict::End(result),
        }
    }

    fn handshake(&mut self, outcome: Outcome, program: Program, left: Hctsiz, now: u64) -> Verdict {
        match (outcome, self.effort.split) {
            (Outcome::Nyet, Split::Complete { .. }) => {
                // The translator lives; a SETUP's strikes stay counted (EHCI 1.0 §4.12.1).
                if self.effort.transfer.stage != Stage::Setup {
                    self.effort.errors = 0;
                }
                Verdict::Wait(now)
            }
            (Outcome::Nak, split) if self.endpoint.splits() => {
                if split != Split::Start {
                    self.effort.errors = 0;
                }
                self.effort.naks = self.effort.naks.saturating_add(1);
                // A pause inside a control transfer's IN data upsets some devices (Linux, `hcd_intr.c`).
                let pauses = self.effort.naks >= NAKS_BEFORE_PAUSE && !(program.input && self.in_control_data());
                let pause = if pauses { NAK_PAUSE_US } else { 0 };
                self.again(if self.endpoint.periodic() { self.next_turn } else { now + pause })
            }
            (Outcome::Ack, Split::Start) if self.endpoint.splits() => {
                // The start split is taken; `last_frame` is the microframe that it went out in.
                self.effort.split = Split::Complete { start: self.last_frame.unwrap_or(0) };
                Verdict::Wait(now)
            }
            (Outcome::Nak, _) if self.endpoint.periodic() => {
                self.effort.errors = 0;
                self.again(self.next_turn)
            }
            // A core that leaves the retry to its driver; the device takes a PING before the data again.
            (Outcome::Nak | Outcome::Nyet, _) => {
                self.effort.errors = 0;
                self.broke_off(program, left);
                self.ping = self.endpoint.high_speed && !program.input && self.effort.transfer.stage != Stage::Setup;
                self.again(now)
            }
            _ => self.strike(program, left, now),
        }
    }

    /// The device did not answer, or not in a way that makes sense.
    fn strike(&mut self, program: Program, left: Hctsiz, now: u64) -> Verdict {
        self.broke_off(program, left);
        self.effort.errors += 1;
        if self.effort.errors >= STRIKES {
            return Verdict::End(Err(TransferError::NoAnswer));
        }
        self.again(self.turn(now))
    }

    fn broke_off(&mut self, program: Program, left: Hctsiz) {
        if !self.endpoint.splits() {
            self.effort.transfer.broke_off(&self.endpoint, &mut self.toggle, program, left.packets());
        }
    }

    /// From the start of the transaction.
    fn again(&mut self, from: u64) -> Verdict {
        self.effort.split = Split::Start;
        Verdict::Wait(from)
    }

    /// When the endpoint has its next turn.
    fn turn(&self, now: u64) -> u64 {
        if self.endpoint.periodic() { self.next_turn } else { now }
    }

    fn in_control_data(&self) -> bool {
        self.effort.transfer.is_control() && self.effort.transfer.stage == Stage::Data
    }

    /// The transfer moved: its time-out begins anew.
    pub(crate) fn touch(&mut self, now: u64) {
        let (with_data, without) = self.timeouts;
        let limit = if self.effort.transfer.has_data() { with_data } else { without };
        if self.effort.transfer.is_control() {
            self.effort.deadline = Some(now + limit);
        }
    }

    /// A transfer that is not wanted any more ends, but a translator is not left with an answer that nobody fetches:
    /// its buffer would stay taken (USB 2.0 §11.17.4), and a report would be lost.
    fn seal(&self, verdict: Verdict) -> Verdict {
        match (self.effort.fate, verdict) {
            (Fate::Wanted, _) => verdict,
            _ if self.owes_complete_split() => verdict,
            (Fate::Cancelled, Verdict::End(Ok(_))) if self.endpoint.periodic() && self.effort.transfer.input() => {
                verdict
            }
            (fate, _) => Verdict::End(fate.result()),
        }
    }

    /// A translator holds something for this endpoint until a complete split fetches it.
    pub(crate) fn owes_complete_split(&self) -> bool {
        matches!(self.effort.split, Split::Complete { .. })
    }
}
