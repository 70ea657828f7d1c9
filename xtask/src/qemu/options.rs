//! What a QEMU is started with.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

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
    /// RAM in MiB, at most 1,024.
    pub memory_mebibytes: u32,
    /// Where the screen is shown.
    pub display: Display,
    /// Makes an instruction take 2^shift ns of the machine's time, and so every run the same;
    /// without it the machine's time is the wall clock's.
    pub icount_shift: Option<u8>,
    /// Lets the firmware end QEMU with a status, and print, by semihosting.
    pub semihosting: bool,
    /// File that gets the console's lines as well.
    pub console_file: Option<PathBuf>,
    /// Shows the console's lines on standard output as well.
    pub console_on_stdout: bool,
}

impl QemuOptions {
    /// Returns the options of a headless run on the wall clock, with semihosting.
    pub fn new(program: impl Into<PathBuf>, elf: impl Into<PathBuf>) -> Self {
        Self {
            program: program.into(),
            elf: elf.into(),
            memory_mebibytes: 256,
            display: Display::None,
            icount_shift: None,
            semihosting: true,
            console_file: None,
            console_on_stdout: false,
        }
    }

    /// Returns QEMU's arguments, with its sockets in `folder` under the names of [`SOCKETS`].
    pub(super) fn arguments(&self, folder: &Path) -> Vec<OsString> {
        let mut words: Vec<OsString> = Vec::new();
        let mut push = |text: &str| words.push(text.into());
        // -S: paused until everything is connected. -no-reboot: a reset of the firmware ends QEMU.
        for text in ["-nodefaults", "-no-user-config", "-no-reboot", "-S", "-machine", "vexpress-a9"] {
            push(text);
        }
        push("-m");
        push(&format!("{}M", self.memory_mebibytes));
        push("-display");
        push(self.display.name());
        for name in SOCKETS {
            push("-chardev");
            push(&format!("socket,id={name},server=off,path={}", comma_doubled(&folder.join(name))));
        }
        for text in [
            "-mon",
            "chardev=control,mode=control",
            "-serial",
            "chardev:console",
            "-serial",
            "chardev:link",
            "-serial",
            "chardev:log",
        ] {
            push(text);
        }
        if let Some(shift) = self.icount_shift {
            push("-icount");
            push(&format!("shift={shift}"));
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

/// The sockets between QEMU and this process: its remote control, then UART 0 to 2.
pub(super) const SOCKETS: [&str; 4] = ["control", "console", "link", "log"];

/// Returns a path as QEMU's options want it: a comma parts them, two are one.
fn comma_doubled(path: &Path) -> String {
    path.to_string_lossy().replace(',', ",,")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_follow_the_options() {
        let mut options = QemuOptions::new("qemu", "a b.elf");
        options.icount_shift = Some(5);
        options.display = Display::Gtk;
        let words = options.arguments(Path::new("/t,1"));
        let line = words.iter().map(|word| word.to_string_lossy()).collect::<Vec<_>>().join(" ");
        assert!(line.contains("-display gtk ") && line.contains("-icount shift=5 "), "{line}");
        assert!(line.contains("-chardev socket,id=log,server=off,path=/t,,1/log "), "{line}");
        assert!(line.contains("-semihosting-config enable=on") && line.ends_with("-kernel a b.elf"), "{line}");
        options.semihosting = false;
        options.icount_shift = None;
        let line = format!("{:?}", options.arguments(Path::new("/t")));
        assert!(!line.contains("semihosting") && !line.contains("icount"), "{line}");
    }
}
