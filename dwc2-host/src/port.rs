//! The root port: from power to a device that has been reset, and back.

use embassy_usb_driver::Speed;

use crate::registers::{Gahbcfg, Gusbcfg, Hfir, Hprt};
use crate::slot::{Activity, Fate};
use crate::state::State;
use crate::timing::{
    DEBOUNCE_US, ENABLE_LIMIT_US, FAULT_PAUSE_US, HALT_LIMIT_US, RESET_RECOVERY_US, ROOT_RESET_US, SPLIT_DRAIN_US,
    VISIT_US,
};
use crate::{Fault, PIPES, SpeedLimit, TransferError};

/// PHY clocks in a microframe and in a frame, at 60 MHz.
const HIGH_SPEED_INTERVAL: u32 = 7_500;
const FULL_SPEED_INTERVAL: u32 = 60_000;

/// Where the core and its root port stand, in the order of their coming. Phases before `Empty` are the core's start
/// ([`crate::start`]).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Phase {
    /// Shut down.
    Off,
    /// A fault; the core is started anew at the end.
    Failed,
    /// Not touched yet.
    Identify,
    /// The bus master finishes before the soft reset.
    AwaitIdle,
    /// The soft reset runs.
    AwaitReset,
    /// The bus master settles after it.
    AwaitIdleAgain,
    /// The core becomes a host.
    AwaitHost,
    /// The transmit FIFOs are emptied.
    AwaitTransmitFlush,
    /// The receive FIFO is emptied.
    AwaitReceiveFlush,
    /// Channels that survived the reset halt.
    AwaitHalts,
    /// Nothing is plugged in.
    Empty,
    /// Something is.
    Debounce,
    /// The channels halt before a reset that the stack asked for.
    Quieten,
    /// The bus is reset.
    Reset,
    /// The port enables itself.
    AwaitEnable,
    /// The device recovers.
    Recover,
    /// The device may be talked to.
    Ready,
}

impl Phase {
    /// The core has been started: its interrupts and its port mean something.
    pub(crate) fn started(self) -> bool {
        self >= Self::Empty
    }
}

impl State<'_> {
    /// Takes the core and the port as far as they go now. The port is looked at when there is news of it, and at
    /// the end of a phase that has one.
    pub(crate) fn advance(&mut self, now: u64, mut news: bool) {
        loop {
            let before = self.phase;
            let over = match before {
                Phase::Ready => false,
                // What is there already when the port gets its power need not be news.
                Phase::Empty | Phase::Quieten => true,
                _ => now >= self.phase_end,
            };
            if !before.started() {
                self.advance_start(now);
            } else if news || over {
                self.watch_port(now);
            }
            if self.phase == before {
                break;
            }
            news = true;
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
        let over = now >= self.phase_end;
        match self.phase {
            Phase::Empty | Phase::Debounce => self.debounce(port, now, over),
            _ if !port.connected() || port.connect_detected() => self.lose_device(),
            Phase::Quieten => match self.channels.iter().position(Option::is_some) {
                None => self.start_reset(now),
                Some(channel) if over => self.fail(Fault::ChannelStuck { channel: channel as u8 }, now),
                Some(_) => {}
            },
            Phase::Reset if over => {
                self.hardware.modify_port(|port| port.with_reset(false));
                self.enter(Phase::AwaitEnable, now + ENABLE_LIMIT_US);
            }
            Phase::AwaitEnable if port.enabled() => {
                self.speed = match port.speed() {
                    0 => Speed::High,
                    1 => Speed::Full,
                    _ => Speed::Low,
                };
                self.set_frame_interval();
                self.enter(Phase::Recover, now + RESET_RECOVERY_US);
            }
            Phase::AwaitEnable if over => self.fail(Fault::PortNotEnabled, now),
            Phase::Recover | Phase::Ready if !port.enabled() => self.fail(Fault::PortDisabled, now),
            Phase::Recover if over => {
                self.phase = Phase::Ready;
                if core::mem::take(&mut self.reset_asked) {
                    self.news.end_reset();
                } else {
                    self.news.connect(self.speed);
                }
            }
            _ => {}
        }
    }

    /// Goes to a phase that is over, or fails, at `end`.
    pub(crate) fn enter(&mut self, phase: Phase, end: u64) {
        self.phase = phase;
        self.phase_end = end + VISIT_US;
    }

    fn debounce(&mut self, port: Hprt, now: u64, over: bool) {
        if !port.connected() {
            self.phase = Phase::Empty;
        } else if self.phase == Phase::Empty || port.connect_detected() {
            self.enter(Phase::Debounce, now + DEBOUNCE_US);
        } else if over {
            self.start_reset(now);
        }
    }

    fn start_reset(&mut self, now: u64) {
        self.hardware.modify_port(|port| port.with_reset(true));
        self.enter(Phase::Reset, now + ROOT_RESET_US);
    }

    fn set_frame_interval(&mut self) {
        let clocks = if self.speed == Speed::High { HIGH_SPEED_INTERVAL } else { FULL_SPEED_INTERVAL };
        // A 16-bit UTMI+ path runs at half the clock.
        let half = self.hardware.read::<Gusbcfg>().phy_16_bit();
        let clocks = if half { clocks / 2 } else { clocks };
        self.hardware.write(Hfir::default().with_interval((clocks - 1) as u16));
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
        if self.phase != Phase::Ready {
            return self.news.end_reset();
        }
        self.reset_asked = true;
        self.enter(Phase::Quieten, now + HALT_LIMIT_US + SPLIT_DRAIN_US);
        let gone = Fate::Failed(TransferError::Disconnected);
        for index in 0..PIPES {
            let Some(slot) = &mut self.slots[index] else { continue };
            slot.stale = slot.endpoint.address != 0;
            match slot.activity {
                Activity::Running { .. } | Activity::Halting { .. } => self.abandon(index, gone, now),
                Activity::Waiting { .. } | Activity::Exchange => self.end(index, gone.result()),
                Activity::Idle | Activity::Done(_) | Activity::Kept(_) => {}
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
        self.enter(Phase::Failed, now + FAULT_PAUSE_US);
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

    /// Takes another speed limit: the port goes off, and the core is started anew after the pause that follows a fault.
    pub(crate) fn limit_speed(&mut self, limit: SpeedLimit) {
        if core::mem::replace(&mut self.config.speed_limit, limit) == limit || self.phase == Phase::Off {
            return;
        }
        let now = self.hardware.now();
        self.shut_down();
        self.enter(Phase::Failed, now + FAULT_PAUSE_US);
    }

    /// High speed is out of the question.
    pub(crate) fn full_speed_only(&self) -> bool {
        self.config.speed_limit == SpeedLimit::Full
    }
}
