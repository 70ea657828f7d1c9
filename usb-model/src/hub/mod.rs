//! A hub: ports with power, changes and reset, and at high speed a transaction translator.
//!
//! It sees to its own rules ([`Device::complaints`]): a connection is stable before its port is reset, a device
//! recovers before it is talked to, splits name the right port and speed, and a translator's buffers are emptied.

mod descriptors;
mod endpoint0;
mod port;
mod requests;
mod translator;

use crate::dwc2::SPILL_BYTES;
use crate::split::{Completed, Start, Started, Token, Translator};
use crate::violation::Rule;
use crate::wire::{Answer, Device, Handshake, Speed, Target, Toggle};
use endpoint0::Endpoint0;
use port::Port;
use translator::Engine;

/// Ports of a hub, unless it is made with others.
const PORTS: usize = 4;
/// Ports of a hub at most: as many as a byte of its status change endpoint has bits for.
const PORTS_MAXIMUM: usize = 7;
/// TRSTRCY, USB 2.0 §7.1.7.5.
const RECOVERY_US: u64 = 10_000;

/// A hub; its ports are numbered from 1.
pub struct Hub {
    fastest: Speed,
    speed: Speed,
    address: u8,
    configured: bool,
    control: Endpoint0,
    status_toggle: Toggle,
    ports: Vec<Port>,
    engine: Engine,
    translator_broken: bool,
    low_next: bool,
    /// The port that answered the last IN.
    answered: Option<usize>,
    complaints: Vec<(Rule, String)>,
}

impl Hub {
    /// A hub with four ports that is at most this fast: high or full speed.
    pub fn new(fastest: Speed) -> Self {
        Self::with_ports(fastest, PORTS)
    }

    /// The same with so many ports.
    ///
    /// # Panics
    /// When these are more than seven.
    pub fn with_ports(fastest: Speed, ports: usize) -> Self {
        assert!(ports <= PORTS_MAXIMUM, "{ports} ports are more than {PORTS_MAXIMUM}");
        Self {
            fastest,
            speed: Speed::Full,
            address: 0,
            configured: false,
            control: Endpoint0::new(64),
            status_toggle: Toggle::Data0,
            ports: (0..ports).map(|_| Port::default()).collect(),
            engine: Engine::default(),
            translator_broken: false,
            low_next: false,
            answered: None,
            complaints: Vec::new(),
        }
    }

    /// Plugs a device into a port; one that was there is gone.
    pub fn plug(&mut self, port: usize, device: Box<dyn Device + Send>) {
        self.ports[port - 1].plug(device);
    }

    /// Unplugs what is in a port.
    pub fn unplug(&mut self, port: usize) -> Option<Box<dyn Device + Send>> {
        self.ports[port - 1].unplug()
    }

    /// From now on its transaction translator answers nothing.
    pub fn break_translator(&mut self) {
        self.translator_broken = true;
    }

    /// The speed that it came up at.
    pub fn link_speed(&self) -> Speed {
        self.speed
    }

    /// Its address; 0 before it was given one.
    pub fn address(&self) -> u8 {
        self.address
    }

    fn tick(&mut self, now: u64) {
        for port in &mut self.ports {
            port.tick(now, self.speed);
        }
        self.engine.run(now, &mut self.ports, &mut self.complaints);
    }

    /// The bus's own speed, or low speed behind a preamble.
    fn downstream(&self) -> Speed {
        if self.low_next && self.speed == Speed::Full { Speed::Low } else { self.speed }
    }

    /// Asks each device that hears the next transaction. Two answers would garble each other; here the first one counts.
    fn ask<R: PartialEq>(
        &mut self,
        now: u64,
        silent: R,
        mut say: impl FnMut(&mut dyn Device) -> R,
    ) -> (R, Option<usize>) {
        let (speed, low) = (self.downstream(), self.low_next);
        let mut heard: Option<(R, usize)> = None;
        for (index, port) in self.ports.iter_mut().enumerate() {
            let recovering = now < port.reset_end + RECOVERY_US;
            let Some(device) = port.at(speed) else { continue };
            device.low_speed_next(low);
            let answer = say(device);
            if answer == silent {
                continue;
            }
            if recovering {
                self.complaints.push((Rule::ResetRecovery, format!("hub port {}", index + 1)));
            }
            if let Some((_, first)) = &heard {
                self.complaints.push((Rule::AddressShared, format!("hub ports {} and {}", first + 1, index + 1)));
            } else {
                heard = Some((answer, index));
            }
        }
        heard.map_or((silent, None), |(answer, index)| (answer, Some(index)))
    }

    fn is_own(&self, target: Target) -> bool {
        target.address == self.address
    }

    /// A slower device in the default state cannot hear what is said at high speed. Address 0 is for who was reset last.
    fn check_unsplit(&mut self, target: Target) {
        let last = self.ports.iter().max_by_key(|port| port.reset_end).and_then(|port| port.reset_speed);
        let slower = last.is_some_and(|speed| speed != Speed::High);
        if self.speed == Speed::High && target.address == 0 && self.address != 0 && slower {
            self.complaints.push((Rule::SplitMissing, "address 0 at high speed".into()));
        }
    }

