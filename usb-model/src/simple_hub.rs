//! A hub that passes tokens on, and watches that they come with the right split.

use std::cell::{Cell, RefCell};
use std::rc::Rc;

use crate::leaf::{Descriptors, Function, Leaf};
use crate::wire::{Answer, Device, Handshake, Speed, Target, Toggle};

/// A device that a test keeps a hand on while it is plugged in.
pub type Shared = Rc<RefCell<dyn Device>>;

/// How long a port's reset lasts (USB 2.0 §7.1.7.5: 10 to 20 ms).
const RESET_US: u64 = 15_000;
/// Time from power to a port that notices what is plugged in: PwrOn2PwrGood, in units of 2 ms.
const POWER_GOOD: u8 = 50;
/// A connection has to be steady this long before a reset (USB 2.0 §7.1.7.3).
const DEBOUNCE_US: u64 = 100_000;

/// The split that a token comes with: which hub translates, at which port, for a low-speed device or not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Split {
    /// The hub's address.
    pub hub: u8,
    /// Its port, from 1 on.
    pub port: u8,
    /// The device is a low-speed one.
    pub low: bool,
}

/// The split of the token that is on the wire; the host sets it, hubs look at it.
pub type Translation = Rc<Cell<Option<Split>>>;

/// One port.
#[derive(Default)]
struct Port {
    device: Option<Shared>,
    status: u16,
    changes: u16,
    powered_at: u64,
    plugged_at: u64,
    resetting_until: Option<u64>,
}

/// A hub's ports, for a test to plug things in and out; clones are the same ports.
#[derive(Clone)]
pub struct Ports {
    ports: Rc<RefCell<Vec<Port>>>,
    violations: Rc<RefCell<Vec<String>>>,
}

const CONNECTION: u16 = 1;
const ENABLE: u16 = 1 << 1;
const RESET: u16 = 1 << 4;
const POWER: u16 = 1 << 8;
const LOW_SPEED: u16 = 1 << 9;
const HIGH_SPEED: u16 = 1 << 10;
const CHANGES: u16 = 0x1F;

impl Ports {
    /// Plugs a device into a port, from 1 on, at a time.
    pub fn plug(&self, port: u8, device: Shared, now: u64) {
        let mut ports = self.ports.borrow_mut();
        let port = &mut ports[usize::from(port) - 1];
        port.device = Some(device);
        port.plugged_at = now;
        if port.status & POWER != 0 {
            port.status |= CONNECTION;
            port.changes |= CONNECTION;
        }
    }

    /// Pulls whatever is in a port.
    pub fn unplug(&self, port: u8) {
        let mut ports = self.ports.borrow_mut();
        let port = &mut ports[usize::from(port) - 1];
        if port.device.take().is_some() && port.status & POWER != 0 {
            port.status = POWER;
            port.changes |= CONNECTION;
            port.resetting_until = None;
        }
    }

    /// Cuts a port off, as a hub does that saw babble (USB 2.0 §11.8.1).
    pub fn cut_off(&self, port: u8) {
        let mut ports = self.ports.borrow_mut();
        let port = &mut ports[usize::from(port) - 1];
        port.status &= !ENABLE;
        port.changes |= ENABLE;
    }

    /// Says that a port draws too much current, or no longer.
    pub fn set_over_current(&self, port: u8, over: bool) {
        const OVER_CURRENT: u16 = 1 << 3;
        let mut ports = self.ports.borrow_mut();
        let port = &mut ports[usize::from(port) - 1];
        port.status = if over { OVER_CURRENT } else { 0 };
        port.changes |= OVER_CURRENT;
    }

    /// Whether a port is powered.
    pub fn is_powered(&self, port: u8) -> bool {
        self.ports.borrow()[usize::from(port) - 1].status & POWER != 0
    }

    /// Whether a port passes tokens on.
    pub fn is_enabled(&self, port: u8) -> bool {
        self.ports.borrow()[usize::from(port) - 1].status & ENABLE != 0
    }

    /// What the host has done wrong at the ports.
    pub fn violations(&self) -> Vec<String> {
        self.violations.borrow().clone()
    }

    fn blame(&self, what: String) {
        self.violations.borrow_mut().push(what);
    }

    /// Ends resets whose time is over.
    fn advance(&self, now: u64, hub_speed: Speed) {
        for port in self.ports.borrow_mut().iter_mut() {
            if port.resetting_until.is_some_and(|until| now >= until) {
                port.resetting_until = None;
                port.status &= !(RESET | LOW_SPEED | HIGH_SPEED);
                port.changes |= RESET;
                if let Some(device) = &port.device {
                    let speed = device.borrow().speed(hub_speed);
                    port.status |= ENABLE
                        | match speed {
                            Speed::Low => LOW_SPEED,
                            Speed::Full => 0,
                            Speed::High => HIGH_SPEED,
                        };
                    device.borrow_mut().reset(now, speed);
                }
            }
        }
    }

