//! A hub's downstream ports (USB 2.0 §11.5, §11.24.2.7).

use crate::wire::{Device, Speed};

/// Bits of wPortStatus.
const CONNECTED: u16 = 1;
const ENABLED: u16 = 1 << 1;
const RESET: u16 = 1 << 4;
const POWER: u16 = 1 << 8;
const LOW_SPEED: u16 = 1 << 9;
const HIGH_SPEED: u16 = 1 << 10;
/// Bits of wPortChange.
pub(super) const CHANGED_CONNECTION: u16 = 1;
const CHANGED_ENABLE: u16 = 1 << 1;
const CHANGED_RESET: u16 = 1 << 4;

/// From power, or from the plug, to a connection that the hub sees.
const PULL_UP_US: u64 = 5_000;
/// How long a hub signals reset: 10…20 ms, TDRST (USB 2.0 §7.1.7.5).
const RESET_US: u64 = 12_000;

/// A port.
#[derive(Default)]
pub(super) struct Port {
    pub device: Option<Box<dyn Device + Send>>,
    powered: bool,
    connected: bool,
    connect_at: Option<u64>,
    /// A plug or a power-on that no call has dated yet.
    undated: bool,
    connected_since: u64,
    /// The host has asked since then.
    connection_known: bool,
    enabled: bool,
    reset_until: Option<u64>,
    pub reset_end: u64,
    /// The speed of who was reset then; somebody else may be there by now.
    pub reset_speed: Option<Speed>,
    speed: Option<Speed>,
    pub changes: u16,
}

impl Port {
    /// Lets time come to `now`. A device that was reset by then knows.
    pub fn tick(&mut self, now: u64, fastest: Speed) {
        if std::mem::take(&mut self.undated) && self.powered && self.device.is_some() {
            self.connect_at = Some(now + PULL_UP_US);
        }
        if self.connect_at.is_some_and(|at| at <= now) {
            self.connect_at = None;
            self.connected = true;
            self.connected_since = now;
            self.connection_known = false;
            self.changes |= CHANGED_CONNECTION;
            self.speed = self.device.as_ref().map(|device| device.speed(fastest));
        }
        if let Some(end) = self.reset_until.filter(|end| *end <= now) {
            self.reset_until = None;
            self.changes |= CHANGED_RESET;
            self.reset_end = end;
            if let (Some(device), Some(speed)) = (&mut self.device, self.speed) {
                device.reset(end, speed);
                self.reset_speed = Some(speed);
                self.enabled = true;
            }
        }
    }

    pub fn plug(&mut self, device: Box<dyn Device + Send>) {
        self.unplug();
        self.device = Some(device);
        self.undated = true;
    }

    pub fn unplug(&mut self) -> Option<Box<dyn Device + Send>> {
        if self.connected {
            self.changes |= CHANGED_CONNECTION;
        }
        self.connected = false;
        self.connect_at = None;
        self.enabled = false;
        self.reset_until = None;
        self.device.take()
    }

    pub fn set_power(&mut self, on: bool) {
        if on && !self.powered {
            self.undated = true;
        }
        if !on {
            self.connected = false;
            self.enabled = false;
            self.connect_at = None;
        }
        self.powered = on;
    }

    /// False when there is nothing to reset.
    pub fn start_reset(&mut self, now: u64) -> bool {
        if self.connected {
            self.enabled = false;
            self.reset_until = Some(now + RESET_US);
        }
        self.connected
    }

    pub fn disable(&mut self) {
        self.enabled = false;
    }

    /// The device spoke beyond the end of its (micro)frame, and is cut off (USB 2.0 §11.8.1).
    pub fn cut_off(&mut self) {
        self.enabled = false;
        self.changes |= CHANGED_ENABLE;
    }

    /// The hub itself was reset: no power, no changes.
    pub fn reset_all(&mut self) {
        let device = self.device.take();
        *self = Self { device, ..Self::default() };
    }

    /// How long a connection that the host knows of has been there.
    pub fn known_for(&self, now: u64) -> Option<u64> {
        (self.connected && self.connection_known).then(|| now.saturating_sub(self.connected_since))
    }

    /// The host asked.
    pub fn asked(&mut self) {
        self.connection_known = self.connected;
    }

    /// The device, when it may be talked to at this speed.
    pub fn at(&mut self, speed: Speed) -> Option<&mut (dyn Device + Send)> {
        match &mut self.device {
            Some(device) if self.enabled && self.speed == Some(speed) => Some(device.as_mut()),
            _ => None,
        }
    }

    fn speed(&self) -> Option<Speed> {
        self.speed.filter(|_| self.connected)
    }

    /// The speed of a device that was reset. What is said before that is for who was there before.
    pub fn enabled_speed(&self) -> Option<Speed> {
        self.speed.filter(|_| self.enabled)
    }

    /// A device was reset here since the hub was.
    pub fn was_ever_enabled(&self) -> bool {
        self.reset_end > 0
    }

    /// wPortStatus and wPortChange.
    pub fn status(&self) -> [u8; 4] {
        let set = |on: bool, bit: u16| if on { bit } else { 0 };
        let status = set(self.connected, CONNECTED)
            | set(self.enabled, ENABLED)
            | set(self.reset_until.is_some(), RESET)
            | set(self.powered, POWER)
            | set(self.speed() == Some(Speed::Low), LOW_SPEED)
            | set(self.speed() == Some(Speed::High), HIGH_SPEED);
        let [a, b] = status.to_le_bytes();
        let [c, d] = self.changes.to_le_bytes();
        [a, b, c, d]
    }
}
