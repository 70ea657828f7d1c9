//! The core's start, from the soft reset to a port with power, in the order of the hardware facts' §4.3.

use crate::Fault;
use crate::port::Phase;
use crate::registers::{
    Gahbcfg, Ghwcfg2, Ghwcfg3, Gintsts, Gnptxfsiz, Gotgctl, Grstctl, Grxfsiz, Gsnpsid, Gusbcfg, Haintmsk, Hcchar, Hcfg,
    Hcint, Hcintmsk, Hptxfsiz, Pcgctl,
};
use crate::state::{CHANNELS, State};
use crate::timing::{FORCE_HOST_LIMIT_US, FORCE_HOST_US, SELF_CLEARING_LIMIT_US};
use crate::{DMA_BYTES, LINE_BYTES};

/// "OT".
const PRODUCT: u16 = 0x4f54;
/// GHWCFG2's architecture with an internal DMA.
const INTERNAL_DMA: u8 = 2;
/// GAHBCFG: INCR4, as U-Boot has it on this core.
const BURST_INCR4: u8 = 3;
/// GRSTCTL: all transmit FIFOs.
const ALL_FIFOS: u8 = 0x10;
/// GINTSTS: every bit.
const ALL_INTERRUPTS: u32 = u32::MAX;
/// GUSBCFG: as many extra clocks for an answer as there are, as Linux has it.
const LONGEST_TIMEOUT: u8 = 7;

/// Words of the receive FIFO beside one for each channel: two of the largest packets, each with its status word and
/// one for the end of its transfer (Linux, `hcd.c`, for packets of 1,024 bytes).
const RECEIVE_WORDS: u16 = 2 * (1024 / 4 + 1 + 1);
/// Words to send control and bulk packets: two of 512 bytes.
const NON_PERIODIC_WORDS: u16 = 2 * 512 / 4;
/// Words to send interrupt packets: three of 1,024 bytes.
const PERIODIC_WORDS: u16 = 3 * 1024 / 4;

