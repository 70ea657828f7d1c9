//! One running QEMU, with all its connections.
//!
//! | serial port on vexpress-a9 | on raspi2b | what it carries | here |
//! | --- | --- | --- | --- |
//! | UART 0 | mini UART | console: lines of text | [`Qemu::console`] |
//! | UART 1 | UART 0 | link: bytes both ways | [`Qemu::send`], [`Qemu::receive`], [`Qemu::link`] |
//! | UART 2 | none | defmt log | [`Qemu::take_log`], for [`LogDecoder`](crate::log_decoder::LogDecoder) |
//!
//! QEMU starts paused and connects to sockets that this process listens on already, so no byte
//! is lost: the machine runs from [`Qemu::resume`] on. It is killed when the value goes.

mod connect;
mod options;
mod process;
#[cfg(test)]
mod tests;
mod usb_device;

use std::io::{self, ErrorKind, Read, Write};
use std::os::unix::net::UnixStream;
use std::process::ExitStatus;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::anyhow;
use serde_json::json;

pub use options::{Display, QemuOptions};
use process::Process;
pub use usb_device::{UsbDevice, UsbIds};

use crate::console::Console;
use crate::paths::TemporaryFolder;
use crate::picture::{Picture, read_ppm};
use crate::qmp::Qmp;

/// Console lines that an error shows.
const LINES_SHOWN: usize = 15;

/// The `-icount` shift of runs that must repeat exactly: an instruction takes 2^5 = 32 ns of the
/// machine's time, so durations count instructions.
pub const ICOUNT_SHIFT: u8 = 5;

/// A running QEMU.
pub struct Qemu {
    process: Process,
    qmp: Qmp,
    console: Console,
    link: UnixStream,
    log: Option<UnixStream>,
    folder: TemporaryFolder,
}

impl Qemu {
    /// Starts QEMU with the firmware loaded and everything connected; it stays paused.
    ///
    /// # Errors
    ///
    /// When QEMU cannot start, with what it said.
    pub fn start(options: &QemuOptions) -> anyhow::Result<Self> {
        connect::start(options)
    }

    /// Lets the machine run. A log that nobody took is thrown away from here on.
    ///
    /// # Errors
    ///
    /// When QEMU has ended or gives no answer.
    pub fn resume(&mut self) -> anyhow::Result<()> {
        if let Some(mut log) = self.log.take() {
            // Unread bytes would fill the socket, and the firmware would wait for ever.
            thread::spawn(move || io::copy(&mut log, &mut io::sink()));
        }
        self.qmp.cont().map_err(|error| self.explain(error))
    }

    /// Returns the console: every line so far, and a way to wait for one.
    pub fn console(&self) -> &Console {
        &self.console
    }

    /// Waits for a console line that `wanted` accepts, among those printed already too.
    ///
    /// # Errors
    ///
    /// When the time is over or QEMU ended first; the error names `what` and shows the console's end.
    pub fn wait_for_line(
        &mut self,
        what: &str,
        limit: Duration,
        wanted: impl Fn(&str) -> bool,
    ) -> anyhow::Result<String> {
        let line = self.console.wait_for(limit, wanted);
        line.ok_or_else(|| self.explain(not_in_time(what, limit)))
    }

    /// Sends bytes over the link.
    ///
    /// # Errors
    ///
    /// When the firmware does not take them within `limit`.
    pub fn send(&mut self, what: &str, limit: Duration, bytes: &[u8]) -> anyhow::Result<()> {
        self.link.set_write_timeout(Some(limit))?;
        let sent = self.link.write_all(bytes);
        sent.map_err(|error| {
            self.explain(anyhow!("the link does not take {what} within {} s ({error})", limit.as_secs_f64()))
        })
    }