    fn set_feature(&self, now: u64, feature: u8, number: u8) -> bool {
        let mut ports = self.ports.borrow_mut();
        let Some(port) = usize::from(number).checked_sub(1).and_then(|index| ports.get_mut(index)) else {
            return false;
        };
        match feature {
            4 => {
                if port.status & CONNECTION != 0 && now < port.plugged_at.max(port.powered_at) + DEBOUNCE_US {
                    self.blame(format!("port {number} was reset before its connection was steady"));
                }
                if port.changes & CONNECTION != 0 {
                    self.blame(format!("port {number} was reset with a change of connection pending"));
                }
                port.status = port.status & !ENABLE | RESET;
                port.resetting_until = Some(now + RESET_US);
            }
            8 if port.status & POWER == 0 => {
                port.status = POWER;
                port.powered_at = now;
                if port.device.is_some() {
                    port.status |= CONNECTION;
                    port.changes |= CONNECTION;
                }
            }
            8 => {}
            _ => return false,
        }
        true
    }

    fn clear_feature(&self, feature: u8, number: u8) -> bool {
        let mut ports = self.ports.borrow_mut();
        match (usize::from(number).checked_sub(1).and_then(|index| ports.get_mut(index)), feature) {
            (Some(port), 1) => port.status &= !ENABLE,
            (Some(port), 16..=20) => port.changes &= !(1 << (feature - 16)),
            (None, 0 | 1) => {}
            _ => return false,
        }
        true
    }

    fn status(&self, now: u64, number: u8) -> Option<Vec<u8>> {
        let ports = self.ports.borrow();
        let port = ports.get(usize::from(number).checked_sub(1)?)?;
        if port.status & POWER != 0 && now < port.powered_at + 2_000 * u64::from(POWER_GOOD) {
            self.blame(format!("port {number} was asked before its power was good"));
        }
        Some([port.status.to_le_bytes(), port.changes.to_le_bytes()].concat())
    }

    /// Which ports have changed, from bit 1 on; `None` for none.
    fn changes(&self) -> Option<Vec<u8>> {
        let ports = self.ports.borrow();
        let mut bytes = vec![0; ports.len() / 8 + 1];
        for (index, _) in ports.iter().enumerate().filter(|(_, port)| port.changes & CHANGES != 0) {
            bytes[(index + 1) / 8] |= 1 << ((index + 1) % 8);
        }
        bytes.iter().any(|&byte| byte != 0).then_some(bytes)
    }
}

impl Function for Ports {
    fn request_in(&mut self, now: u64, setup: [u8; 8]) -> Option<Vec<u8>> {
        match (setup[0], setup[1]) {
            (0xA0, 6) if setup[3] == 0x29 => {
                let count = self.ports.borrow().len() as u8;
                Some(vec![9, 0x29, count, 0x09, 0, POWER_GOOD, 1, 0, 0xFF])
            }
            (0xA0, 0) => Some(vec![0; 4]),
            (0xA3, 0) => self.status(now, setup[4]),
            _ => None,
        }
    }

    fn request_out(&mut self, now: u64, setup: [u8; 8], _data: &[u8]) -> bool {
        match (setup[0], setup[1]) {
            (0x23, 3) => self.set_feature(now, setup[2], setup[4]),
            (0x20 | 0x23, 1) => self.clear_feature(setup[2], setup[4]),
            _ => false,
        }
    }

    fn input(&mut self, _now: u64, _endpoint: u8) -> Option<Vec<u8>> {
        self.changes()
    }

    fn reset(&mut self) {
        for port in self.ports.borrow_mut().iter_mut() {
            (port.status, port.changes, port.resetting_until) = (0, 0, None);
        }
    }
}

/// A hub.
pub struct SimpleHub {
    leaf: Leaf<Ports>,
    speed: Speed,
    translation: Translation,
}

/// Returns a hub's descriptors; at high speed those of one with a translator for each port.
pub fn descriptors(speed: Speed) -> Descriptors {
    let (protocol, setting, interval) = if speed == Speed::High { (2, 1, 12) } else { (0, 0, 255) };
    let configuration =
        [&[9, 2, 25, 0, 1, 1, 0, 0xE0, 1][..], &[9, 4, 0, 0, 1, 9, 0, setting, 0], &[7, 5, 0x81, 3, 1, 0, interval]]
            .concat();
    let device = vec![18, 1, 0, 2, 9, 0, protocol, 64, 0x24, 0x04, 0x12, 0x25, 0, 1, 0, 0, 0, 1];
    Descriptors { device, configuration, strings: Vec::new(), reports: Vec::new() }
}

