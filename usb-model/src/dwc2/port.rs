//! The root port.

use super::registers::*;
use super::{Core, Plug};
use crate::violation::Rule;
use crate::wire::Speed;

/// From power to a pull-up that the port sees, here (USB 2.0 §7.1.7.3 allows 100 ms).
const PULL_UP_US: u64 = 15_000;
/// From the end of reset to an enabled port.
const ENABLE_US: u64 = 30;
/// TATTDB, USB 2.0 §7.1.7.3.
const DEBOUNCE_US: u64 = 100_000;
/// TDRSTR, USB 2.0 §7.1.7.5.
const RESET_US: u64 = 50_000;
/// Microseconds in which software may not yet know that the port is disabled.
const GRACE_US: u64 = 2_000;

/// The port's state.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Port {
    powered: bool,
    connected: bool,
    connect_at: Option<u64>,
    connected_since: u64,
    changes: u32,
    /// Changes that software has read.
    read: u32,
    enabled: bool,
    enable_at: Option<u64>,
    disabled_at: u64,
    disable_known: bool,
    overcurrent: bool,
    reset_since: Option<u64>,
    pub reset_end: u64,
    pub speed: Option<Speed>,
    /// Frame 0 began then.
    epoch: u64,
}

impl Port {
    pub fn next_event(&self) -> Option<u64> {
        [self.connect_at, self.enable_at].into_iter().flatten().min()
    }

    pub fn changes(&self) -> u32 {
        self.changes
    }

    pub fn enabled(&self) -> bool {
        self.enabled
    }
}

impl Core {
    /// Plugs a device in; one that was there is gone.
    pub fn plug(&mut self, device: Plug) {
        self.unplug();
        self.device = Some(device);
        self.attach();
    }

    /// Unplugs what is there.
    pub fn unplug(&mut self) -> Option<Plug> {
        let device = self.device.take();
        self.port.connect_at = None;
        if self.port.connected {
            self.port.connected = false;
            self.disconnected = true;
            self.disable_port();
        }
        device
    }

    /// Draws too much current, or no longer.
    pub fn set_overcurrent(&mut self, on: bool) {
        self.port.overcurrent = on;
        self.port.changes |= HPRT_OVERCURRENT_CHANGED;
    }

    /// The port as software last left it: powered, and signalling reset.
    pub fn port_state(&self) -> (bool, bool) {
        (self.port.powered, self.port.reset_since.is_some())
    }

    /// The port is enabled, at this speed.
    pub fn port_speed(&self) -> Option<Speed> {
        self.port.speed.filter(|_| self.port.enabled)
    }

    fn attach(&mut self) {
        if self.device.is_some() && self.port.powered {
            self.port.connect_at = Some(self.now + PULL_UP_US);
        }
    }

    /// The port disables itself, or its device goes: traffic ends, and channels that run are never heard of again.
    pub(super) fn disable_port(&mut self) {
        if self.port.enabled {
            self.port.enabled = false;
            self.port.changes |= HPRT_ENABLE_CHANGED;
            self.port.read &= !HPRT_ENABLE_CHANGED;
            self.port.disabled_at = self.now;
            self.port.disable_known = false;
        }
        self.orphan_channels();
    }

    fn orphan_channels(&mut self) {
        for run in self.channels.iter_mut().filter_map(|channel| channel.run.as_mut()) {
            run.at = None;
        }
    }

    /// A soft reset: no power, nothing enabled.
    pub(super) fn reset_port(&mut self) {
        self.port = Port { overcurrent: self.port.overcurrent, ..Port::default() };
        self.snoop = Default::default();
        self.splits = Default::default();
    }

    pub(super) fn port_events(&mut self) {
        if self.port.connect_at.is_some_and(|at| at <= self.now) {
            self.port.connect_at = None;
            self.port.connected = true;
            self.port.connected_since = self.now;
            self.port.changes |= HPRT_CONNECT_DETECTED;
            self.port.read &= !HPRT_CONNECT_DETECTED;
        }
        if self.port.enable_at.is_some_and(|at| at <= self.now) {
            self.port.enable_at = None;
            self.enable();
        }
    }