    /// Receives bytes from the link until `buffer` is full.
    ///
    /// # Errors
    ///
    /// When they do not come within `limit`; the error names `what` and shows the console's end.
    pub fn receive(&mut self, what: &str, limit: Duration, buffer: &mut [u8]) -> anyhow::Result<()> {
        let deadline = Instant::now() + limit;
        let wanted = buffer.len();
        let mut filled = 0;
        while filled < wanted {
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                let error = not_in_time(&format!("{what}: {filled} of {wanted} bytes came over the link"), limit);
                return Err(self.explain(error));
            }
            self.link.set_read_timeout(Some(left))?;
            match self.link.read(&mut buffer[filled..]) {
                Ok(0) => return Err(self.explain(anyhow!("the link ended after {filled} of {wanted} bytes of {what}"))),
                Ok(count) => filled += count,
                Err(error)
                    if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted) => {
                }
                Err(error) => return Err(self.explain(error.into())),
            }
        }
        Ok(())
    }

    /// Returns another handle of the link, for a thread of its own.
    ///
    /// # Errors
    ///
    /// When the system gives no handle.
    pub fn link(&self) -> io::Result<UnixStream> {
        self.link.try_clone()
    }

    /// Returns the log's stream, once, on a board that has one; to be taken before [`resume`](Self::resume).
    pub fn take_log(&mut self) -> Option<UnixStream> {
        self.log.take()
    }

    /// Returns what the machine's screen shows.
    ///
    /// # Errors
    ///
    /// When QEMU cannot tell.
    pub fn screen(&mut self) -> anyhow::Result<Picture> {
        let path = self.folder.path().join("screen.ppm");
        self.qmp.screendump(&path).map_err(|error| self.explain(error))?;
        read_ppm(&path)
    }

    /// Plugs a device into the machine's USB bus.
    ///
    /// # Errors
    ///
    /// When QEMU refuses it, with its reason.
    pub fn plug(&mut self, device: &UsbDevice) -> anyhow::Result<()> {
        self.qmp.execute("device_add", device.plug()).map(drop).map_err(|error| self.explain(error))
    }

    /// Pulls a device out that is plugged in.
    ///
    /// # Errors
    ///
    /// When QEMU refuses it, with its reason.
    pub fn unplug(&mut self, device: &UsbDevice) -> anyhow::Result<()> {
        self.qmp.execute("device_del", json!({ "id": device.id() })).map(drop).map_err(|error| self.explain(error))
    }

    /// Returns the remote control: keys, pause, all else.
    pub fn qmp(&mut self) -> &mut Qmp {
        &mut self.qmp
    }

    /// Waits until QEMU ends by itself: the firmware left by semihosting, or a window was closed.
    ///
    /// # Errors
    ///
    /// When the time is over; the error shows the console's end.
    pub fn wait_for_exit(&mut self, limit: Duration) -> anyhow::Result<ExitStatus> {
        match self.process.wait(limit)? {
            Some(status) => {
                self.console.wait_for_end(Duration::from_secs(1));
                Ok(status)
            }
            None => Err(self.explain(not_in_time("the firmware to end", limit))),
        }
    }

    /// Ends QEMU and waits until all that the console and the log still held has been read.
    ///
    /// # Errors
    ///
    /// When QEMU does not end.
    pub fn quit(mut self) -> anyhow::Result<()> {
        // Refused when it has ended already, which is what is wanted.
        let _ = self.qmp.quit();
        self.wait_for_exit(Duration::from_secs(10)).map(drop)
    }

    /// Adds to an error what can explain it: QEMU's end, its messages, the console's last lines.
    pub fn explain(&mut self, error: anyhow::Error) -> anyhow::Error {
        let lines = self.console.last_lines(LINES_SHOWN);
        self.process.explain(anyhow!("{error:#}\n  the console's last lines:\n{lines}"))
    }
}

fn not_in_time(what: &str, limit: Duration) -> anyhow::Error {
    anyhow!("waited {} s in vain for {what}", limit.as_secs_f64())
}
