//! What a QEMU is started with.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use firmware::{raspi2b, vexpress_a9};

use super::usb_device::UsbDevice;
use crate::cli::Board;

/// Where the machine's screen is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Display {
    /// Nowhere; [`screen`](super::Qemu::screen) still reads it.
    None,
    /// A GTK window.
    Gtk,
    /// An SDL window.
    Sdl,
    /// A window on macOS.
    Cocoa,
}

impl Display {
    /// Returns QEMU's name for it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Gtk => "gtk",
            Self::Sdl => "sdl",
            Self::Cocoa => "cocoa",
        }
    }
}

/// How to start QEMU.
#[derive(Clone, Debug)]
pub struct QemuOptions {
    /// QEMU itself, from [`ensure_qemu`](crate::setup::ensure_qemu).
    pub program: PathBuf,
    /// The firmware.
    pub elf: PathBuf,
    /// The board that it is for.
    pub board: Board,
    /// A mesh file that lies in memory from the start.
    pub mesh: Option<PathBuf>,
    /// What is plugged in from the start.
    pub usb: Vec<UsbDevice>,
    /// Where the screen is shown.
    pub display: Display,
    /// Makes an instruction take 2^shift ns of the machine's time, and so every run the same;
    /// without it the machine's time is the wall clock's.
    pub icount_shift: Option<u8>,
    /// With `icount_shift`: what the machine sleeps passes at once, so that its time has nothing to do
    /// with the wall clock.
    pub skips_sleep: bool,
    /// Lets the firmware end QEMU with a status, and print, by semihosting.
    pub semihosting: bool,
    /// File that gets the console's lines as well.
    pub console_file: Option<PathBuf>,
    /// Shows the console's lines on standard output as well.
    pub console_on_stdout: bool,
}

impl QemuOptions {
    /// Returns the options of a headless run on the wall clock, with semihosting.
    pub fn new(program: impl Into<PathBuf>, board: Board, elf: impl Into<PathBuf>) -> Self {
        Self {
            program: program.into(),
            elf: elf.into(),
            board,
            mesh: None,
            usb: Vec::new(),
            display: Display::None,
            icount_shift: None,
            skips_sleep: false,
            semihosting: true,
            console_file: None,
            console_on_stdout: false,
        }
    }

    /// Returns QEMU's arguments, with its sockets in `folder` under the names of [`Wiring::sockets`].
    pub(super) fn arguments(&self, folder: &Path) -> Vec<OsString> {
        let mut words: Vec<OsString> = Vec::new();
        let mut push = |text: &str| words.push(text.into());
        // -S: paused until everything is connected. -no-reboot: a reset of the firmware ends QEMU.
        for text in ["-nodefaults", "-no-user-config", "-no-reboot", "-S", "-machine", self.board.name()] {
            push(text);
        }
        let wiring = Wiring::of(self.board);
        if let Some(mebibytes) = wiring.memory_mebibytes {
            push("-m");
            push(&format!("{mebibytes}M"));
        }
        push("-display");
        push(self.display.name());
        for name in wiring.sockets() {
            push("-chardev");
            push(&format!("socket,id={name},server=off,path={}", comma_doubled(&folder.join(name))));
        }
        push("-mon");
        push("chardev=control,mode=control");
        for name in wiring.serial_ports {
            push("-serial");
            push(&format!("chardev:{name}"));
        }
        if let Some(mesh) = &self.mesh {
            push("-device");
            push(&format!("loader,file={},addr={:#x},force-raw=on", comma_doubled(mesh), wiring.mesh_address));
        }
        for device in &self.usb {
            device.arguments().iter().for_each(|word| push(word));
        }
        if let Some(shift) = self.icount_shift {
            push("-icount");
            push(&format!("shift={shift}{}", if self.skips_sleep { ",sleep=off" } else { "" }));
        }
        if self.semihosting {
            push("-semihosting-config");
            push("enable=on,target=native");
        }
        push("-kernel");
        words.push(self.elf.clone().into());
        words
    }
}

/// The name of the socket of QEMU's remote control.
pub(super) const CONTROL: &str = "control";

