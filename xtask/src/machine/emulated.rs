//! The firmware in QEMU as a machine.

use std::process::ExitStatus;
use std::time::Duration;

use super::Machine;
use crate::log_decoder::LogDecoder;
use crate::picture::Picture;
use crate::qemu::Qemu;
use crate::software_fpga::buffer_of_screen;

/// How long a frame may take, or an answer; a loaded machine is slow.
const PATIENCE: Duration = Duration::from_secs(60);

/// A firmware that runs in QEMU.
pub struct Emulated {
    qemu: Qemu,
    log: Option<LogDecoder>,
}

impl Emulated {
    /// Waits until the firmware in a QEMU that is running has started.
    ///
    /// # Errors
    /// When the firmware does not greet in time, with what its console says.
    pub fn new(mut qemu: Qemu, log: Option<LogDecoder>) -> anyhow::Result<Self> {
        qemu.wait_for_line("the firmware to start", PATIENCE, |line| line.starts_with("Halfspace "))?;
        Ok(Self { qemu, log })
    }

    /// Returns QEMU.
    pub fn qemu(&mut self) -> &mut Qemu {
        &mut self.qemu
    }

    /// Waits until the machine ends by itself and its log is written, and returns how it ended.
    ///
    /// # Errors
    /// When it does not end in time.
    pub fn wait_for_exit(mut self, patience: Duration) -> anyhow::Result<ExitStatus> {
        let status = self.qemu.wait_for_exit(patience)?;
        drop(self.qemu);
        self.log.map(LogDecoder::finish);
        Ok(status)
    }

    /// Ends the machine and waits until its log is written.
    ///
    /// # Errors
    /// When QEMU does not end.
    pub fn quit(self) -> anyhow::Result<()> {
        self.qemu.quit()?;
        self.log.map(LogDecoder::finish);
        Ok(())
    }
}

impl Machine for Emulated {
    fn send(&mut self, bytes: &[u8]) -> anyhow::Result<()> {
        self.qemu.send("a message", PATIENCE, bytes)
    }

    fn receive(&mut self, what: &str) -> anyhow::Result<u8> {
        let mut byte = [0];
        self.qemu.receive(what, PATIENCE, &mut byte)?;
        Ok(byte[0])
    }

    fn screen(&mut self) -> anyhow::Result<(u32, Picture)> {
        let picture = self.qemu.screen()?;
        Ok((raster_model::picture_checksum(&buffer_of_screen(&picture)?), picture))
    }

    fn end(self: Box<Self>) -> anyhow::Result<()> {
        self.quit()
    }
}
