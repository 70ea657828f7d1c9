//! Channels: handing a pipe's next step to the core, taking it back, and stopping what takes too long.

use crate::endpoint::{Endpoint, Kind, Route};
use crate::hardware::Buffer;
use crate::outcome::{FIRST_COMPLETE_SPLIT, FRAME_NUMBERS, LAST_COMPLETE_SPLIT, Verdict, frames_since};
use crate::port::Phase;
use crate::registers::{Hcchar, Hcdma, Hcint, Hcsplt, Hctsiz, Hfnum};
use crate::slot::{Activity, Fate, Slot, Split};
use crate::state::State;
use crate::timing::{HALT_LIMIT_US, SPLIT_DRAIN_US};
use crate::transfer::{Program, Stage};
use crate::{Fault, PIPES, TransferError};

/// The last microframe of a frame in which a periodic start split goes out: its complete splits end in the same frame,
/// and microframe 6 stays free of start splits (USB 2.0 §11.18.4).
const LAST_START_SPLIT: u16 = 3;
/// What the core may retry by itself in one microframe of a periodic split: Linux, `hcd.c`.
const SPLIT_RETRIES: u8 = 3;
/// Turns in a row without an answer after which an interrupt endpoint behind a translator is taken for silent: a quarter
/// of a second or more.
const MISSES: u8 = 250;

/// HCSPLT's payload position: all of it at once (it has at most 188 bytes).
const WHOLE_PAYLOAD: u8 = 3;
/// Every bit of HCINT.
const ALL_REASONS: u32 = 0x3fff;

/// Whether a pipe's next step can go to a channel.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Turn {
    /// No, and the next (micro)frame changes nothing in that.
    Later,
    /// No, but maybe in the next (micro)frame.
    NextFrame,
    /// Yes: its rank, and the (micro)frame that it goes out in.
    Now(u32, u16),
}

/// Ranks: of several steps that are due, the lowest comes first.
///
/// Complete splits have theirs by the microframes that they have left, so that they keep the order of their start splits
/// (USB 2.0 §11.18.8, as Linux reads it); interrupt endpoints by their interval, which is more: those with a short one
/// can wait least for the next frame; control and bulk this.
const LAST_RANK: u32 = u32::MAX;