impl State<'_> {
    /// One step of the start; the phase stays when it has to wait.
    pub(crate) fn advance_start(&mut self, now: u64) {
        let soon = now + SELF_CLEARING_LIMIT_US;
        let reset: Grstctl = match self.phase {
            Phase::Off => return,
            Phase::Failed if now < self.phase_end => return,
            Phase::Failed => return self.phase = Phase::Identify,
            Phase::Identify => {
                return match self.identify() {
                    Ok(()) => {
                        self.choose_phy();
                        self.enter(Phase::AwaitIdle, soon);
                    }
                    Err(fault) => self.fail(fault, now),
                };
            }
            _ => self.hardware.read(),
        };
        let is_host = self.phase == Phase::AwaitHost && self.is_host(now);
        let fault = match self.phase {
            Phase::AwaitIdle if reset.idle() => {
                self.hardware.write(Grstctl::default().with_core_soft_reset(true));
                return self.enter(Phase::AwaitReset, soon);
            }
            Phase::AwaitReset if !reset.core_soft_reset() => return self.enter(Phase::AwaitIdleAgain, soon),
            Phase::AwaitReset => Fault::ResetStuck,
            Phase::AwaitIdleAgain if reset.idle() => {
                self.force_host();
                return self.enter(Phase::AwaitHost, now + FORCE_HOST_LIMIT_US);
            }
            Phase::AwaitIdle | Phase::AwaitIdleAgain => Fault::NeverIdle,
            Phase::AwaitHost if is_host => {
                self.configure();
                self.hardware.write(Grstctl::default().with_flush_transmit(true).with_transmit_fifo(ALL_FIFOS));
                return self.enter(Phase::AwaitTransmitFlush, soon);
            }
            Phase::AwaitHost => Fault::NotHost,
            Phase::AwaitTransmitFlush if !reset.flush_transmit() => {
                self.hardware.write(Grstctl::default().with_flush_receive(true));
                return self.enter(Phase::AwaitReceiveFlush, soon);
            }
            Phase::AwaitReceiveFlush if !reset.flush_receive() => {
                self.halt_survivors();
                return self.enter(Phase::AwaitHalts, soon);
            }
            Phase::AwaitTransmitFlush | Phase::AwaitReceiveFlush => Fault::FlushStuck,
            _ => match self.survivor() {
                Some(channel) => Fault::ChannelStuck { channel },
                None => return self.open(),
            },
        };
        if now >= self.phase_end {
            self.fail(fault, now);
        }
    }

    /// The core is a host, and has had the time that it needs after it was forced.
    fn is_host(&mut self, now: u64) -> bool {
        let forced = self.phase_end - FORCE_HOST_LIMIT_US;
        now >= forced + FORCE_HOST_US && self.hardware.read::<Gintsts>().host_mode()
    }

    /// Looks whether this is a core that the driver can drive; writes nothing.
    fn identify(&mut self) -> Result<(), Fault> {
        let id: Gsnpsid = self.hardware.read();
        if id.product() != PRODUCT {
            return Err(Fault::WrongCore { id: id.0 });
        }
        // One that an earlier start left.
        if self.hardware.read::<Grstctl>().core_soft_reset() {
            return Err(Fault::ResetStuck);
        }
        let hardware: Ghwcfg2 = self.hardware.read();
        if hardware.architecture() != INTERNAL_DMA {
            return Err(Fault::NoInternalDma { hardware: hardware.0 });
        }
        self.channel_count = usize::from(hardware.channels()) + 1;
        // The core keeps one word for each channel at the end of the memory.
        let channels = self.channel_count as u16;
        let needed = RECEIVE_WORDS + NON_PERIODIC_WORDS + PERIODIC_WORDS + 2 * channels;
        let present = self.hardware.read::<Ghwcfg3>().fifo_depth();
        if present < needed {
            return Err(Fault::FifoTooSmall { needed, present });
        }
        let (length, address) = self.hardware.memory();
        if length < DMA_BYTES || !(address as usize).is_multiple_of(LINE_BYTES) {
            return Err(Fault::BadDmaMemory { length, address });
        }
        Ok(())
    }

    /// All clocks run, and the PHY is chosen before the soft reset that its choice needs.
    fn choose_phy(&mut self) {
        self.hardware.write(Gahbcfg::default());
        self.hardware.write(Pcgctl::default());
        self.set_phy();
    }

    fn set_phy(&mut self) {
        let external_vbus = self.config.external_vbus;
        self.hardware.modify(|phy: Gusbcfg| {
            phy.with_ddr(false)
                .with_ulpi_serial(false)
                .with_ulpi_clock_in_suspend(false)
                .with_external_vbus(external_vbus)
                .with_session_request(false)
                .with_host_negotiation(false)
                .with_timeout_calibration(LONGEST_TIMEOUT)
        });
    }

    /// A host whatever the ID pin says; a reset may have undone the rest.
    fn force_host(&mut self) {
        self.set_phy();
        self.hardware.modify(|role: Gusbcfg| role.with_force_device(false).with_force_host(true));
    }

    fn configure(&mut self) {
        let full_speed_only = self.full_speed_only();
        let receive = RECEIVE_WORDS + self.channel_count as u16;
        let core = &mut self.hardware;
        core.write(Gahbcfg::default().with_burst(BURST_INCR4).with_dma(true));
        core.modify(|host: Hcfg| {
            host.with_clock_select(0).with_full_speed_only(full_speed_only).with_descriptor_dma(false)
        });
        core.write(Grxfsiz::default().with_depth(receive));
        core.write(Gnptxfsiz::default().with_start(receive).with_depth(NON_PERIODIC_WORDS));
        core.write(Hptxfsiz::default().with_start(receive + NON_PERIODIC_WORDS).with_depth(PERIODIC_WORDS));
        core.modify(|otg: Gotgctl| otg.with_host_negotiation(false));
    }

    /// Halts channels that the soft reset left running (as QEMU's does).
    fn halt_survivors(&mut self) {
        for channel in 0..self.channel_count as u8 {
            let running: Hcchar = self.hardware.read_channel(channel);
            if running.enable() {
                self.hardware.write_channel(channel, running.with_disable(true));
            }
        }
    }

    fn survivor(&mut self) -> Option<u8> {
        (0..self.channel_count as u8).find(|channel| self.hardware.read_channel::<Hcchar>(*channel).enable())
    }

    /// Power, and interrupts last.
    fn open(&mut self) {
        for channel in 0..self.channel_count as u8 {
            self.hardware.write_channel(channel, Hcint(ALL_INTERRUPTS));
            self.hardware.write_channel(channel, Hcintmsk::default().with_halted(true).with_bus_error(true));
        }
        let all = (u32::MAX >> (32 - CHANNELS.min(self.channel_count))) as u16;
        self.hardware.write(Haintmsk::default().with_channels(all));
        self.hardware.write(Gintsts(ALL_INTERRUPTS));
        self.hardware.modify_port(|port| port.with_power(true));
        self.set_interrupts(false);
        self.hardware.modify(|master: Gahbcfg| master.with_global_interrupt(true));
        self.phase = Phase::Empty;
    }
}
