//! A device that misbehaves at a chosen moment.

use crate::split::Translator;
use crate::violation::Rule;
use crate::wire::{Answer, Device, Handshake, Speed, Target, Toggle};

/// What it does wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fault {
    /// Answers no more.
    Vanish,
    /// Answers NAK to everything but SETUP.
    NakForever,
    /// Answers STALL to everything but SETUP.
    StallAll,
    /// Answers IN with a packet of this many bytes.
    Babble(usize),
    /// Answers IN with the other toggle than it should.
    WrongToggle,
}

/// A device and what it does wrong from some transaction on.
pub struct Faulty<D> {
    device: D,
    fault: Option<Fault>,
    /// Transactions that go well before.
    good: u64,
    /// Transactions that go wrong.
    bad: u64,
}

impl<D> Faulty<D> {
    /// A device that does nothing wrong yet.
    pub fn new(device: D) -> Self {
        Self { device, fault: None, good: 0, bad: 0 }
    }

    /// From the transaction after the next `good` ones on it has this fault.
    pub fn break_after(&mut self, good: u64, fault: Fault) {
        self.break_for(good, u64::MAX, fault);
    }

    /// After the next `good` transactions, `bad` ones have this fault.
    pub fn break_for(&mut self, good: u64, bad: u64, fault: Fault) {
        (self.fault, self.good, self.bad) = (Some(fault), good, bad);
    }

    /// It behaves again.
    pub fn mend(&mut self) {
        self.fault = None;
    }

    /// The device itself.
    pub fn device(&mut self) -> &mut D {
        &mut self.device
    }

    /// The fault, while its time is.
    fn now_faulty(&mut self) -> Option<Fault> {
        self.fault?;
        if self.good > 0 {
            self.good -= 1;
            return None;
        }
        self.bad = self.bad.checked_sub(1)?;
        self.fault
    }
}

impl<D: Device> Device for Faulty<D> {
    fn speed(&self, fastest: Speed) -> Speed {
        self.device.speed(fastest)
    }

    fn reset(&mut self, now: u64, speed: Speed) {
        self.device.reset(now, speed);
    }

    fn setup(&mut self, now: u64, target: Target, packet: [u8; 8]) -> Handshake {
        let healthy = |device: &mut D| device.setup(now, target, packet);
        match self.now_faulty() {
            Some(Fault::Vanish) => Handshake::Silent,
            _ => healthy(&mut self.device),
        }
    }

    fn data_in(&mut self, now: u64, target: Target) -> Answer {
        let fault = self.now_faulty();
        let answer = match fault {
            Some(Fault::Vanish) => return Answer::Silent,
            _ => self.device.data_in(now, target),
        };
        match (fault, answer) {
            // Whom the transaction is not for stays silent, broken or not.
            (_, Answer::Silent) => Answer::Silent,
            (Some(Fault::NakForever), _) => Answer::Nak,
            (Some(Fault::StallAll), _) => Answer::Stall,
            (Some(Fault::Babble(bytes)), Answer::Data(toggle, _)) => Answer::Data(toggle, vec![0x55; bytes]),
            (Some(Fault::WrongToggle), Answer::Data(Toggle::Data0, bytes)) => Answer::Data(Toggle::Data1, bytes),
            (Some(Fault::WrongToggle), Answer::Data(Toggle::Data1, bytes)) => Answer::Data(Toggle::Data0, bytes),
            (_, answer) => answer,
        }
    }

    fn acknowledged(&mut self, now: u64, target: Target) {
        self.device.acknowledged(now, target);
    }

    fn data_out(&mut self, now: u64, target: Target, toggle: Toggle, bytes: &[u8]) -> Handshake {
        let fault = self.now_faulty();
        if matches!(fault, Some(Fault::Vanish)) {
            return Handshake::Silent;
        }
        match (fault, self.device.data_out(now, target, toggle, bytes)) {
            (_, Handshake::Silent) => Handshake::Silent,
            (Some(Fault::NakForever), _) => Handshake::Nak,
            (Some(Fault::StallAll), _) => Handshake::Stall,
            (_, answer) => answer,
        }
    }

    fn low_speed_next(&mut self, low: bool) {
        self.device.low_speed_next(low);
    }

    fn complaints(&mut self) -> Vec<(Rule, String)> {
        self.device.complaints()
    }

    fn translator(&mut self) -> Option<&mut dyn Translator> {
        self.device.translator()
    }
}
