//! Configuring the FPGA from an image in memory (the order of U-Boot's `socfpga_gen5.c`).

use core::fmt;

use embedded_hal::delay::DelayNs;

use super::status::{Mode, Switch};
use super::{FpgaManager, Offset, PIN_CONF_DONE, PIN_NSTATUS};
use crate::mmio::{Bus, Register, Registers};

/// CTRL: the processor drives the configuration.
const ENABLE: u32 = 1 << 0;
/// CTRL: nCE is 1, the FPGA does not listen.
const CHIP_DISABLE: u32 = 1 << 1;
/// CTRL: pulls nCONFIG to 0, which resets the FPGA.
const PULL_NCONFIG: u32 = 1 << 2;
/// CTRL: CDRATIO's lowest bit.
const CLOCK_RATIO_SHIFT: u32 = 6;
/// CTRL: words go to the FPGA.
const AXI_CONFIGURATION: u32 = 1 << 8;
/// CTRL: 32 bits at a time.
const WIDE: u32 = 1 << 9;

/// Clocks that end the configuration, and clocks in which the design starts.
const CLOCKS_DONE: u32 = 4;
const CLOCKS_START: u32 = 0x5000;

/// Longest time for a mode to come, for CONF_DONE and for clocks to be sent, in microseconds.
/// Each takes well under a millisecond; U-Boot waits as long.
const STEP_LIMIT_US: u32 = 100_000;
/// Time between two looks.
const LOOK_US: u32 = 10;

/// Where the FPGA manager takes the words of an image.
#[derive(Debug, Clone, Copy)]
pub struct ImageSink;

impl Register for ImageSink {
    fn offset(self) -> usize {
        0
    }
}

/// Why the FPGA was not configured. It is left unconfigured and the manager idle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ConfigureError {
    /// The MSEL switch does not let the processor.
    WrongSwitch {
        /// Its position.
        switch: Switch,
    },
    /// The FPGA did not reach a mode.
    ModeStuck {
        /// The mode that it was to reach.
        wanted: Mode,
        /// The mode that it was in instead.
        found: Mode,
    },
    /// The FPGA found a fault in the image (nSTATUS went to 0).
    Refused {
        /// The MSEL switch, which has to fit the image.
        switch: Switch,
    },
    /// The FPGA wants more words than the image has (CONF_DONE stayed 0).
    Incomplete {
        /// Bytes that it got.
        bytes: usize,
    },
    /// The clocks that start the design were not sent.
    ClockStuck,
}

impl fmt::Display for ConfigureError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::WrongSwitch { switch } => {
                write!(out, "{switch} does not let the processor configure the FPGA: set switch SW10 to MSEL 01010")
            }
            Self::ModeStuck { wanted, found } => write!(
                out,
                "FPGA did not go to mode {wanted:?} in {} ms, it is in mode {found:?}: turn the board off and on",
                STEP_LIMIT_US / 1_000
            ),
            Self::Refused { switch } => write!(
                out,
                "FPGA refused the image (nSTATUS is 0): is it whole, for a 5CSEMA5F31, and as {switch} wants it (01010: compressed, 32 bits)?"
            ),
            Self::Incomplete { bytes } => {
                write!(out, "FPGA waits for more than the image's {bytes} bytes (CONF_DONE is 0): was it loaded whole?")
            }
            Self::ClockStuck => write!(
                out,
                "FPGA manager did not send its clocks in {} ms: turn the board off and on",
                STEP_LIMIT_US / 1_000
            ),
        }
    }
}

impl core::error::Error for ConfigureError {}

