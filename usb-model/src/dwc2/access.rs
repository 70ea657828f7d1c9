//! Register reads and writes.

use super::channel::Channel;
use super::registers::*;
use super::{Core, FLUSH_US, RESET_US, Registers};
use crate::violation::Rule;

impl Core {
    /// Reads a register.
    pub fn read(&mut self, offset: u32) -> u32 {
        if self.timers.reset_end.is_some() && !matches!(offset, GRSTCTL | GSNPSID) {
            self.blame(Rule::AccessInReset, format!("read of {offset:#05x}"));
        }
        match offset {
            GOTGCTL => self.registers.otg,
            GAHBCFG => self.registers.master,
            GUSBCFG => self.registers.phy,
            GRSTCTL => self.reset_control(),
            GINTSTS => self.interrupts(),
            GINTMSK => self.registers.mask,
            GRXFSIZ => self.registers.fifos[0],
            GNPTXFSIZ => self.registers.fifos[1],
            HPTXFSIZ => self.registers.fifos[2],
            GSNPSID => self.build.id,
            GHWCFG1..=GHWCFG4 => self.build.hardware[(offset - GHWCFG1) as usize / 4],
            HCFG => self.registers.host,
            HFIR => self.registers.interval,
            HFNUM => self.frame_register(),
            HAINT => self.channel_interrupts(),
            HAINTMSK => self.registers.channel_mask,
            HPRT => self.read_port(),
            CHANNEL_0..CHANNEL_END => self.read_channel(offset),
            PCGCTL => self.registers.power,
            _ => 0,
        }
    }

    /// Writes a register.
    pub fn write(&mut self, offset: u32, value: u32) {
        let settling =
            self.timers.reset_end.is_some() || self.timers.idle_from > self.now && self.wire_free <= self.now;
        if settling && offset != GRSTCTL {
            self.blame(Rule::AccessInReset, format!("write of {value:#010x} to {offset:#05x}"));
        }
        if (HCFG..PCGCTL).contains(&offset) && !self.is_host() {
            self.blame(Rule::DeviceMode, format!("write of {value:#010x} to {offset:#05x}"));
        }
        match offset {
            GOTGCTL => self.registers.otg = value,
            GAHBCFG => self.registers.master = value,
            GUSBCFG => self.write_phy(value),
            GRSTCTL => self.write_reset(value),
            GINTSTS => self.acknowledge(value),
            GINTMSK => self.registers.mask = value,
            GRXFSIZ => self.write_fifo(0, value),
            GNPTXFSIZ => self.write_fifo(1, value),
            HPTXFSIZ => self.write_fifo(2, value),
            HCFG => self.registers.host = value,
            HFIR => self.registers.interval = value,
            HAINTMSK => self.registers.channel_mask = value,
            HPRT => self.write_port(value),
            CHANNEL_0..CHANNEL_END => self.write_channel(offset, value),
            PCGCTL => self.registers.power = value,
            _ => {}
        }
    }

    fn reset_control(&self) -> u32 {
        let mut value = 0;
        if self.timers.reset_end.is_some() {
            value |= GRSTCTL_CORE;
        }
        value |= self.timers.flush_end.map_or(0, |(_, bits)| bits);
        if self.is_idle() {
            value |= GRSTCTL_IDLE;
        }
        value
    }

    fn is_idle(&self) -> bool {
        let busy = self.timers.reset_end.is_some() || self.timers.idle_from > self.now || self.wire_free > self.now;
        !busy && !self.defects.never_idle
    }

    fn write_reset(&mut self, value: u32) {
        if value & GRSTCTL_CORE != 0 {
            if !self.is_idle() {
                self.blame(Rule::ResetWhileBusy, "the bus master is not idle");
            }
            self.soft_reset();
        }
        let flush = value & (GRSTCTL_RX_FLUSH | GRSTCTL_TX_FLUSH);
        if flush != 0 {
            if self.channels.iter().any(|channel| channel.run.is_some()) {
                self.blame(Rule::FifoNotFlushed, "a flush while channels run");
            }
            self.flushed.0 |= flush & GRSTCTL_TX_FLUSH != 0 && value >> 6 & 0x1f == 0x10;
            self.flushed.1 |= flush & GRSTCTL_RX_FLUSH != 0;
            let end = if self.defects.never_flushes { u64::MAX } else { self.now + FLUSH_US };
            self.timers.flush_end = Some((end, flush));
        }
    }