impl SimpleHub {
    /// Returns a hub with up to seven ports, and its ports.
    pub fn new(speed: Speed, ports: u8, translation: Translation) -> (Self, Ports) {
        let ports = Ports {
            ports: Rc::new(RefCell::new((0..ports).map(|_| Port::default()).collect())),
            violations: Rc::default(),
        };
        let leaf = Leaf::new(speed, descriptors(speed), ports.clone());
        (Self { leaf, speed, translation }, ports)
    }

    /// The hub as a device, for what the host does wrong with it.
    pub fn leaf(&self) -> &Leaf<Ports> {
        &self.leaf
    }

    /// Passes a token on to what is plugged in; the first answer counts, and there should be no other.
    fn pass<T>(&self, silent: T, mut each: impl FnMut(&mut dyn Device) -> Option<T>) -> T {
        let hub = &self.leaf.function;
        let mut heard: Option<(usize, T)> = None;
        for (index, port) in hub.ports.borrow().iter().enumerate() {
            let Some(device) = port.device.as_ref().filter(|_| port.status & ENABLE != 0) else { continue };
            if !self.lets_through(index as u8 + 1, port.status) {
                continue;
            }
            match (each(&mut *device.borrow_mut()), &heard) {
                (Some(_), Some((first, _))) => {
                    hub.blame(format!("ports {} and {} answer one token", first + 1, index + 1));
                }
                (Some(answer), None) => heard = Some((index, answer)),
                (None, _) => {}
            }
        }
        heard.map_or(silent, |(_, answer)| answer)
    }

    /// Tells whether a token with the split that is on the wire goes through a port.
    fn lets_through(&self, number: u8, status: u16) -> bool {
        let here = |split: Split| split.hub == self.leaf.address();
        match (self.speed, status & (LOW_SPEED | HIGH_SPEED), self.translation.get()) {
            (Speed::High, HIGH_SPEED, None) => true,
            // For somebody below that hub.
            (Speed::High, HIGH_SPEED, Some(split)) => !here(split),
            (Speed::High, slow, split) => {
                let low_enough = |split: Split| slow != LOW_SPEED || split.low;
                split.is_some_and(|split| here(split) && split.port == number && low_enough(split))
            }
            (_, LOW_SPEED, split) => split.is_some_and(|split| split.low && (!here(split) || split.port == number)),
            // A full-speed device, or a hub with a low-speed one below.
            (_, _, split) => split.is_none_or(|split| !here(split)),
        }
    }
}

impl Device for SimpleHub {
    fn speed(&self, fastest: Speed) -> Speed {
        self.leaf.speed(fastest)
    }

    fn reset(&mut self, now: u64, speed: Speed) {
        self.speed = speed;
        self.leaf.reset(now, speed);
    }

    fn setup(&mut self, now: u64, target: Target, packet: [u8; 8]) -> Handshake {
        self.leaf.function.advance(now, self.speed);
        if target.address == self.leaf.address() {
            return self.leaf.setup(now, target, packet);
        }
        self.pass(Handshake::Silent, |device| {
            Some(device.setup(now, target, packet)).filter(|answer| *answer != Handshake::Silent)
        })
    }

    fn data_in(&mut self, now: u64, target: Target) -> Answer {
        self.leaf.function.advance(now, self.speed);
        if target.address == self.leaf.address() {
            return self.leaf.data_in(now, target);
        }
        self.pass(Answer::Silent, |device| Some(device.data_in(now, target)).filter(|answer| *answer != Answer::Silent))
    }

    fn acknowledged(&mut self, now: u64, target: Target) {
        if target.address == self.leaf.address() {
            return self.leaf.acknowledged(now, target);
        }
        self.pass((), |device| {
            device.acknowledged(now, target);
            None
        });
    }

    fn data_out(&mut self, now: u64, target: Target, toggle: Toggle, bytes: &[u8]) -> Handshake {
        self.leaf.function.advance(now, self.speed);
        if target.address == self.leaf.address() {
            return self.leaf.data_out(now, target, toggle, bytes);
        }
        self.pass(Handshake::Silent, |device| {
            Some(device.data_out(now, target, toggle, bytes)).filter(|answer| *answer != Handshake::Silent)
        })
    }
}
