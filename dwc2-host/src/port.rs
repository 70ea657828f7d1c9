//! The root port: from power to a device that has been reset, and back.

use embassy_usb_driver::Speed;

use crate::registers::{Gahbcfg, Gusbcfg, Hfir, Hprt};
use crate::slot::{Activity, Fate};
use crate::state::State;
use crate::timing::{
    DEBOUNCE_US, ENABLE_LIMIT_US, FAULT_PAUSE_US, HALT_LIMIT_US, RESET_RECOVERY_US, ROOT_RESET_US, SPLIT_DRAIN_US,
};
use crate::{Fault, PIPES, SpeedLimit, TransferError};

/// PHY clocks in a microframe and in a frame, at 60 MHz.
const HIGH_SPEED_INTERVAL: u32 = 7_500;
const FULL_SPEED_INTERVAL: u32 = 60_000;

/// Where the core and its root port stand. Phases before `Empty` are the core's start ([`crate::start`]).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Phase {
    /// Shut down.
    Off,
    /// Not touched yet.
    Identify,
    /// The bus master finishes before the soft reset.
    AwaitIdle { until: u64 },
    /// The soft reset runs.
    AwaitReset { until: u64 },
    /// The bus master settles after it.
    AwaitIdleAgain { until: u64 },
    /// The core becomes a host.
    AwaitHost { from: u64, until: u64 },
    /// The transmit FIFOs are emptied.
    AwaitTransmitFlush { until: u64 },
    /// The receive FIFO is emptied.
    AwaitReceiveFlush { until: u64 },
    /// Channels that survived the reset halt.
    AwaitHalts { until: u64 },
    /// Nothing is plugged in.
    Empty,
    /// Something is, since then.
    Debounce { since: u64 },
    /// The channels halt before a reset that the stack asked for.
    Quieten { until: u64 },
    /// The bus is reset.
    Reset { until: u64 },
    /// The port enables itself.
    AwaitEnable { until: u64 },
    /// The device recovers.
    Recover { until: u64, speed: Speed },
    /// The device may be talked to.
    Ready { speed: Speed },
    /// A fault; the core is started anew then.
    Failed { until: u64 },
}

impl Phase {
    /// The core has been started: its interrupts and its port mean something.
    pub(crate) fn started(self) -> bool {
        use Phase::*;
        matches!(
            self,
            Empty
                | Debounce { .. }
                | Quieten { .. }
                | Reset { .. }
                | AwaitEnable { .. }
                | Recover { .. }
                | Ready { .. }
        )
    }
}