impl<B: Bus> FpgaManager<B> {
    /// Configures the FPGA with an image (.rbf), whatever it did before.
    ///
    /// The bridges are closed. Takes as long as the words take, plus a few milliseconds.
    ///
    /// # Errors
    /// [`ConfigureError`], and the FPGA has no design.
    pub fn configure(
        &mut self,
        image: &[u32],
        sink: &Registers<ImageSink, B>,
        delay: &mut impl DelayNs,
    ) -> Result<(), ConfigureError> {
        let switch = self.status().switch;
        let scheme = switch.scheme().ok_or(ConfigureError::WrongSwitch { switch })?;
        let width = if scheme.wide { WIDE } else { 0 };
        let done = self.run(width | scheme.clock_ratio << CLOCK_RATIO_SHIFT, (image, sink), switch, delay);
        // Whatever came of it, the pins are the FPGA's own again.
        self.registers.change(Offset::Control, AXI_CONFIGURATION | PULL_NCONFIG | ENABLE, 0);
        done
    }

    fn run(
        &mut self,
        scheme: u32,
        (image, sink): (&[u32], &Registers<ImageSink, B>),
        switch: Switch,
        delay: &mut impl DelayNs,
    ) -> Result<(), ConfigureError> {
        let all = WIDE | AXI_CONFIGURATION | 0b11 << CLOCK_RATIO_SHIFT | PULL_NCONFIG | CHIP_DISABLE | ENABLE;
        self.registers.change(Offset::Control, all, scheme);
        self.registers.change(Offset::Control, 0, ENABLE);
        self.registers.change(Offset::Control, 0, PULL_NCONFIG);
        self.wait_for_mode(Mode::Reset, delay)?;
        self.registers.change(Offset::Control, PULL_NCONFIG, 0);
        self.wait_for_mode(Mode::Configuration, delay)?;
        self.registers.write(Offset::PinsClear, 0xFFF);

        self.registers.change(Offset::Control, 0, AXI_CONFIGURATION);
        for word in image {
            sink.write(ImageSink, *word);
        }
        sink.settle();
        let answered = self.wait(delay, |pins| pins & PIN_CONF_DONE != 0 || pins & PIN_NSTATUS == 0);
        if self.pins() & PIN_NSTATUS == 0 {
            return Err(ConfigureError::Refused { switch });
        }
        if !answered {
            return Err(ConfigureError::Incomplete { bytes: size_of_val(image) });
        }
        self.registers.change(Offset::Control, AXI_CONFIGURATION, 0);

        self.send_clocks(CLOCKS_DONE, delay)?;
        // It may start by itself and be in user mode already.
        if self.status().mode() != Mode::User {
            self.wait_for_mode(Mode::Initialisation, delay)?;
        }
        self.send_clocks(CLOCKS_START, delay)?;
        self.wait_for_mode(Mode::User, delay)
    }

    /// Sends clocks to the FPGA and waits until they are sent.
    fn send_clocks(&mut self, clocks: u32, delay: &mut impl DelayNs) -> Result<(), ConfigureError> {
        self.registers.write(Offset::ClockDone, 1);
        self.registers.write(Offset::ClockCount, clocks);
        let sent = wait(delay, || self.registers.read(Offset::ClockDone) & 1 == 1);
        self.registers.write(Offset::ClockDone, 1);
        if sent { Ok(()) } else { Err(ConfigureError::ClockStuck) }
    }

    /// Waits for a mode, or for user mode, which comes last of all.
    fn wait_for_mode(&self, wanted: Mode, delay: &mut impl DelayNs) -> Result<(), ConfigureError> {
        let reached = || {
            let mode = self.status().mode();
            mode == wanted || wanted == Mode::Initialisation && mode == Mode::User
        };
        if wait(delay, reached) {
            return Ok(());
        }
        Err(ConfigureError::ModeStuck { wanted, found: self.status().mode() })
    }

    fn wait(&self, delay: &mut impl DelayNs, mut condition: impl FnMut(u32) -> bool) -> bool {
        wait(delay, || condition(self.pins()))
    }
}

/// Waits until the condition holds, for at most [`STEP_LIMIT_US`]. Returns whether it does.
fn wait(delay: &mut impl DelayNs, mut condition: impl FnMut() -> bool) -> bool {
    for _ in 0..STEP_LIMIT_US / LOOK_US {
        if condition() {
            return true;
        }
        delay.delay_us(LOOK_US);
    }
    condition()
}

#[cfg(test)]
mod tests;
