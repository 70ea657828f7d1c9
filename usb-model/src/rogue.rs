//! A device that goes wrong.

use crate::dualshock3::{Temper, dualshock3};
use crate::dualshock4::dualshock4;
use crate::gamepad::gamepad;
use crate::keyboard::{Form, keyboard};
use crate::leaf::{Descriptors, Function, Leaf};
use crate::mutate::mutate;
use crate::random::Random;
use crate::simple_hub;
use crate::storage::storage;
use crate::wire::{Answer, Device, Handshake, Speed, Target, Toggle};

/// What a device does wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Habit {
    /// It says nothing: unplugged, or broken.
    Silent,
    /// It says "not now" to everything but SETUP.
    Naks,
    /// It refuses everything but SETUP.
    Stalls,
    /// It sends more than a packet holds.
    Babbles,
    /// It sends anything, of any length that a packet holds.
    Garbles,
    /// It sends the other toggle.
    WrongToggle,
    /// It sends nothing, as data.
    Empty,
}

impl Habit {
    /// All of them.
    pub const ALL: [Self; 7] =
        [Self::Silent, Self::Naks, Self::Stalls, Self::Babbles, Self::Garbles, Self::WrongToggle, Self::Empty];
}

/// A device that goes wrong from a transaction on.
pub struct Rogue<D> {
    /// The device that it would be.
    pub inner: D,
    habit: Habit,
    from: u64,
    once_in: usize,
    transactions: u64,
    random: Random,
}

impl<D: Device> Rogue<D> {
    /// Returns a device with a habit that it shows in a transaction out of `once_in`, after `from` transactions.
    pub fn new(inner: D, habit: Habit, from: u64, once_in: usize, seed: u64) -> Self {
        Self { inner, habit, from, once_in, transactions: 0, random: Random(seed) }
    }

    /// Transactions that it has seen.
    pub fn transactions(&self) -> u64 {
        self.transactions
    }

    fn misbehaves(&mut self) -> bool {
        self.transactions += 1;
        self.transactions > self.from && self.random.once_in(self.once_in)
    }
}

impl<D: Device> Device for Rogue<D> {
    fn speed(&self, fastest: Speed) -> Speed {
        self.inner.speed(fastest)
    }

    fn reset(&mut self, now: u64, speed: Speed) {
        self.inner.reset(now, speed);
    }

    fn setup(&mut self, now: u64, target: Target, packet: [u8; 8]) -> Handshake {
        if self.misbehaves() && self.habit == Habit::Silent {
            return Handshake::Silent;
        }
        self.inner.setup(now, target, packet)
    }

    fn data_in(&mut self, now: u64, target: Target) -> Answer {
        if !self.misbehaves() {
            return self.inner.data_in(now, target);
        }
        match (self.habit, self.inner.data_in(now, target)) {
            // Not for it.
            (_, Answer::Silent) | (Habit::Silent, _) => Answer::Silent,
            (Habit::Naks, _) => Answer::Nak,
            (Habit::Stalls, _) => Answer::Stall,
            (Habit::Babbles, answer) => {
                let (toggle, mut bytes) = data(answer);
                let more = 65 + self.random.below(1100);
                bytes.extend(self.random.bytes(more));
                Answer::Data(toggle, bytes)
            }
            (Habit::Garbles, answer) => {
                let length = self.random.below(65);
                Answer::Data(data(answer).0, self.random.bytes(length))
            }
            (Habit::WrongToggle, Answer::Data(Toggle::Data0, bytes)) => Answer::Data(Toggle::Data1, bytes),
            (Habit::WrongToggle, Answer::Data(Toggle::Data1, bytes)) => Answer::Data(Toggle::Data0, bytes),
            (Habit::WrongToggle, answer) => answer,
            (Habit::Empty, answer) => Answer::Data(data(answer).0, Vec::new()),
        }
    }

    fn acknowledged(&mut self, now: u64, target: Target) {
        self.inner.acknowledged(now, target);
    }

    fn data_out(&mut self, now: u64, target: Target, toggle: Toggle, bytes: &[u8]) -> Handshake {
        if !self.misbehaves() {
            return self.inner.data_out(now, target, toggle, bytes);
        }
        match (self.habit, self.inner.data_out(now, target, toggle, bytes)) {
            // Not for it.
            (_, Handshake::Silent) | (Habit::Silent, _) => Handshake::Silent,
            (Habit::Naks, _) => Handshake::Nak,
            _ => Handshake::Stall,
        }
    }
}

fn data(answer: Answer) -> (Toggle, Vec<u8>) {
    match answer {
        Answer::Data(toggle, bytes) => (toggle, bytes),
        _ => (Toggle::Data0, Vec::new()),
    }
}

/// A function that answers anything with anything.
#[derive(Debug)]
struct Noise(Random);

impl Function for Noise {
    fn request_in(&mut self, _now: u64, _setup: [u8; 8]) -> Option<Vec<u8>> {
        let length = self.0.below(40);
        (!self.0.once_in(4)).then(|| self.0.bytes(length))
    }

    fn request_out(&mut self, _now: u64, _setup: [u8; 8], _data: &[u8]) -> bool {
        !self.0.once_in(4)
    }

    fn input(&mut self, _now: u64, _endpoint: u8) -> Option<Vec<u8>> {
        let length = self.0.below(80);
        (!self.0.once_in(3)).then(|| self.0.bytes(length))
    }
}

/// Returns a device that is wrong in a way of its own for each seed: some have wrong descriptors, some wrong
/// answers, some a habit, some all three.
pub fn rogue(seed: u64) -> Box<dyn Device + Send> {
    let mut random = Random(seed);
    let device: Box<dyn Device + Send> = match random.below(9) {
        0 => vary(keyboard(Form::Boot, Speed::Low), &mut random),
        1 => vary(keyboard(Form::Boot, Speed::High), &mut random),
        2 => vary(keyboard(Form::Bitmap, Speed::Full), &mut random),
        3 => vary(keyboard(Form::StubbornBoot, Speed::Full), &mut random),
        4 => vary(dualshock3(Temper::Sony), &mut random),
        5 => vary(dualshock4(), &mut random),
        6 => vary(gamepad(), &mut random),
        7 => vary(storage(Speed::High), &mut random),
        _ => {
            let speed = if random.once_in(2) { Speed::High } else { Speed::Full };
            let hub = Leaf::new(speed, simple_hub::descriptors(speed), Noise(random.clone()));
            vary(hub, &mut random)
        }
    };
    if random.once_in(4) {
        return device;
    }
    let habit = Habit::ALL[random.below(Habit::ALL.len())];
    let from = random.below(60) as u64;
    let once_in = match habit {
        // "Not now" for ever takes every time-out there is, so only some do.
        Habit::Naks if !random.once_in(8) => [2, 5, 20][random.below(3)],
        _ => [1, 1, 2, 5, 20][random.below(5)],
    };
    Box::new(Rogue::new(device, habit, from, once_in, random.bits()))
}

/// Makes a device's descriptors wrong, its answers, both or none.
fn vary<F: Function + Send + 'static>(mut leaf: Leaf<F>, random: &mut Random) -> Box<dyn Device + Send> {
    if !random.once_in(4) {
        mutate(&mut leaf.descriptors, random);
    }
    if random.once_in(3) {
        let (speed, descriptors): (Speed, Descriptors) = (leaf.speed(Speed::High), leaf.descriptors);
        return Box::new(Leaf::new(speed, descriptors, Noise(random.clone())));
    }
    Box::new(leaf)
}