impl State<'_> {
    /// Takes the core and the port as far as they go now.
    pub(crate) fn advance(&mut self, now: u64) {
        loop {
            let before = self.phase;
            if before.started() {
                self.watch_port(now);
            } else {
                self.advance_start(now);
            }
            if self.phase == before {
                break;
            }
        }
    }

    fn watch_port(&mut self, now: u64) {
        let port: Hprt = self.hardware.read();
        let news = port.connect_detected() || port.enable_changed() || port.overcurrent_changed();
        if news {
            self.hardware.write(
                port.kept()
                    .with_connect_detected(port.connect_detected())
                    .with_enable_changed(port.enable_changed())
                    .with_overcurrent_changed(port.overcurrent_changed()),
            );
        }
        if port.overcurrent() {
            self.hardware.modify_port(|port| port.with_power(false));
            self.news.overcurrent();
            return self.fail(Fault::OverCurrent, now);
        }
        match self.phase {
            Phase::Empty | Phase::Debounce { .. } => self.debounce(port, now),
            _ if !port.connected() || port.connect_detected() => self.lose_device(),
            Phase::Quieten { until } => {
                if self.channels.iter().all(Option::is_none) {
                    self.start_reset(now);
                } else if now >= until {
                    self.fail(Fault::ChannelStuck { channel: self.first_busy_channel() }, now);
                }
            }
            Phase::Reset { until } if now >= until => {
                self.hardware.modify_port(|port| port.with_reset(false));
                self.phase = Phase::AwaitEnable { until: now + ENABLE_LIMIT_US };
            }
            Phase::AwaitEnable { .. } if port.enabled() => {
                let speed = match port.speed() {
                    0 => Speed::High,
                    1 => Speed::Full,
                    _ => Speed::Low,
                };
                self.set_frame_interval(speed);
                self.phase = Phase::Recover { until: now + RESET_RECOVERY_US, speed };
            }
            Phase::AwaitEnable { until } if now >= until => self.fail(Fault::PortNotEnabled, now),
            Phase::Recover { .. } | Phase::Ready { .. } if !port.enabled() => self.fail(Fault::PortDisabled, now),
            Phase::Recover { until, speed } if now >= until => {
                self.phase = Phase::Ready { speed };
                if core::mem::take(&mut self.reset_asked) {
                    self.news.end_reset();
                } else {
                    self.news.connect(speed);
                }
            }
            _ => {}
        }
    }

    fn debounce(&mut self, port: Hprt, now: u64) {
        self.phase = match self.phase {
            _ if !port.connected() => Phase::Empty,
            Phase::Debounce { since } if !port.connect_detected() => {
                if now < since + DEBOUNCE_US {
                    return;
                }
                return self.start_reset(now);
            }
            _ => Phase::Debounce { since: now },
        };
    }

    fn start_reset(&mut self, now: u64) {
        self.hardware.modify_port(|port| port.with_reset(true));
        self.phase = Phase::Reset { until: now + ROOT_RESET_US };
    }

    fn set_frame_interval(&mut self, speed: Speed) {
        let clocks = if speed == Speed::High { HIGH_SPEED_INTERVAL } else { FULL_SPEED_INTERVAL };
        // A 16-bit UTMI+ path runs at half the clock.
        let half = self.hardware.read::<Gusbcfg>().phy_16_bit();
        let clocks = if half { clocks / 2 } else { clocks };
        self.hardware.write(Hfir::default().with_interval((clocks - 1) as u16));
    }

    fn first_busy_channel(&self) -> u8 {
        self.channels.iter().position(Option::is_some).unwrap_or(0) as u8
    }

    /// The device is gone. Its channels may never halt any more, so the core is reset (`hathach/tinyusb` PR 3815).
    fn lose_device(&mut self) {
        self.drop_all();
        if core::mem::take(&mut self.reset_asked) {
            self.news.end_reset();
        }
        self.news.disconnect();
        self.phase = Phase::Identify;
    }

    /// Resets the bus at the stack's wish. Pipes to devices that have an address are no good any more.
    pub(crate) fn ask_reset(&mut self, now: u64) {
        self.news.take_reset_over();
        if !matches!(self.phase, Phase::Ready { .. }) {
            return self.news.end_reset();
        }
        self.reset_asked = true;
        self.phase = Phase::Quieten { until: now + HALT_LIMIT_US + SPLIT_DRAIN_US };
        let gone = Fate::Failed(TransferError::Disconnected);
        for index in 0..PIPES {
            let Some(slot) = &mut self.slots[index] else { continue };
            slot.stale = slot.endpoint.address != 0;
            match slot.activity {
                Activity::Running { .. } | Activity::Halting { .. } => self.abandon(index, gone, now),
                Activity::Waiting { .. } | Activity::Exchange => self.end(index, gone.result()),
                Activity::Idle | Activity::Done(_) => {}
            }
        }
    }

    /// Names a fault, stops the core as far as it listens, and starts it anew after a pause.
    pub(crate) fn fail(&mut self, fault: Fault, now: u64) {
        self.fault = Some(fault);
        if self.phase.started() {
            self.hardware.modify(|master: Gahbcfg| master.with_global_interrupt(false));
        }
        self.lose_device();
        self.phase = Phase::Failed { until: now + FAULT_PAUSE_US };
    }

    /// Turns the port off and leaves the core idle.
    pub(crate) fn shut_down(&mut self) {
        if self.phase.started() {
            self.hardware.modify(|master: Gahbcfg| master.with_global_interrupt(false));
            self.hardware.modify_port(|port| port.with_power(false));
        }
        self.lose_device();
        self.phase = Phase::Off;
    }

    /// High speed is out of the question.
    pub(crate) fn full_speed_only(&self) -> bool {
        self.config.speed_limit == SpeedLimit::Full
    }
}
