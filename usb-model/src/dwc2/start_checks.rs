//! What has to be true of the core when a channel is started.

use super::Core;
use super::channel::Program;
use super::registers::*;
use crate::violation::Rule;
use crate::wire::Speed;

/// TRSTRCY, USB 2.0 §7.1.7.5.
const RECOVERY_US: u64 = 10_000;
/// PHY clocks in a microsecond, with an 8-bit path.
const CLOCKS: u64 = 60;
/// Words of the receive FIFO beside a packet: its status, and the end of its transfer.
const STATUS_WORDS: u32 = 2;

impl Core {
    pub(super) fn check_machinery(&self, index: usize, program: &Program) {
        let master = self.registers.master;
        let channel = &self.channels[index];
        if master & GAHBCFG_DMA == 0 {
            self.blame(Rule::DmaOff, format!("GAHBCFG {master:#010x}"));
        }
        if !channel.address.is_multiple_of(4) {
            self.blame(Rule::DmaUnaligned, format!("HCDMA {:#010x}", channel.address));
        }
        if self.registers.host & HCFG_DESCRIPTOR_DMA != 0 {
            self.blame(Rule::DescriptorDma, format!("HCFG {:#010x}", self.registers.host));
        }
        if self.registers.host & HCFG_CLOCK != 0 {
            self.blame(Rule::ClockSelect, format!("HCFG {:#010x}", self.registers.host));
        }
        if self.disable_is_known() {
            self.blame(Rule::PortNotEnabled, program.name());
        }
        let since = self.now - self.port.reset_end;
        if since < RECOVERY_US {
            self.blame(Rule::ResetRecovery, format!("{} {since} us after a reset", program.name()));
        }
        if channel.interrupts != 0 {
            self.blame(Rule::NotAcknowledged, format!("HCINT {:#x} before {}", channel.interrupts, program.name()));
        }
        let unmasked = channel.mask & HCINT_HALTED != 0
            && self.registers.channel_mask & 1 << index != 0
            && self.registers.mask & GINT_CHANNEL != 0
            && master & GAHBCFG_GLOBAL != 0;
        if !unmasked {
            self.blame(Rule::NotUnmasked, program.name());
        }
        self.check_interval();
        self.check_fifos(program);
    }

    fn check_interval(&self) {
        let clocks = if self.registers.phy & GUSBCFG_PHY_16 != 0 { CLOCKS / 2 } else { CLOCKS };
        let wanted = clocks * self.frame_us() - 1;
        if self.port.enabled() && u64::from(self.registers.interval & 0xffff) != wanted {
            self.blame(Rule::FrameInterval, format!("HFIR {}, not {wanted}", self.registers.interval));
        }
    }

    fn check_fifos(&self, program: &Program) {
        let [receive, non_periodic, periodic] = self.registers.fifos;
        let receive = receive & 0xffff;
        let span = |fifo: u32| (fifo & 0xffff, (fifo & 0xffff) + (fifo >> 16));
        let spans = [(0, receive), span(non_periodic), span(periodic)];
        let apart = |a: (u32, u32), b: (u32, u32)| a.1 <= b.0 || b.1 <= a.0;
        if !(apart(spans[0], spans[1]) && apart(spans[0], spans[2]) && apart(spans[1], spans[2])) {
            self.blame(Rule::FifoOverlap, format!("{spans:?}"));
        }
        let end = spans.iter().map(|span| span.1).max().unwrap_or(0) + self.channels.len() as u32;
        if end > self.build.fifo_words() {
            self.blame(Rule::FifoTooDeep, format!("{end} of {} words", self.build.fifo_words()));
        }
        let words = program.packet_bytes.div_ceil(4) as u32;
        let (depth, needed) = match (program.input, program.periodic()) {
            (true, _) => (receive, words + STATUS_WORDS),
            (false, true) => (periodic >> 16, words),
            (false, false) => (non_periodic >> 16, words),
        };
        if depth < needed {
            self.blame(Rule::FifoTooSmall, format!("{depth} words for {}", program.name()));
        }
        if self.flushed != (true, true) {
            self.blame(Rule::FifoNotFlushed, program.name());
        }
    }

    /// The speed at which a program's packets go over the wire that the root port drives.
    pub(super) fn wire_speed(&self, program: &Program) -> Speed {
        match self.port.speed {
            Some(Speed::Full) if program.low_speed => Speed::Low,
            speed => speed.unwrap_or(Speed::Full),
        }
    }
}
