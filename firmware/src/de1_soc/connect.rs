//! Waiting for the FPGA, and for a person.

use core::fmt::Write;

use embedded_hal::digital::{InputPin, OutputPin};
use fpga_regs::RenderError;

use super::arguments::{Asked, Image};
use super::blink::Blink;
use super::fpga_manager::Status;
use super::memory_map::FPGA_IMAGE_SINK;
use super::viewer::ViewerBoard;
use crate::armv7a::sleep::sleep_unless;
use crate::cortex_a9::global_timer::Delay;
use crate::mmio::Registers;

/// Time between two lines about an FPGA that is still not configured, in microseconds.
const REMINDER_US: u64 = 30_000_000;

impl ViewerBoard {
    /// Says what was found at the start.
    pub(super) fn tell_start(&mut self) {
        let _ =
            writeln!(self.console, "\nHalfspace {} on the DE1-SoC, reset: {}", env!("CARGO_PKG_VERSION"), self.cause);
        if let Err(error) = self.start.l2 {
            let _ = writeln!(self.console, "the L2 cache is off, so all goes slowly: {error}");
        }
        if !self.verdict.is_unremarkable() {
            let _ = writeln!(self.console, "{}", self.verdict);
        }
    }

    /// Waits for the HPS key when the last run's end asks for it.
    pub(super) fn hold_if_asked(&mut self) {
        if self.verdict.hold {
            let _ = writeln!(self.console, "waiting: press the HPS key, or configure the FPGA anew, to try again");
            self.wait_for_key_or_new_design(Blink::Held);
        }
    }

    /// Configures the FPGA if U-Boot's `go` named an image.
    pub(super) fn configure_if_asked(&mut self) {
        match &self.asked {
            Ok(Asked { image: Some(image), .. }) => self.configure(*image),
            Ok(_) => {}
            Err(error) => {
                let _ = writeln!(self.console, "{error}");
            }
        }
    }

    fn configure(&mut self, Image { address, bytes }: Image) {
        let _ = writeln!(self.console, "configuring the FPGA with {bytes} bytes at {address:#010x}");
        let words = bytes.div_ceil(4) as usize;
        // SAFETY: `arguments` checked that the image lies aligned in a window which the table maps and nothing
        // else uses.
        let image = unsafe { core::slice::from_raw_parts(core::ptr::with_exposed_provenance(address as usize), words) };
        // SAFETY: the FPGA manager's data register answers there, and only this function writes to it.
        let sink = unsafe { Registers::at(FPGA_IMAGE_SINK) };
        self.fpga.close();
        if let Err(error) = self.fpga.manager.configure(image, &sink, &mut Delay::new(self.clock)) {
            let _ = writeln!(self.console, "{error}");
            self.count_fault();
        }
    }

    /// Returns the mesh file that U-Boot's `go` named.
    pub(super) fn asked_mesh(&self) -> Option<&'static [u8]> {
        // What is wrong with the words was told when the FPGA's image was looked for.
        let Image { address, bytes } = self.asked.as_ref().ok()?.mesh?;
        // SAFETY: `arguments` checked that the file lies in a window which the table maps and nobody writes to.
        Some(unsafe {
            core::slice::from_raw_parts(core::ptr::with_exposed_provenance(address as usize), bytes as usize)
        })
    }

    /// Waits until the FPGA runs, opens the bridges and lets `attempt` find out what is behind them; until
    /// it succeeds.
    pub(super) fn connect<T>(&mut self, mut attempt: impl FnMut() -> Result<T, RenderError>) -> T {
        loop {
            let status = self.wait_until_configured();
            if self.fpga.open().is_err() {
                // It stopped since the look.
                continue;
            }
            match attempt() {
                Ok(found) => {
                    self.fpga.found();
                    let _ = writeln!(self.console, "{status}, bridges open");
                    return found;
                }
                // It stopped since then.
                Err(RenderError::NotConfigured(_)) => self.fpga.close(),
                Err(error) => {
                    self.fpga.close();
                    let _ = writeln!(self.console, "{error}");
                    let _ =
                        writeln!(self.console, "waiting: configure the FPGA anew, or press the HPS key to look again");
                    self.count_fault();
                    self.wait_for_key_or_new_design(Blink::WrongDesign);
                }
            }
        }
    }

    /// Closes the way to an FPGA that has stopped, so that nothing touches it.
    pub(super) fn disconnect(&mut self) {
        self.fpga.close();
        self.panel.forget();
        self.count_fault();
        let _ = writeln!(self.console, "the FPGA's design is gone: bridges closed");
    }

    fn wait_until_configured(&mut self) -> Status {
        let mut told = None;
        let mut due = 0;
        loop {
            let status = self.fpga.status();
            if status.check().is_ok() {
                return status;
            }
            let now = self.clock.microseconds();
            if told != Some(status) || now >= due {
                let _ = writeln!(self.console, "{status}");
                (told, due) = (Some(status), now + REMINDER_US);
            }
            self.blink_a_tick(Blink::NotConfigured);
        }
    }

    /// Waits until the HPS key goes down, or an FPGA that ran stops running or the other way round.
    fn wait_for_key_or_new_design(&mut self, blink: Blink) {
        let ran = self.fpga.status().check().is_ok();
        let mut was_down = true;
        loop {
            let down = self.key.is_low() == Ok(true);
            if down && !was_down || ran != self.fpga.status().check().is_ok() {
                return;
            }
            was_down = down;
            self.blink_a_tick(blink);
        }
    }

    /// Shows a state on the LED and sleeps until the next interrupt, at most a tick.
    fn blink_a_tick(&mut self, blink: Blink) {
        let _ = self.led.set_state(blink.is_lit(self.clock.microseconds() / 1_000).into());
        sleep_unless(|| false);
    }
}
