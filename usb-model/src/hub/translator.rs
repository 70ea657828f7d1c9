//! A transaction translator for all ports of a hub (USB 2.0 §11.14–11.22).

use super::port::Port;
use crate::dwc2::slow_duration as duration;
use crate::split::{Completed, Kind, Start, Started, Token};
use crate::violation::Rule;
use crate::wire::{Answer, Device, Handshake, Speed, Target, Toggle};

/// Buffers for control and bulk endpoints: at least two (§11.17.4).
const BUFFERS: usize = 2;
/// A microframe.
const MICROFRAME_US: u64 = 125;
/// A frame.
const FRAME_US: u64 = 1_000;
/// Microframes after which what was not started, or not fetched, of a periodic endpoint is dropped (§11.18.6).
const PATIENCE_US: u64 = 4 * MICROFRAME_US;
/// What lies unfetched that long in a control or bulk endpoint's buffer was forgotten by the host.
const FORGOTTEN_US: u64 = 50_000;

/// How far a transaction on the slow bus is.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Progress {
    /// Not before this moment.
    Waiting(u64),
    /// It began and ends at these moments, like this.
    Done(u64, u64, Completed),
}

/// A transaction for the slow bus.
#[derive(Debug, Clone)]
struct Job {
    token: Token,
    start: Start,
    progress: Progress,
    told: bool,
}

/// The translator.
#[derive(Debug, Default)]
pub(super) struct Engine {
    buffers: Vec<Job>,
    periodic: Vec<Job>,
    /// The slow bus is free from then on.
    free: u64,
    /// Some frame began then.
    epoch: u64,
}

/// The same endpoint of the same device; of a control endpoint, either direction.
fn same(a: &Token, b: &Token) -> bool {
    a.target == b.target && a.kind == b.kind && (a.kind == Kind::Control || a.input == b.input)
}

impl Engine {
    pub fn clear(&mut self, target: Target, input: bool) {
        self.buffers.retain(|job| job.token.target != target || job.token.input != input);
    }

    pub fn reset(&mut self) {
        self.buffers.clear();
        self.periodic.clear();
    }

    /// A start split.
    pub fn start(&mut self, now: u64, token: Token, start: Start) -> Started {
        self.epoch = token.microframe_start - u64::from(token.microframe) * MICROFRAME_US;
        let job = |from| Job { token, start, progress: Progress::Waiting(from), told: false };
        if token.kind == Kind::Interrupt {
            self.periodic.retain(|job| !same(&job.token, &token));
            // It goes to the slow bus in the next microframe (§11.18.2).
            self.periodic.push(job(token.microframe_start + MICROFRAME_US));
            return Started::Ack;
        }
        if self.buffers.iter().any(|job| same(&job.token, &token)) {
            // The host repeats itself (§11.17.4, figure 11-47).
            return Started::Ack;
        }
        if self.buffers.len() == BUFFERS {
            return Started::Nak;
        }
        self.buffers.push(job(now));
        Started::Ack
    }

    /// A complete split.
    pub fn complete(&mut self, now: u64, token: Token) -> Completed {
        if token.kind == Kind::Interrupt {
            return self.complete_periodic(token);
        }
        let Some(at) = self.buffers.iter().position(|job| same(&job.token, &token)) else { return Completed::Stall };
        match &self.buffers[at].progress {
            Progress::Done(_, end, result) if *end <= now => {
                let result = result.clone();
                self.buffers.remove(at);
                result
            }
            _ => Completed::Nyet,
        }
    }

    /// What the slow bus gave before this microframe began.
    fn complete_periodic(&mut self, token: Token) -> Completed {
        let Some(at) = self.periodic.iter().position(|job| same(&job.token, &token)) else { return Completed::Nyet };
        let Progress::Done(begin, end, result) = &mut self.periodic[at].progress else { return Completed::Nyet };
        if *end <= token.microframe_start {
            let result = result.clone();
            self.periodic.remove(at);
            return result;
        }
        // Data that has begun to come: the part that is here (§8.4.4, MDATA).
        if let Completed::Data(_, bytes) = result
            && *begin < token.microframe_start
        {
            let share = bytes.len() as u64 * (token.microframe_start - *begin) / (*end - *begin);
            let part: Vec<u8> = bytes.drain(..share as usize).collect();
            if !part.is_empty() {
                return Completed::Part(part);
            }
        }
        Completed::Nyet
    }