impl State<'_> {
    /// A channel's HCINT holds something.
    pub(crate) fn channel_interrupt(&mut self, channel: u8, now: u64) {
        let interrupts: Hcint = self.hardware.read_channel(channel);
        self.hardware.write_channel(channel, interrupts);
        if interrupts.bus_error() {
            return self.fail(Fault::DmaError { channel }, now);
        }
        if !interrupts.halted() {
            return;
        }
        let Some(index) = self.channels[usize::from(channel)].take() else { return };
        let Some(slot) = &mut self.slots[index] else { return };
        let (Activity::Running { program, .. } | Activity::Halting { program, .. }) = slot.activity else { return };
        // Of a split that moved nothing, nothing is left to know.
        let moved = interrupts.complete() || !slot.endpoint.splits();
        let left = if moved { self.hardware.read_channel(channel) } else { Hctsiz::default() };
        if program.input && moved {
            self.hardware.invalidate(index, program.buffer, program.bytes);
        }
        match slot.halted(program, interrupts, left, now) {
            Verdict::Wait(from) => slot.activity = Activity::Waiting { from },
            Verdict::Exchange => {
                slot.effort.deadline = None;
                slot.activity = Activity::Exchange;
                self.stirred = true;
            }
            Verdict::End(result) => self.end(index, result),
        }
    }

    /// Finds the endpoints behind translators whose turn comes before the next poll. Only here, once a millisecond, so
    /// that frames are watched no longer than it takes to come to the microframes that start splits go out in.
    pub(crate) fn call_turns(&mut self, now: u64) {
        for slot in self.slots.iter_mut().flatten() {
            if let Activity::Waiting { from } = &mut slot.activity
                && slot.endpoint.periodic()
                && slot.endpoint.splits()
                && *from <= now + slot.endpoint.lead_us()
            {
                *from = (*from).min(now);
            }
        }
    }

    /// Starts every step that is due, as far as there are channels, and lets the start of the next (micro)frame
    /// interrupt if somebody waits for that.
    pub(crate) fn launch(&mut self, now: u64) {
        if self.phase != Phase::Ready {
            // A core that is being started has its interrupts masked, and is to be left alone.
            if self.phase.started() {
                self.watch_frames(false);
            }
            return;
        }
        // All steps of one visit go by one look at the (micro)frame. If the next one begins before the step is handed
        // over, the core sends it in that one, at once: what goes out in the present (micro)frame, and what waits for
        // the next, is all that HCCHAR.ODDFRM says (Linux, `hcd.c`, dwc2_hc_set_even_odd_frame).
        let mut frame = None;
        loop {
            let mut first: Option<(u32, u16, usize)> = None;
            let mut watch = false;
            for index in 0..PIPES {
                match self.turn_of(index, &mut frame, now) {
                    Turn::Now(rank, frame) if first.is_none_or(|(other, ..)| rank < other) => {
                        first = Some((rank, frame, index));
                    }
                    turn => watch |= turn == Turn::NextFrame,
                }
            }
            let free = self.channels.iter().take(self.channel_count).position(Option::is_none);
            let (Some((_, frame, index)), Some(channel)) = (first, free) else { return self.watch_frames(watch) };
            self.start(index, channel as u8, frame, now);
        }
    }

    /// Whether a pipe's next step can go to a channel; `seen` is the (micro)frame, once somebody needs to know it.
    fn turn_of(&mut self, index: usize, seen: &mut Option<u16>, now: u64) -> Turn {
        let Some(slot) = &self.slots[index] else { return Turn::Later };
        let Activity::Waiting { from } = slot.activity else { return Turn::Later };
        let (endpoint, split) = (slot.endpoint, slot.effort.split);
        let lead = if endpoint.periodic() && !endpoint.splits() { endpoint.lead_us() } else { 0 };
        if from > now + lead || self.has_rival(index, slot) {
            return Turn::Later;
        }
        if !endpoint.periodic() && !endpoint.paced() {
            return Turn::Now(LAST_RANK, 0);
        }
        let frame = match *seen {
            Some(frame) => frame,
            None => *seen.insert(self.hardware.read::<Hfnum>().number()),
        };
        if !endpoint.periodic() {
            let taken = slot.last_frame == Some(frame)
                || endpoint.route == Route::Preamble && self.preamble_frame == Some(frame);
            return if taken { Turn::NextFrame } else { Turn::Now(LAST_RANK, frame) };
        }
        let next = (frame + 1) % FRAME_NUMBERS;
        match (endpoint.route, split) {
            (Route::Split { hub, .. }, Split::Complete { start }) => match frames_since(next, start) {
                0..FIRST_COMPLETE_SPLIT => Turn::NextFrame,
                age @ FIRST_COMPLETE_SPLIT..=LAST_COMPLETE_SPLIT if !self.runs_older_split(hub, start) => {
                    Turn::Now((LAST_COMPLETE_SPLIT - age).into(), next)
                }
                FIRST_COMPLETE_SPLIT..=LAST_COMPLETE_SPLIT => Turn::Later,
                _ => {
                    self.give_up_split(index);
                    Turn::Later
                }
            },
            (Route::Split { hub, .. }, Split::Start) => {
                let taken = |other: &Slot| other.last_start == Some(next) && other.endpoint.hub() == Some(hub);
                if next % 8 > LAST_START_SPLIT {
                    Turn::NextFrame
                } else if slot.last_start.is_some_and(|start| start / 8 == next / 8) {
                    // It had its turn in this frame. A later poll may do without the frames in between.
                    Turn::Later
                } else if self.slots.iter().flatten().any(taken) {
                    Turn::NextFrame
                } else {
                    Turn::Now(endpoint.interval_us, next)
                }
            }
            (Route::Preamble, _) if self.preamble_frame == Some(next) => Turn::NextFrame,
            _ => Turn::Now(endpoint.interval_us, next),
        }
    }

    /// A complete split is on its way whose start split is older than this one: it may have to go out again, and then
    /// goes first.
    fn runs_older_split(&self, hub: u8, start: u16) -> bool {
        let older = |slot: &Slot| match (slot.activity, slot.effort.split) {
            (Activity::Running { .. }, Split::Complete { start: other }) => {
                let age = frames_since(start, other);
                slot.endpoint.periodic() && slot.endpoint.hub() == Some(hub) && (1..=LAST_COMPLETE_SPLIT).contains(&age)
            }
            _ => false,
        };
        self.slots.iter().flatten().any(older)
    }

    /// Another pipe to the same control endpoint is in the middle of a transfer.
    fn has_rival(&self, index: usize, slot: &Slot) -> bool {
        let same = |other: &Slot| {
            other.endpoint.kind == Kind::Control
                && other.endpoint.address == slot.endpoint.address
                && other.endpoint.number == slot.endpoint.number
        };
        let begun = |other: &Slot| other.effort.begun && other.busy();
        slot.endpoint.kind == Kind::Control
            && !slot.effort.begun
            && self
                .slots
                .iter()
                .enumerate()
                .any(|(at, other)| at != index && other.as_ref().is_some_and(|other| same(other) && begun(other)))
    }

    /// A periodic split whose last microframe has passed begins anew at the endpoint's next turn.
    fn give_up_split(&mut self, index: usize) {
        let Some(slot) = &mut self.slots[index] else { return };
        slot.effort.split = Split::Start;
        slot.effort.misses = slot.effort.misses.saturating_add(1);
        slot.activity = Activity::Waiting { from: slot.next_turn };
        let (fate, misses) = (slot.effort.fate, slot.effort.misses);
        if fate != Fate::Wanted {
            self.end(index, fate.result());
        } else if misses >= MISSES {
            self.end(index, Err(TransferError::NoAnswer));
        }
    }

    /// Hands a pipe's next step to a channel, to go out in `frame`.
    fn start(&mut self, index: usize, channel: u8, frame: u16, now: u64) {
        let Some(slot) = &mut self.slots[index] else { return };
        let endpoint = slot.endpoint;
        if !core::mem::replace(&mut slot.effort.begun, true) || slot.effort.deadline.is_none() {
            slot.touch(now);
        }
        let program = slot.effort.transfer.program(&endpoint, slot.toggle);
        let complete = matches!(slot.effort.split, Split::Complete { .. });
        if endpoint.periodic() && !complete {
            slot.next_turn = now + endpoint.lead_us() + u64::from(endpoint.interval_us) - endpoint.slack_us();
            slot.last_start = Some(frame);
        }
        slot.last_frame = Some(frame);
        let halts = endpoint.splits() || endpoint.periodic() && !self.config.patient_interrupts;
        slot.effort.halts_by = halts.then(|| now + u64::from(self.config.halt_limit_us));
        if endpoint.route == Route::Preamble {
            self.preamble_frame = Some(frame);
        }
        let data = program.buffer != Buffer::Setup && slot.effort.transfer.stage == Stage::Data;
        let ping = data && !program.input && core::mem::take(&mut slot.ping);
        slot.activity = Activity::Running { channel, program };
        self.channels[usize::from(channel)] = Some(index);
        self.program(index, channel, &endpoint, program, Step { complete, ping, frame });
    }

    fn program(&mut self, index: usize, channel: u8, endpoint: &Endpoint, program: Program, step: Step) {
        // A complete split to the device carries no data: the start split did.
        let bytes = if step.complete && !program.input { 0 } else { program.bytes };
        if program.input {
            self.hardware.invalidate(index, program.buffer, bytes);
        } else if bytes > 0 {
            self.hardware.clean(index, program.buffer, bytes);
        }
        let split = match endpoint.route {
            Route::Split { hub, port } => Hcsplt::default()
                .with_enable(true)
                .with_hub(hub)
                .with_port(port)
                .with_position(WHOLE_PAYLOAD)
                .with_complete(step.complete),
            _ => Hcsplt::default(),
        };
        let size = Hctsiz::default()
            .with_bytes(bytes as u32)
            .with_packets(program.packets)
            .with_identifier(program.identifier)
            .with_ping(step.ping);
        let address = self.hardware.bus_address(index, program.buffer);
        let core = &mut self.hardware;
        core.write_channel(channel, Hcint(ALL_REASONS));
        core.write_channel(channel, split);
        core.write_channel(channel, size);
        core.write_channel(channel, Hcdma(address));
        core.write_channel(
            channel,
            Hcchar::default()
                .with_packet_bytes(endpoint.packet_bytes)
                .with_endpoint(endpoint.number)
                .with_input(program.input)
                .with_low_speed(endpoint.low_speed)
                .with_kind(endpoint.kind as u8)
                .with_count(if endpoint.periodic() && endpoint.splits() { SPLIT_RETRIES } else { 1 })
                .with_address(endpoint.address)
                .with_odd_frame(endpoint.periodic() && step.frame % 2 == 1)
                .with_enable(true),
        );
    }

    /// Tells a channel to halt.
    fn halt(&mut self, index: usize, now: u64) {
        let Some(Slot { activity, .. }) = &mut self.slots[index] else { return };
        if let Activity::Running { channel, program } = *activity {
            *activity = Activity::Halting { channel, program, until: now + HALT_LIMIT_US };
            let characteristics: Hcchar = self.hardware.read_channel(channel);
            self.hardware.write_channel(channel, characteristics.with_enable(true).with_disable(true));
        }
    }

    /// Seals a transfer's fate: it ends as soon as its channel is free.
    pub(crate) fn abandon(&mut self, index: usize, fate: Fate, now: u64) {
        let Some(slot) = &mut self.slots[index] else { return };
        if let Activity::Done(_) = slot.activity {
            slot.activity = Activity::Idle;
        }
        if !slot.busy() {
            return;
        }
        slot.effort.fate = fate;
        slot.effort.deadline = None;
        slot.effort.drained_by = now + SPLIT_DRAIN_US;
        match slot.activity {
            Activity::Waiting { .. } if slot.owes_complete_split() => {}
            Activity::Waiting { .. } | Activity::Exchange => self.end(index, fate.result()),
            // A periodic channel halts at the end of its (micro)frame and cannot be told to (`espressif/esp-usb` PR 577);
            // a split's step is short, and a translator's answer is fetched first.
            Activity::Running { .. } if slot.endpoint.periodic() || slot.endpoint.splits() => {}
            _ => self.halt(index, now),
        }
    }

    /// Stops what takes too long.
    pub(crate) fn check_deadlines(&mut self, now: u64) {
        let passed = |limit: Option<u64>| limit.is_some_and(|limit| now >= limit);
        for index in 0..PIPES {
            let Some(slot) = &self.slots[index] else { continue };
            let effort = &slot.effort;
            match slot.activity {
                Activity::Halting { channel, until, .. } if now >= until => {
                    return self.fail(Fault::ChannelStuck { channel }, now);
                }
                Activity::Running { channel, .. } if passed(effort.halts_by) => {
                    return self.fail(Fault::ChannelStuck { channel }, now);
                }
                Activity::Running { .. } if effort.fate != Fate::Wanted && now >= effort.drained_by => {
                    self.halt(index, now);
                }
                Activity::Waiting { .. } if effort.fate != Fate::Wanted && now >= effort.drained_by => {
                    let fate = effort.fate;
                    self.end(index, fate.result());
                }
                Activity::Running { .. } | Activity::Waiting { .. } if passed(effort.deadline) => {
                    self.abandon(index, Fate::Failed(TransferError::Timeout), now);
                }
                _ => {}
            }
        }
    }
}

/// What a program does not say about a step.
struct Step {
    /// A complete split.
    complete: bool,
    /// Ask by PING first.
    ping: bool,
    /// The (micro)frame that it goes out in.
    frame: u16,
}