    fn check_split(&mut self, now: u64, token: &Token) {
        let Some(port) = self.ports.get(usize::from(token.port).wrapping_sub(1)) else {
            return self.complaints.push((Rule::SplitHub, format!("no port {}", token.port)));
        };
        if !port.was_ever_enabled() {
            self.complaints.push((Rule::SplitHub, format!("nobody was ever enabled at port {}", token.port)));
        }
        if port.enabled_speed().is_some_and(|speed| speed != token.speed) {
            self.complaints.push((Rule::SplitHub, format!("port {} is not {:?} speed", token.port, token.speed)));
        }
        if port.enabled_speed().is_some() && now < port.reset_end + RECOVERY_US {
            self.complaints.push((Rule::ResetRecovery, format!("hub port {}", token.port)));
        }
    }

    fn translates(&self, token: &Token) -> bool {
        token.hub == self.address && self.configured && !self.translator_broken
    }

    /// The translator that a split is for: this hub's, or one behind it.
    fn forward<R: PartialEq>(&mut self, silent: R, mut say: impl FnMut(&mut dyn Translator) -> R) -> R {
        for port in &mut self.ports {
            let Some(hub) = port.at(Speed::High).and_then(|device| device.translator()) else { continue };
            let answer = say(hub);
            if answer != silent {
                return answer;
            }
        }
        silent
    }

    /// The status change endpoint's bitmap: bit 0 the hub, bit n port n.
    fn change_bitmap(&self) -> u8 {
        let changed = |(index, port): (usize, &Port)| u8::from(port.changes != 0) << (index + 1);
        self.ports.iter().enumerate().map(changed).sum()
    }
}

impl Device for Hub {
    fn speed(&self, fastest: Speed) -> Speed {
        if fastest == Speed::High && self.fastest == Speed::High { Speed::High } else { Speed::Full }
    }

    fn reset(&mut self, _now: u64, speed: Speed) {
        self.speed = speed;
        self.address = 0;
        self.configured = false;
        self.control = Endpoint0::new(64);
        self.status_toggle = Toggle::Data0;
        self.ports.iter_mut().for_each(Port::reset_all);
        self.engine = Engine::default();
    }

    fn setup(&mut self, now: u64, target: Target, packet: [u8; 8]) -> Handshake {
        self.tick(now);
        if self.is_own(target) {
            if target.endpoint != 0 {
                return Handshake::Silent;
            }
            let answer = self.answer(packet);
            return self.control.setup(packet, answer);
        }
        let (answer, _) = self.ask(now, Handshake::Silent, |device| device.setup(now, target, packet));
        if answer == Handshake::Silent {
            self.check_unsplit(target);
        }
        answer
    }

    fn data_in(&mut self, now: u64, target: Target) -> Answer {
        self.tick(now);
        self.answered = None;
        match (self.is_own(target), target.endpoint) {
            (true, 0) => self.control.data_in(),
            (true, 1) if self.configured => match self.change_bitmap() {
                0 => Answer::Nak,
                bitmap => Answer::Data(self.status_toggle, vec![bitmap]),
            },
            (true, _) => Answer::Silent,
            (false, _) => {
                let (mut answer, port) = self.ask(now, Answer::Silent, |device| device.data_in(now, target));
                self.answered = port;
                if let (Answer::Data(_, bytes), Some(port)) = (&mut answer, port)
                    && bytes.len() > SPILL_BYTES
                {
                    // What came before the port was cut off is no packet.
                    bytes.truncate(SPILL_BYTES);
                    self.ports[port].cut_off();
                }
                answer
            }
        }
    }

    fn acknowledged(&mut self, now: u64, target: Target) {
        match (self.is_own(target), target.endpoint) {
            (true, 0) => {
                if let Some(request) = self.control.acknowledged() {
                    self.take_effect(now, request);
                }
            }
            (true, _) => {
                self.status_toggle = match self.status_toggle {
                    Toggle::Data0 => Toggle::Data1,
                    Toggle::Data1 => Toggle::Data0,
                };
            }
            (false, _) => {
                let device = self.answered.and_then(|index| self.ports[index].device.as_mut());
                if let Some(device) = device {
                    device.acknowledged(now, target);
                }
            }
        }
    }

    fn data_out(&mut self, now: u64, target: Target, toggle: Toggle, bytes: &[u8]) -> Handshake {
        self.tick(now);
        if self.is_own(target) {
            return if target.endpoint == 0 { self.control.data_out(bytes) } else { Handshake::Silent };
        }
        self.ask(now, Handshake::Silent, |device| device.data_out(now, target, toggle, bytes)).0
    }

    fn low_speed_next(&mut self, low: bool) {
        self.low_next = low;
    }

    fn complaints(&mut self) -> Vec<(Rule, String)> {
        let mut complaints = std::mem::take(&mut self.complaints);
        for device in self.ports.iter_mut().filter_map(|port| port.device.as_mut()) {
            complaints.extend(device.complaints());
        }
        complaints
    }

    fn translator(&mut self) -> Option<&mut dyn Translator> {
        if self.speed == Speed::High { Some(self) } else { None }
    }
}

impl Translator for Hub {
    fn start_split(&mut self, now: u64, token: Token, start: Start) -> Started {
        self.tick(now);
        if self.translates(&token) {
            self.check_split(now, &token);
            return self.engine.start(now, token, start);
        }
        self.forward(Started::Silent, |hub| hub.start_split(now, token, start.clone()))
    }

    fn complete_split(&mut self, now: u64, token: Token) -> Completed {
        self.tick(now);
        if self.translates(&token) {
            return self.engine.complete(now, token);
        }
        self.forward(Completed::Silent, |hub| hub.complete_split(now, token))
    }
}