/// What of a machine is not the same on every board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Wiring {
    /// RAM in MiB where it can be chosen.
    memory_mebibytes: Option<u32>,
    /// What each serial port carries, the machine's first one first: `console`, `link`, `log`.
    pub(super) serial_ports: &'static [&'static str],
    /// Where the firmware looks for a mesh file.
    mesh_address: usize,
}

impl Wiring {
    pub(super) const fn of(board: Board) -> Self {
        match board {
            Board::VexpressA9 | Board::De1Soc => Self {
                memory_mebibytes: Some(256),
                serial_ports: &["console", "link", "log"],
                mesh_address: vexpress_a9::memory_map::MESH_FILE.start,
            },
            // The machine has 1 GiB, and no third port.
            Board::Raspi2b => Self {
                memory_mebibytes: None,
                serial_ports: &["link", "console"],
                mesh_address: raspi2b::memory_map::MESH_FILE.start,
            },
        }
    }

    /// The sockets between QEMU and this process, in the order in which QEMU calls on them.
    pub(super) fn sockets(self) -> impl Iterator<Item = &'static str> {
        std::iter::once(CONTROL).chain(self.serial_ports.iter().copied())
    }
}

/// Returns a path as QEMU's options want it: a comma parts them, two are one.
pub(super) fn comma_doubled(path: &Path) -> String {
    path.to_string_lossy().replace(',', ",,")
}

#[cfg(test)]
mod tests {
    use super::super::UsbIds;
    use super::*;

    #[test]
    fn arguments_follow_the_options() {
        let mut options = QemuOptions::new("qemu", Board::VexpressA9, "a b.elf");
        options.icount_shift = Some(5);
        options.display = Display::Gtk;
        let words = options.arguments(Path::new("/t,1"));
        let line = words.iter().map(|word| word.to_string_lossy()).collect::<Vec<_>>().join(" ");
        assert!(line.contains("-display gtk ") && line.contains("-icount shift=5 "), "{line}");
        assert!(line.contains("-chardev socket,id=log,server=off,path=/t,,1/log "), "{line}");
        assert!(line.contains("-semihosting-config enable=on") && line.ends_with("-kernel a b.elf"), "{line}");
        options.mesh = Some("/m,1.mesh".into());
        let words = options.arguments(Path::new("/t"));
        assert!(words.iter().any(|word| word == "loader,file=/m,,1.mesh,addr=0x69000000,force-raw=on"), "{words:?}");
        options.semihosting = false;
        options.icount_shift = None;
        let line = format!("{:?}", options.arguments(Path::new("/t")));
        assert!(!line.contains("semihosting") && !line.contains("icount"), "{line}");
    }

    #[test]
    fn each_board_has_its_ports() {
        let line = |board| {
            let mut options = QemuOptions::new("qemu", board, "x.elf");
            options.usb = vec![UsbDevice::hub("1"), UsbDevice::keyboard("1.1"), UsbDevice::served("/t/pad", "1.2")];
            let ids = UsbIds { vendor: 0x054C, product: 0x0268 };
            options.usb.push(UsbDevice::of_this_computer(ids, "1.3"));
            let words = options.arguments(Path::new("/t"));
            words.iter().map(|word| word.to_string_lossy().into_owned()).collect::<Vec<_>>().join(" ")
        };
        let vexpress = line(Board::VexpressA9);
        assert!(vexpress.contains("-machine vexpress-a9 -m 256M "), "{vexpress}");
        assert!(vexpress.contains("-serial chardev:console -serial chardev:link -serial chardev:log "), "{vexpress}");
        let raspi = line(Board::Raspi2b);
        assert!(raspi.contains("-machine raspi2b -display "), "{raspi}");
        assert!(
            raspi.contains("-serial chardev:link -serial chardev:console -device usb-hub,id=usb1,port=1 "),
            "{raspi}"
        );
        assert!(!raspi.contains("id=log"), "{raspi}");
        assert!(raspi.contains("-device usb-kbd,id=usb1.1,port=1.1 "), "{raspi}");
        let served = "-chardev socket,id=server-usb1.2,path=/t/pad,reconnect=1 \
                      -device usb-redir,id=usb1.2,port=1.2,chardev=server-usb1.2 ";
        assert!(raspi.contains(served), "{raspi}");
        assert!(raspi.contains("-device usb-host,id=usb1.3,port=1.3,vendorid=0x054c,productid=0x0268 "), "{raspi}");
    }
}
