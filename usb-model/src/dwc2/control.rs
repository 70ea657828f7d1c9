//! Channels as software drives them: start, halt, acknowledge.

use super::Core;
use super::channel::{Channel, Program, Run};
use super::registers::*;
use crate::violation::Rule;

/// A transaction that is under way ends before a channel halts.
const HALT_US: u64 = 2;

impl Core {
    fn split_offset(&self, offset: u32) -> (usize, u32) {
        (((offset - CHANNEL_0) / CHANNEL_STRIDE) as usize, (offset - CHANNEL_0) % CHANNEL_STRIDE)
    }

    pub(super) fn read_channel(&mut self, offset: u32) -> u32 {
        let (index, register) = self.split_offset(offset);
        let Some(channel) = self.channels.get(index) else { return 0 };
        match register {
            HCCHAR => {
                let enabled = if channel.run.is_some() { HCCHAR_ENABLE } else { 0 };
                let halting = if channel.run.is_some_and(|run| run.halting) { HCCHAR_DISABLE } else { 0 };
                channel.characteristics & !(HCCHAR_ENABLE | HCCHAR_DISABLE) | enabled | halting
            }
            HCSPLT => channel.split,
            HCINT => channel.interrupts,
            HCINTMSK => channel.mask,
            HCTSIZ => channel.size,
            HCDMA => channel.address,
            _ => 0,
        }
    }

    pub(super) fn write_channel(&mut self, offset: u32, value: u32) {
        let (index, register) = self.split_offset(offset);
        if index >= self.channels.len() {
            return self.blame(Rule::NoSuchChannel, format!("channel {index}"));
        }
        let running = self.channels[index].run.is_some();
        if running && matches!(register, HCSPLT | HCTSIZ | HCDMA) {
            return self
                .blame(Rule::ChannelBusy, format!("channel {index}, write of {value:#010x} to +{register:#04x}"));
        }
        let channel = &mut self.channels[index];
        match register {
            HCCHAR => self.write_characteristics(index, value),
            HCSPLT => channel.split = value,
            HCINT => channel.interrupts &= !value,
            HCINTMSK => channel.mask = value,
            HCTSIZ => channel.size = value,
            HCDMA => channel.address = value,
            _ => {}
        }
    }

    fn write_characteristics(&mut self, index: usize, value: u32) {
        let (enable, disable) = (value & HCCHAR_ENABLE != 0, value & HCCHAR_DISABLE != 0);
        let running = self.channels[index].run.is_some();
        match (running, enable, disable) {
            (true, true, true) => self.halt(index),
            (true, false, true) => self.blame(Rule::HaltIncomplete, format!("channel {index}: CHDIS without CHENA")),
            (true, _, false) => self.blame(Rule::ChannelBusy, format!("channel {index}: HCCHAR {value:#010x}")),
            (false, true, true) => self.channels[index].interrupts |= HCINT_HALTED,
            (false, true, false) => self.start(index, value),
            (false, false, _) => self.channels[index].characteristics = value,
        }
    }

    fn halt(&mut self, index: usize) {
        let program = self.channels[index].program();
        if program.periodic() && !self.defects.never_runs {
            self.blame(Rule::PeriodicHalted, program.name());
        }
        let stuck = self.defects.never_halts || !self.port.enabled();
        let at = self.wire_free.max(self.now) + HALT_US;
        if let Some(run) = &mut self.channels[index].run {
            run.halting = true;
            run.at = (!stuck).then_some(at);
        }
    }

    fn start(&mut self, index: usize, value: u32) {
        self.channels[index].characteristics = value;
        let program = self.channels[index].program();
        self.check_machinery(index, &program);
        self.check_program(&program);
        self.snoop.check(&program, &self.log, self.now);
        self.check_rivals(index, &program);
        let (at, frame) = self.first_moment(&program);
        let at = at.filter(|_| self.port.enabled() && !self.defects.never_runs);
        self.starts += 1;
        self.unsettled = true;
        self.channels[index].run = Some(Run { at, frame, order: self.starts, halting: false });
    }

    /// When a started channel acts, and in which (micro)frame, if that is told.
    fn first_moment(&self, program: &Program) -> (Option<u64>, Option<u64>) {
        let soon = self.now + 1;
        if !program.periodic() {
            return (Some(soon.max(self.wire_free)), None);
        }
        let (present, read) = (self.frame_index(self.now), self.frame_read);
        let named_read = read % 2 == u64::from(program.odd_frame);
        if named_read || present > read + 1 {
            let detail = format!("{} in frame {present}, after HFNUM showed {read}", program.name());
            self.blame(Rule::OddFrame, detail);
        }
        // One that is named is taken at once, while it lasts, and the other one when it begins: Linux `dwc2/hcd.c`,
        // dwc2_hc_set_even_odd_frame. So who named the next one, and was overtaken by it, has it still.
        let frame = if present % 2 == u64::from(program.odd_frame) { present } else { present + 1 };
        (Some(soon.max(self.frame_start(frame) + 1)), Some(frame))
    }

    /// Buffers that two channels share.
    fn check_rivals(&self, index: usize, program: &Program) {
        let end = |program: &Program| program.address as usize + program.bytes;
        let clash = |channel: &Channel| {
            let other = channel.program();
            let apart = end(&other) <= program.address as usize || end(program) <= other.address as usize;
            channel.run.is_some() && !apart && (program.input || other.input) && other.bytes > 0 && program.bytes > 0
        };
        if self.channels.iter().enumerate().any(|(at, channel)| at != index && clash(channel)) {
            self.blame(Rule::BufferShared, program.name());
        }
    }
}
