//! A running raspi2b, and what a person would do at it.

use std::path::PathBuf;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::ensure;
use firmware::intake::Tally;
use firmware::link::Status;
use firmware::scene::Scene;
use usb_redir::Socket;

use crate::checks::State;
use crate::cli::Board;
use crate::machine::{Emulated, Link};
use crate::paths::TemporaryFolder;
use crate::qemu::{QemuOptions, UsbDevice};

/// Longest time until something that must happen; a loaded machine is slow.
const PATIENCE: Duration = Duration::from_secs(60);
/// How often the firmware is asked.
const PAUSE: Duration = Duration::from_millis(5);
/// What lines of the console about something that went wrong on the bus have in them.
const WENT_WRONG: [&str; 5] = ["trying again", "given up", "DWC2", "dropped", "could not be read"];

/// A running raspi2b.
pub struct Rig {
    machine: Emulated,
}

impl Rig {
    /// Starts the firmware with `usb` plugged in; what it says goes to a folder of that name.
    pub fn start(state: &State, name: &str, usb: Vec<UsbDevice>) -> anyhow::Result<Self> {
        Self::start_with(state, name, |options| options.usb = usb)
    }

    /// Starts the firmware with any options.
    pub fn start_with(state: &State, name: &str, change: impl FnOnce(&mut QemuOptions)) -> anyhow::Result<Self> {
        let machine = state.bootable(Board::Raspi2b)?.start_with(&state.folder(name), change)?;
        Ok(Self { machine })
    }

    /// Plugs a device in.
    pub fn plug(&mut self, device: &UsbDevice) -> anyhow::Result<()> {
        self.machine.qemu().plug(device)
    }

    /// Pulls a device out.
    pub fn unplug(&mut self, device: &UsbDevice) -> anyhow::Result<()> {
        self.machine.qemu().unplug(device)
    }

    /// Presses or releases a key, by QEMU's name for it.
    pub fn key(&mut self, name: &str, down: bool) -> anyhow::Result<()> {
        self.machine.qemu().qmp().keys(&[(name, down)])
    }

    /// Waits until the console has told `text` in `count` lines.
    pub fn told(&mut self, text: &str, count: usize) -> anyhow::Result<()> {
        let limit = Instant::now() + PATIENCE;
        loop {
            let found = self.count(text);
            ensure!(found <= count, "the console told `{text}` {found} times, not {count}");
            if found == count {
                return Ok(());
            }
            if Instant::now() > limit {
                let error = anyhow::anyhow!("the console told `{text}` {found} times within {PATIENCE:?}, not {count}");
                return Err(self.machine.qemu().explain(error));
            }
            thread::sleep(PAUSE);
        }
    }

    /// Returns how many lines of the console have `text` in them.
    pub fn count(&mut self, text: &str) -> usize {
        self.machine.qemu().console().lines().iter().filter(|line| line.contains(text)).count()
    }

    /// Starts a scene afresh, frame by frame.
    pub fn begin(&mut self, scene: Scene) -> anyhow::Result<()> {
        self.link().begin(scene.index() as u8)
    }

    /// Lets frames come by themselves.
    pub fn run_freely(&mut self) -> anyhow::Result<()> {
        self.link().run_freely()
    }

    /// Draws a frame and returns the checksum of what the screen shows.
    pub fn frame(&mut self) -> anyhow::Result<u32> {
        let mut link = self.link();
        let report = link.step()?;
        let (screen, _) = link.screen()?;
        ensure!(report.checksum == Some(screen), "the screen shows something else than was drawn");
        Ok(screen)
    }

    /// Asks the firmware how it goes.
    pub fn status(&mut self) -> anyhow::Result<Status> {
        self.link().status()
    }

    /// Waits until the tally is as wanted, and returns it.
    pub fn until(&mut self, what: &str, wanted: impl Fn(&Tally) -> bool) -> anyhow::Result<Tally> {
        let limit = Instant::now() + PATIENCE;
        loop {
            let tally = self.status()?.tally;
            if wanted(&tally) {
                return Ok(tally);
            }
            if Instant::now() > limit {
                let error = anyhow::anyhow!("waited {PATIENCE:?} in vain for {what}; taken in: {tally:?}");
                return Err(self.machine.qemu().explain(error));
            }
            thread::sleep(PAUSE);
        }
    }

    /// Ends the machine.
    pub fn quit_whatever_went_wrong(self) -> anyhow::Result<()> {
        self.machine.quit()
    }

    /// Ends the machine. Nothing may have gone wrong on the bus: nobody had to be tried again, and the
    /// controller had no fault.
    pub fn quit(mut self) -> anyhow::Result<()> {
        let complaints: Vec<String> = self
            .machine
            .qemu()
            .console()
            .lines()
            .into_iter()
            .filter(|line| WENT_WRONG.iter().any(|text| line.starts_with("usb") && line.contains(text)))
            .collect();
        ensure!(complaints.is_empty(), "something went wrong on the bus: {complaints:#?}");
        self.machine.quit()
    }

    fn link(&mut self) -> Link<'_, Emulated> {
        Link::new(&mut self.machine)
    }
}

/// A socket for a pad in a folder of its own.
pub struct Server {
    /// Where devices are plugged in and out.
    pub socket: Socket,
    path: PathBuf,
    _folder: TemporaryFolder,
}

impl Server {
    /// Listens, with nothing plugged in.
    pub fn new() -> anyhow::Result<Self> {
        let folder = TemporaryFolder::new()?;
        let path = folder.path().join("pad");
        Ok(Self { socket: Socket::bind(&path)?, path, _folder: folder })
    }

    /// Returns what QEMU is to have at a port.
    pub fn at(&self, port: &str) -> UsbDevice {
        UsbDevice::served(&self.path, port)
    }

    /// Fails when something went wrong with a device.
    pub fn check(&self) -> anyhow::Result<()> {
        let complaints = self.socket.complaints();
        ensure!(complaints.is_empty(), "the usbredir server complains: {complaints:#?}");
        Ok(())
    }
}
