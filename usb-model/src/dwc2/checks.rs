//! What has to be true of a program by itself.

use super::Core;
use super::channel::{Program, Split};
use super::registers::SETUP;
use crate::split::Kind;
use crate::violation::Rule;
use crate::wire::Speed;

/// HCSPLT's payload position "all".
const WHOLE: u32 = 3;
/// The most that a split carries (USB 2.0 §11.18.1).
const SPLIT_BYTES: usize = 188;

impl Core {
    pub(super) fn check_program(&self, program: &Program) {
        let blame = |rule: Rule| {
            self.blame(
                rule,
                format!(
                    "{}: {} bytes in {} packets of {}",
                    program.name(),
                    program.bytes,
                    program.packets,
                    program.packet_bytes
                ),
            );
        };
        let packets = program.bytes.div_ceil(program.packet_bytes.max(1)).max(1);
        if program.packets as usize != packets {
            blame(Rule::PacketCount);
        }
        if program.input && !program.bytes.is_multiple_of(program.packet_bytes.max(1)) {
            blame(Rule::InputMultiple);
        }
        if !self.packet_size_exists(program) {
            blame(Rule::PacketSize);
        }
        if program.count == 0 || program.periodic() && program.packets > 1 {
            blame(Rule::PeriodicCount);
        }
        let shape = program.bytes == 8 && !program.input && program.kind == Some(Kind::Control);
        let carries_none = program.split.is_some_and(|split| split.complete) && program.bytes == 0;
        if program.identifier == SETUP && !shape && !carries_none {
            blame(Rule::SetupShape);
        }
        if self.port.speed == Some(Speed::Low) && !program.low_speed {
            blame(Rule::LowSpeedBit);
        }
        if let Some(split) = program.split {
            self.check_split(program, split);
        }
    }

    fn packet_size_exists(&self, program: &Program) -> bool {
        let bytes = program.packet_bytes;
        let speed = match (self.port.speed, program.split) {
            (Some(Speed::High), None) => Speed::High,
            _ if program.low_speed => Speed::Low,
            _ => Speed::Full,
        };
        match (program.kind, speed) {
            (Some(Kind::Control), Speed::Low) => bytes == 8,
            (Some(Kind::Control), Speed::Full) => matches!(bytes, 8 | 16 | 32 | 64),
            (Some(Kind::Control), Speed::High) => bytes == 64,
            (Some(Kind::Bulk), Speed::Full) => matches!(bytes, 8 | 16 | 32 | 64),
            (Some(Kind::Bulk), Speed::High) => bytes == 512,
            (Some(Kind::Interrupt), Speed::Low) => (1..=8).contains(&bytes),
            (Some(Kind::Interrupt), Speed::Full) => (1..=64).contains(&bytes),
            (Some(Kind::Interrupt), Speed::High) => (1..=1024).contains(&bytes),
            (Some(Kind::Bulk), Speed::Low) | (None, _) => false,
        }
    }

    fn check_split(&self, program: &Program, split: Split) {
        let blame =
            |rule: Rule| self.blame(rule, format!("{} via hub {} port {}", program.name(), split.hub, split.port));
        if self.port.enabled() && self.port.speed != Some(Speed::High) {
            blame(Rule::SplitOnSlowBus);
        }
        let carried = if split.complete && !program.input { 0 } else { program.packet_bytes.min(SPLIT_BYTES) };
        if program.packets != 1 || program.bytes > carried {
            blame(Rule::SplitSize);
        }
        if split.position != WHOLE {
            blame(Rule::SplitPosition);
        }
        if split.hub == 0 || split.port == 0 || !self.snoop.knows(split.hub) {
            blame(Rule::SplitHub);
        }
    }
}