    /// Lets the slow bus do what it does until `now`.
    pub fn run(&mut self, now: u64, ports: &mut [Port], complaints: &mut Vec<(Rule, String)>) {
        while let Some((periodic, at, begin)) = self.next(now) {
            let list = if periodic { &mut self.periodic } else { &mut self.buffers };
            let job = &mut list[at];
            let device =
                ports.get_mut(usize::from(job.token.port).wrapping_sub(1)).and_then(|port| port.at(job.token.speed));
            let (result, bytes) = perform(begin, &job.token, &job.start, device);
            let end = begin + duration(job.token.speed, bytes);
            job.progress = Progress::Done(begin, end, result);
            self.free = end;
        }
        let late = |job: &Job| match job.progress {
            Progress::Waiting(from) => from + PATIENCE_US < now,
            Progress::Done(_, end, _) => end + PATIENCE_US < now,
        };
        self.periodic.retain(|job| !late(job));
        for job in self.buffers.iter_mut().filter(|job| !job.told) {
            if let Progress::Done(_, end, _) = job.progress
                && end + FORGOTTEN_US < now
            {
                job.told = true;
                complaints.push((Rule::SplitAbandoned, format!("{:?} at port {}", job.token.target, job.token.port)));
            }
        }
    }

    /// The next transaction that begins by `now`: whether it is periodic, which, and when.
    fn next(&self, now: u64) -> Option<(bool, usize, u64)> {
        let begin = |job: &Job| match job.progress {
            Progress::Waiting(from) => Some(from.max(self.free)),
            Progress::Done(..) => None,
        };
        let periodic = self.periodic.iter().enumerate().filter_map(|(at, job)| Some((begin(job)?, 0, at)));
        let rest = self.buffers.iter().enumerate().filter_map(|(at, job)| {
            let begin = begin(job)?;
            let length = match &job.start {
                Start::Out(_, bytes) => bytes.len(),
                _ => 64,
            };
            let end_of_frame = self.epoch + (begin.saturating_sub(self.epoch) / FRAME_US + 1) * FRAME_US;
            let fits = begin + duration(job.token.speed, length.min(8 * 8)) < end_of_frame;
            Some((if fits { begin } else { end_of_frame + 1 }, 1, at))
        });
        let (begin, rank, at) = periodic.chain(rest).min()?;
        (begin <= now).then_some((rank == 0, at, begin))
    }
}

/// One transaction on the slow bus, and the bytes of its data.
fn perform(now: u64, token: &Token, start: &Start, device: Option<&mut (dyn Device + Send)>) -> (Completed, usize) {
    let Some(device) = device else { return (Completed::Error, 0) };
    device.low_speed_next(token.speed == Speed::Low);
    let handshake = |answer: Handshake| match answer {
        Handshake::Ack | Handshake::Nyet => Completed::Ack,
        Handshake::Nak => Completed::Nak,
        Handshake::Stall => Completed::Stall,
        Handshake::Silent => Completed::Error,
    };
    match start {
        Start::Setup(packet) => match device.setup(now, token.target, *packet) {
            Handshake::Ack => (Completed::Ack, 8),
            _ => (Completed::Error, 8),
        },
        Start::Out(toggle, bytes) => {
            let answer = device.data_out(now, token.target, *toggle, bytes);
            (handshake(answer), bytes.len())
        }
        Start::In => match device.data_in(now, token.target) {
            Answer::Data(toggle, bytes) => {
                device.acknowledged(now, token.target);
                let length = bytes.len();
                (data(toggle, bytes), length)
            }
            Answer::Nak => (Completed::Nak, 0),
            Answer::Stall => (Completed::Stall, 0),
            Answer::Silent => (Completed::Error, 0),
        },
    }
}

fn data(toggle: Toggle, bytes: Vec<u8>) -> Completed {
    Completed::Data(toggle, bytes)
}
