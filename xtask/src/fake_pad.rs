//! A DualShock 3 that is none: it says what it is told to, over QEMU's USB.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use controls::DualShock3Report;
use firmware::intake::Reports;
use usb_model::dualshock3::{Pad, Temper, dualshock3};
use usb_model::leaf::{Function, Leaf};
use usb_model::wire::{Device, Speed};

/// A report's bytes.
pub type ReportBytes = [u8; DualShock3Report::LENGTH];

/// What the pad says, and what was heard.
#[derive(Debug, Default)]
struct Script {
    /// Reports that are still to be said.
    waiting: VecDeque<ReportBytes>,
    /// Least time from one to the next, in microseconds.
    interval: u64,
    /// What was said, to the last pad that was made.
    said: Reports,
    awake: bool,
    /// Output reports, without their id.
    outputs: Vec<Vec<u8>>,
}

/// The owner's side of a pad: says what it reports.
#[derive(Debug, Clone, Default)]
pub struct FakePad {
    script: Arc<Mutex<Script>>,
}

impl FakePad {
    /// Returns a pad that sends a report at most every `interval_microseconds`.
    pub fn new(interval_microseconds: u64) -> Self {
        let pad = Self::default();
        pad.script().interval = interval_microseconds;
        pad
    }

    /// Returns the device to plug in. It refuses the requests that `temper` names.
    pub fn device(&self, temper: Temper) -> Box<dyn Device + Send> {
        let Leaf { descriptors, function: pad, .. } = dualshock3(temper);
        Box::new(Leaf::new(Speed::Full, descriptors, Scripted { pad, script: Arc::clone(&self.script), last: None }))
    }

    /// Lets the pad say a report, after those that wait.
    pub fn say(&self, report: ReportBytes) {
        self.script().waiting.push_back(report);
    }

    /// Returns how many reports still wait.
    pub fn waiting(&self) -> usize {
        self.script().waiting.len()
    }

    /// Returns what was said so far, tallied as the firmware does.
    pub fn said(&self) -> Reports {
        self.script().said
    }

    /// Returns whether the host has woken the pad since its last reset.
    pub fn is_awake(&self) -> bool {
        self.script().awake
    }

    /// Returns the output reports so far: lamps and motors.
    pub fn outputs(&self) -> Vec<Vec<u8>> {
        self.script().outputs.clone()
    }

    fn script(&self) -> MutexGuard<'_, Script> {
        self.script.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The model of a pad, but for what it reports.
struct Scripted {
    pad: Pad,
    script: Arc<Mutex<Script>>,
    /// When it reported last.
    last: Option<u64>,
}

impl Scripted {
    /// Runs `work` on the pad, and tells its owner what changed.
    fn tell<R>(&mut self, work: impl FnOnce(&mut Pad) -> R) -> R {
        let result = work(&mut self.pad);
        let mut script = self.script.lock().unwrap_or_else(PoisonError::into_inner);
        script.awake = self.pad.is_awake();
        script.outputs.append(&mut self.pad.outputs);
        result
    }
}

impl Function for Scripted {
    fn request_in(&mut self, now: u64, setup: [u8; 8]) -> Option<Vec<u8>> {
        self.tell(|pad| pad.request_in(now, setup))
    }

    fn request_out(&mut self, now: u64, setup: [u8; 8], data: &[u8]) -> bool {
        self.tell(|pad| pad.request_out(now, setup, data))
    }

    fn input(&mut self, now: u64, _endpoint: u8) -> Option<Vec<u8>> {
        let mut script = self.script.lock().unwrap_or_else(PoisonError::into_inner);
        if !self.pad.is_awake() || self.last.is_some_and(|last| now - last < script.interval) {
            return None;
        }
        let report = script.waiting.pop_front()?;
        script.said.add(&report);
        self.last = Some(now);
        Some(report.to_vec())
    }

    fn output(&mut self, now: u64, endpoint: u8, packet: &[u8]) {
        self.tell(|pad| pad.output(now, endpoint, packet));
    }

    fn reset(&mut self) {
        self.tell(Pad::reset);
        self.last = None;
    }
}
