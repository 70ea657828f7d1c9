//! What the host has told each device so far: toggles, control stages, addresses and the way to them.

use std::collections::HashMap;

use super::channel::Program;
use crate::split::Kind;
use crate::violation::{Log, Rule};
use crate::wire::Toggle;

/// An endpoint of a device, and a direction.
type Pipe = (u8, u8, bool);
/// The way to a device: hub and port if split, and whether it is a low-speed one.
type Way = (Option<(u8, u8)>, bool);

/// Where a control transfer stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stage {
    Data,
    Status,
}

#[derive(Debug, Clone, Copy)]
struct Control {
    setup: [u8; 8],
    stage: Stage,
    left: usize,
    data1: bool,
}

impl Control {
    fn input(&self) -> bool {
        self.setup[0] & 0x80 != 0
    }
}

/// The eavesdropper.
#[derive(Debug, Default)]
pub(super) struct Snoop {
    /// DATA1 is next; none: it cannot be known.
    toggles: HashMap<Pipe, Option<bool>>,
    controls: HashMap<(u8, u8), Control>,
    ways: HashMap<u8, Way>,
    /// The last data to a device was answered by NYET.
    pings: HashMap<(u8, u8), bool>,
    /// Translators' buffers that hubs were told to clear: hub, address, endpoint, from the device.
    cleared: Vec<(u8, u8, u8, bool)>,
}

fn way(program: &Program) -> Way {
    (program.split.map(|split| (split.hub, split.port)), program.low_speed)
}

impl Snoop {
    /// A device was given this address.
    pub fn knows(&self, address: u8) -> bool {
        self.ways.contains_key(&address)
    }

    /// Holds a program that is started against what is known.
    pub fn check(&self, program: &Program, log: &Log, now: u64) {
        let blame = |rule: Rule, detail: &str| log.add(now, rule, format!("{}: {detail}", program.name()));
        if let Some((split, low)) = self.ways.get(&program.target.address) {
            match (split, way(program).0) {
                (Some(_), None) => blame(Rule::SplitMissing, "it is behind a translator"),
                (Some(known), Some(said)) if *known != said => {
                    blame(Rule::SplitHub, &format!("it is at {known:?}, not {said:?}"))
                }
                (None, Some(said)) => blame(Rule::SplitHub, &format!("it is not behind {said:?}")),
                _ => {}
            }
            if *low != program.low_speed {
                blame(Rule::LowSpeedBit, "not its speed");
            }
        }
        let sends = program.split.is_none_or(|split| !split.complete) && !program.input && !program.is_setup();
        let pings = self.pings.get(&(program.target.address, program.target.endpoint)) == Some(&true);
        if sends && program.bytes > 0 && pings && !program.ping {
            blame(Rule::Ping, "NYET came before");
        }
        match program.kind {
            Some(Kind::Control) => self.check_control(program, &blame),
            _ => {
                let pipe = (program.target.address, program.target.endpoint, program.input);
                let expected = self.toggles.get(&pipe).copied().unwrap_or(Some(false));
                if expected.is_some_and(|data1| data1 != (program.toggle() == Toggle::Data1)) {
                    blame(Rule::Toggle, "not the endpoint's");
                }
            }
        }
    }

    fn check_control(&self, program: &Program, blame: &dyn Fn(Rule, &str)) {
        if program.is_setup() {
            return;
        }
        let Some(control) = self.controls.get(&(program.target.address, program.target.endpoint)) else {
            return blame(Rule::ControlStage, "no SETUP came before");
        };
        let data1 = program.toggle() == Toggle::Data1;
        match control.stage {
            Stage::Data if program.input == control.input() => {
                if program.bytes > control.left.next_multiple_of(program.packet_bytes.max(1)) {
                    blame(Rule::ControlStage, "more data than wLength");
                }
                if data1 != control.data1 {
                    blame(Rule::Toggle, "not the data stage's");
                }
            }
            Stage::Data => blame(Rule::ControlStage, "data is left"),
            Stage::Status => {
                let has_data = control.setup[6..8] != [0, 0];
                if program.input == (control.input() && has_data) {
                    blame(Rule::ControlStage, "the status stage goes the other way");
                }
                if !program.input && program.bytes > 0 {
                    blame(Rule::ControlStage, "the status stage is empty");
                }
                if !data1 {
                    blame(Rule::Toggle, "the status stage is DATA1");
                }
            }
        }
    }

    /// The device took a SETUP.
    pub fn setup(&mut self, program: &Program, packet: [u8; 8]) {
        let left = usize::from(u16::from_le_bytes([packet[6], packet[7]]));
        let stage = if left == 0 { Stage::Status } else { Stage::Data };
        let pipe = (program.target.address, program.target.endpoint);
        self.controls.insert(pipe, Control { setup: packet, stage, left, data1: true });
        self.pings.remove(&pipe);
    }

    /// A data packet of `bytes` bytes went over, and the host knows.
    pub fn packet(&mut self, program: &Program, bytes: usize, nyet: bool) {
        let target = program.target;
        if !program.input {
            self.pings.insert((target.address, target.endpoint), nyet);
        }
        if program.kind != Some(Kind::Control) {
            let toggle = self.toggles.entry((target.address, target.endpoint, program.input)).or_insert(Some(false));
            let was = toggle.unwrap_or(program.toggle() == Toggle::Data1);
            *toggle = Some(!was);
            return;
        }
        let Some(control) = self.controls.get_mut(&(target.address, target.endpoint)) else { return };
        match control.stage {
            Stage::Data => {
                control.left = control.left.saturating_sub(bytes);
                control.data1 = !control.data1;
                if control.left == 0 || bytes < program.packet_bytes {
                    control.stage = Stage::Status;
                }
            }
            Stage::Status => {
                let setup = control.setup;
                self.controls.remove(&(target.address, target.endpoint));
                self.request_done(program, setup);
            }
        }
    }

    /// Part of a packet came: MDATA. What the host makes of the rest is its own matter.
    pub fn part(&mut self, program: &Program) {
        self.toggles.insert((program.target.address, program.target.endpoint, program.input), None);
    }

    /// A STALL ends a control transfer.
    pub fn stall(&mut self, program: &Program) {
        if program.kind == Some(Kind::Control) {
            self.controls.remove(&(program.target.address, program.target.endpoint));
        }
    }

    /// Requests that change what is known.
    fn request_done(&mut self, program: &Program, setup: [u8; 8]) {
        let address = program.target.address;
        let value = u16::from_le_bytes([setup[2], setup[3]]);
        match (setup[0], setup[1]) {
            (0x00, 5) => {
                let given = value as u8;
                self.forget(given);
                self.ways.insert(given, way(program));
            }
            (0x00, 9) | (0x01, 11) => self.toggles.retain(|pipe, _| pipe.0 != address),
            (0x02, 1) if value == 0 => {
                self.toggles.remove(&(address, setup[4] & 0xf, setup[4] & 0x80 != 0));
            }
            (0x23, 8) => {
                let (endpoint, device) = ((value & 0xf) as u8, (value >> 4 & 0x7f) as u8);
                self.cleared.push((address, device, endpoint, value >> 15 == 1));
            }
            _ => {}
        }
    }

    /// Takes what hubs were told to clear.
    pub fn take_cleared(&mut self) -> Vec<(u8, u8, u8, bool)> {
        std::mem::take(&mut self.cleared)
    }

    fn forget(&mut self, address: u8) {
        self.toggles.retain(|pipe, _| pipe.0 != address);
        self.controls.retain(|pipe, _| pipe.0 != address);
        self.pings.retain(|pipe, _| pipe.0 != address);
    }
}