    fn enable(&mut self) {
        let limit = self.registers.host & HCFG_FULL_SPEED != 0;
        let fastest = if limit { Speed::Full } else { Speed::High };
        let Some(device) = self.device.as_mut().filter(|_| self.port.connected && !self.defects.never_enables) else {
            return;
        };
        let speed = device.speed(fastest);
        device.reset(self.now, speed);
        self.port.speed = Some(speed);
        self.port.enabled = true;
        self.port.changes |= HPRT_ENABLE_CHANGED;
        self.port.read &= !HPRT_ENABLE_CHANGED;
        self.port.epoch = self.now;
        (self.frame_seen, self.frame_read) = (0, 0);
        self.snoop = Default::default();
        self.splits = Default::default();
    }

    pub(super) fn read_port(&mut self) -> u32 {
        let port = &mut self.port;
        port.read |= port.changes;
        port.disable_known |= !port.enabled;
        let set = |on: bool, bit: u32| if on { bit } else { 0 };
        let speed = match port.speed {
            Some(Speed::High) | None => 0,
            Some(Speed::Full) => 1,
            Some(Speed::Low) => 2,
        };
        port.changes
            | set(port.connected, HPRT_CONNECTED)
            | set(port.enabled, HPRT_ENABLED)
            | set(port.overcurrent, HPRT_OVERCURRENT)
            | set(port.reset_since.is_some(), HPRT_RESET)
            | set(port.powered, HPRT_POWER)
            | speed << 17
    }

    pub(super) fn write_port(&mut self, value: u32) {
        let unseen = value & HPRT_CHANGES & self.port.changes & !self.port.read;
        if unseen != 0 {
            self.blame(Rule::PortEventLost, format!("HPRT {value:#010x} clears {unseen:#x}, which was not read"));
        }
        self.port.changes &= !(value & HPRT_CHANGES);
        if value & HPRT_ENABLED != 0 && self.port.enabled {
            self.blame(Rule::PortEnableWritten, format!("HPRT {value:#010x}"));
            self.disable_port();
        }
        self.set_power(value & HPRT_POWER != 0);
        match (self.port.reset_since, value & HPRT_RESET != 0) {
            (None, true) => self.begin_reset(),
            (Some(since), false) => self.end_reset(since),
            _ => {}
        }
    }

    fn set_power(&mut self, on: bool) {
        if on && !self.port.powered {
            if self.phy_at_reset != Some(self.registers.phy & GUSBCFG_PHY) {
                self.blame(Rule::PhyWithoutReset, format!("GUSBCFG {:#010x}", self.registers.phy));
            }
            self.port.powered = true;
            self.attach();
        } else if !on && self.port.powered {
            self.port.connected = false;
            self.disable_port();
            self.port = Port { changes: self.port.changes, overcurrent: self.port.overcurrent, ..Port::default() };
        }
    }

    fn begin_reset(&mut self) {
        if !self.port.powered || !self.port.connected {
            self.blame(Rule::PortUnpowered, "reset of a port without power or device");
        }
        let stable = self.now - self.port.connected_since;
        if self.port.connected && stable < DEBOUNCE_US {
            self.blame(Rule::Debounce, format!("reset {stable} us after the connection"));
        }
        if self.channels.iter().any(|channel| channel.run.is_some()) {
            self.blame(Rule::ResetUnderTraffic, "reset while channels run");
        }
        self.port.reset_since = Some(self.now);
        self.port.enabled = false;
        self.port.disable_known = true;
        self.orphan_channels();
    }

    fn end_reset(&mut self, since: u64) {
        let length = self.now - since;
        if length < RESET_US {
            self.blame(Rule::ResetTooShort, format!("{length} us"));
        }
        self.port.reset_since = None;
        self.port.reset_end = self.now;
        self.port.enable_at = Some(self.now + ENABLE_US);
    }

    /// Software can know that the port is disabled.
    pub(super) fn disable_is_known(&self) -> bool {
        !self.port.enabled && (self.port.disable_known || self.now > self.port.disabled_at + GRACE_US)
    }

    /// Length of a frame, at high speed of a microframe.
    pub(super) fn frame_us(&self) -> u64 {
        if self.port.speed == Some(Speed::High) { 125 } else { 1_000 }
    }

    /// (Micro)frames since the port was enabled.
    pub(super) fn frame_index(&self, at: u64) -> u64 {
        let since = at.saturating_sub(self.port.epoch);
        // Divisors that the compiler knows: this is asked at every step.
        match (self.port.enabled, self.port.speed) {
            (false, _) => 0,
            (true, Some(Speed::High)) => since / 125,
            (true, _) => since / 1_000,
        }
    }

    pub(super) fn frame_start(&self, index: u64) -> u64 {
        self.port.epoch + index * self.frame_us()
    }
}
