//! The board as the application wants it.

use core::fmt::Write as _;

use controls::{PanelReport, Report};
use embedded_hal::digital::{InputPin, OutputPin};
use embedded_io::{Read, ReadReady, Write as _};

use super::arguments::{ArgumentError, Asked};
use super::board::Board as Drivers;
use super::bridge_port::BridgePort;
use super::fpga::Fpga;
use super::front_panel::FrontPanel;
use super::gpio::{Input, Output};
use super::history::Verdict;
use super::interrupts::{fpga_calls, unexpected_interrupts, with_usb};
use super::memory_map::{CLUSTER, FPGA_INTERRUPT};
use super::readout::{Readout, decimal};
use super::reset_cause::ResetCause;
use super::uart16550::Uart16550;
use crate::armv7a::sleep::sleep_unless;
use crate::board::Board;
use crate::cortex_a9::global_timer::GlobalTimer;
use crate::cortex_a9::start;
use crate::intake::Intake;
use crate::serial::{Console, Link};
use crate::usb::{Service, Taken, take_in};
use usb_input::Merge;

/// Frames after which a run is a good one, and failures before it count no more: ten seconds.
const GOOD_RUN_FRAMES: u32 = 600;

/// The board.
pub(super) struct ViewerBoard {
    pub(super) console: Console<Uart16550>,
    link: Link<Uart16550>,
    pub(super) clock: GlobalTimer,
    pub(super) led: Output,
    pub(super) key: Input,
    pub(super) fpga: Fpga,
    pub(super) panel: FrontPanel,
    pub(super) start: start::Report,
    pub(super) cause: ResetCause,
    pub(super) verdict: Verdict,
    pub(super) asked: Result<Asked, ArgumentError>,
    merge: Merge,
    readout: Readout,
    /// The score, while the game is played.
    score: Option<u32>,
    /// What the panel was when the application was told last.
    told: Option<PanelReport>,
    frames: u32,
    /// The FPGA's interrupts at the end of the last second, and whether it was told that none came.
    calls: u32,
    deaf_told: bool,
    /// Interrupts that nobody asked for, told so far.
    unexpected: u32,
}

impl ViewerBoard {
    pub(super) fn new(drivers: Drivers) -> Self {
        let Drivers { console, link, clock, led, key, fpga, panel, start, cause, verdict, asked } = drivers;
        let readout = Readout::new(clock.microseconds());
        let (score, told, frames, calls, deaf_told, unexpected) = (None, None, 0, 0, false, 0);
        Self {
            console,
            link,
            clock,
            led,
            key,
            fpga,
            panel,
            start,
            cause,
            verdict,
            asked,
            merge: Merge::default(),
            readout,
            score,
            told,
            frames,
            calls,
            deaf_told,
            unexpected,
        }
    }

    pub(super) fn count_fault(&mut self) {
        self.readout.fault(self.clock.microseconds());
    }

    /// What the FPGA's and the processor's keys and switches are.
    fn panel_report(&mut self) -> PanelReport {
        // The design may have gone since the round began: it stays as it was then.
        if self.fpga.is_usable() {
            self.panel.sample();
        }
        let bit = |is: bool, number: u32| u16::from(is) << number;
        let keys = (0..4).fold(0, |keys, number| keys | bit(self.panel.key(number).is_high() == Ok(true), number));
        let own = bit(self.key.is_low() == Ok(true), 4);
        let switches = (0..10).fold(0, |up, number| up | bit(self.panel.switch(number).is_high() == Ok(true), number));
        PanelReport { keys: (keys | own) as u8, switches }
    }

    /// Shows frame rate and faults on the FPGA's LEDs and displays.
    fn show_readout(&self, now: u64) {
        let lit = self.readout.leds(now);
        for number in 0..10 {
            let _ = self.panel.led(number).set_state((lit >> number & 1 == 1).into());
        }
        self.panel.set_digits(self.score.map_or_else(|| self.readout.digits(), decimal));
        if self.fpga.is_usable() {
            self.panel.show();
        }
    }

    /// Tells once a second of interrupts that nobody asked for, and once at all when the FPGA's does not come:
    /// waits then end by the tick, and all goes on slower.
    fn check_interrupts(&mut self) {
        let unexpected = unexpected_interrupts();
        if unexpected != self.unexpected {
            self.unexpected = unexpected;
            self.count_fault();
            let _ = writeln!(self.console, "{unexpected} interrupts came that nobody asked for; they are kept back");
        }
        let calls = fpga_calls();
        if calls == self.calls && !self.deaf_told {
            self.deaf_told = true;
            self.count_fault();
            let _ = writeln!(
                self.console,
                "interrupt {} of the FPGA does not come: frames wait for the millisecond tick; reload the FPGA image",
                FPGA_INTERRUPT.0
            );
        }
        self.calls = calls;
    }
}

impl Board for ViewerBoard {
    const NAME: &'static str = "de1-soc";
    const LACKS: &'static str = "controls on USB, KEY and SW, the serial line";
    const TICKS_PER_SECOND: u32 = CLUSTER.timer_hertz;
    type Console = Console<Uart16550>;
    type Port = BridgePort;

    fn ticks(&self) -> u64 {
        self.clock.ticks()
    }

    fn console(&mut self) -> &mut Self::Console {
        &mut self.console
    }

    fn poll_controllers(&mut self, intake: &mut Intake) -> u32 {
        let next = || with_usb(Service::next_news).flatten();
        let Taken { mut unreadable, faults } = take_in(next, &mut self.merge, intake, &mut self.console);
        (0..faults).for_each(|_| self.count_fault());
        let report = self.panel_report();
        if self.told.replace(report) != Some(report) {
            unreadable += u32::from(intake.accept(Report::Panel(&report.to_bytes())).is_err());
        }
        let frozen = intake.state().frozen;
        with_usb(|usb| usb.set_frozen(frozen));
        unreadable
    }

    fn read_link(&mut self, buffer: &mut [u8]) -> usize {
        self.link.read(buffer).unwrap_or(0)
    }

    fn write_link(&mut self, bytes: &[u8]) {
        // A line that is stuck has nobody to be told over.
        let _ = self.link.write_all(bytes);
    }

    fn picture_checksum(&mut self, _: &mut BridgePort) -> Option<u32> {
        None
    }

    fn mesh_file(&mut self) -> Option<&'static [u8]> {
        self.asked_mesh()
    }

    /// A frame's fence waits for the vertical blank already.
    fn pace(&mut self) {}

    fn heartbeat(&mut self, _: u32) {
        let now = self.clock.microseconds();
        self.frames = self.frames.wrapping_add(1);
        let _ = self.led.set_state((self.frames & 32 != 0).into());
        if self.frames == 1 {
            let _ = writeln!(self.console, "first frame after {} ms", now / 1_000);
        }
        if self.frames == GOOD_RUN_FRAMES {
            self.fpga.forgive();
        }
        if self.readout.frame(now) {
            self.check_interrupts();
        }
        self.show_readout(now);
    }

    fn show_score(&mut self, score: Option<u32>) {
        self.score = score;
    }

    fn show_fault(&mut self) {
        self.count_fault();
    }

    fn sleep(&mut self) {
        sleep_unless(|| self.link.read_ready().unwrap_or(false));
    }
}