    fn soft_reset(&mut self) {
        let phy = self.registers.phy & GUSBCFG_PHY | self.build.phy & !GUSBCFG_PHY;
        self.registers = Registers { phy, fifos: self.build.fifos, ..Registers::default() };
        self.phy_at_reset = Some(phy & GUSBCFG_PHY);
        self.flushed = (false, false);
        self.disconnected = false;
        self.unsettled = true;
        for channel in &mut self.channels {
            *channel = Channel { lent: channel.lent, ..Channel::default() };
        }
        self.reset_port();
        self.timers.host_from = None;
        self.choose_role();
        let end = if self.defects.never_leaves_reset { u64::MAX } else { self.now + RESET_US };
        self.timers.reset_end = Some(end);
    }

    fn write_phy(&mut self, value: u32) {
        let fixed = self.build.phy_fixed;
        self.registers.phy = value & !fixed | self.build.phy & fixed;
        if value & GUSBCFG_FORCE_HOST != 0 && value & GUSBCFG_FORCE_DEVICE != 0 {
            self.blame(Rule::BothRoles, format!("GUSBCFG {value:#010x}"));
        }
        self.choose_role();
    }

    fn write_fifo(&mut self, which: usize, value: u32) {
        self.registers.fifos[which] = value;
        self.flushed = (false, false);
    }

    /// GINTSTS.
    pub(super) fn interrupts(&self) -> u32 {
        let set = |on: bool, bit: u32| if on { bit } else { 0 };
        set(self.is_host(), GINT_HOST)
            | set(self.frame_index(self.now) > self.frame_seen, GINT_SOF)
            | set(self.port.changes() != 0, GINT_PORT)
            | set(self.channel_interrupts() & self.registers.channel_mask != 0, GINT_CHANNEL)
            | set(self.disconnected, GINT_DISCONNECT)
    }

    /// Any of [`interrupts`](Self::interrupts) that GINTMSK lets through. Asked at every step, so it looks no further
    /// than it has to.
    pub(super) fn unmasked_interrupt(&self) -> bool {
        let wanted = |bit: u32| self.registers.mask & bit != 0;
        wanted(GINT_HOST) && self.is_host()
            || wanted(GINT_PORT) && self.port.changes() != 0
            || wanted(GINT_DISCONNECT) && self.disconnected
            || wanted(GINT_SOF) && self.frame_index(self.now) > self.frame_seen
            || wanted(GINT_CHANNEL) && self.channel_interrupts() & self.registers.channel_mask != 0
    }

    fn acknowledge(&mut self, value: u32) {
        if value & GINT_SOF != 0 {
            self.frame_seen = self.frame_index(self.now);
        }
        if value & GINT_DISCONNECT != 0 {
            self.disconnected = false;
        }
    }

    /// HAINT.
    fn channel_interrupts(&self) -> u32 {
        let bit = |(at, channel): (usize, &Channel)| u32::from(channel.interrupts & channel.mask != 0) << at;
        self.channels.iter().enumerate().map(bit).fold(0, |all, bit| all | bit)
    }

    fn frame_register(&mut self) -> u32 {
        if !self.port.enabled() {
            return 0x3fff;
        }
        self.frame_read = self.frame_index(self.now);
        let (index, clocks) = (self.frame_index(self.now), u64::from(self.registers.interval) + 1);
        let left = (self.frame_start(index + 1) - self.now) * clocks / self.frame_us();
        (index as u32 & 0x3fff) | (left.min(0xffff) as u32) << 16
    }

    /// When the next start of a frame interrupts.
    pub(super) fn next_frame_interrupt(&self) -> Option<u64> {
        let wanted = self.registers.mask & GINT_SOF != 0 && self.port.enabled();
        let index = self.frame_index(self.now);
        (wanted && index <= self.frame_seen).then(|| self.frame_start(index + 1))
    }
}
