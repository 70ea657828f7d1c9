//! A device that the bus and a test hold at once.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::split::{Completed, Start, Started, Token, Translator};
use crate::violation::Rule;
use crate::wire::{Answer, Device, Handshake, Speed, Target, Toggle};

/// A handle to a device; its clones are the same device.
#[derive(Debug, Default)]
pub struct Shared<D>(Arc<Mutex<D>>);

impl<D> Clone for Shared<D> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<D> Shared<D> {
    /// Makes `device` one that can be held twice.
    pub fn new(device: D) -> Self {
        Self(Arc::new(Mutex::new(device)))
    }

    /// The device; do not hold it while time passes on the bus.
    pub fn lock(&self) -> MutexGuard<'_, D> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<D: Device> Device for Shared<D> {
    fn speed(&self, fastest: Speed) -> Speed {
        self.lock().speed(fastest)
    }

    fn reset(&mut self, now: u64, speed: Speed) {
        self.lock().reset(now, speed);
    }

    fn setup(&mut self, now: u64, target: Target, packet: [u8; 8]) -> Handshake {
        self.lock().setup(now, target, packet)
    }

    fn data_in(&mut self, now: u64, target: Target) -> Answer {
        self.lock().data_in(now, target)
    }

    fn acknowledged(&mut self, now: u64, target: Target) {
        self.lock().acknowledged(now, target);
    }

    fn data_out(&mut self, now: u64, target: Target, toggle: Toggle, bytes: &[u8]) -> Handshake {
        self.lock().data_out(now, target, toggle, bytes)
    }

    fn low_speed_next(&mut self, low: bool) {
        self.lock().low_speed_next(low);
    }

    fn complaints(&mut self) -> Vec<(Rule, String)> {
        self.lock().complaints()
    }

    fn translator(&mut self) -> Option<&mut dyn Translator> {
        let splits = self.lock().translator().is_some();
        if splits { Some(self) } else { None }
    }
}

impl<D: Device> Translator for Shared<D> {
    fn start_split(&mut self, now: u64, token: Token, start: Start) -> Started {
        self.lock().translator().map_or(Started::Silent, |hub| hub.start_split(now, token, start))
    }

    fn complete_split(&mut self, now: u64, token: Token) -> Completed {
        self.lock().translator().map_or(Completed::Silent, |hub| hub.complete_split(now, token))
    }
}
