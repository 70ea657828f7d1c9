//! Starts QEMU and connects it: this process listens, QEMU calls.

use std::collections::HashMap;
use std::fs::File;
use std::io::{ErrorKind, Write};
use std::os::unix::net::{UnixListener, UnixStream};
use std::process::Command;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, ensure};

use super::Qemu;
use super::options::{CONTROL, QemuOptions, Wiring};
use super::process::{POLL, Process};
use crate::console::Console;
use crate::paths::TemporaryFolder;
use crate::qmp::Qmp;

/// Longest time until QEMU has connected everything; 0.1 s is usual.
const CONNECT_LIMIT: Duration = Duration::from_secs(30);

pub(super) fn start(options: &QemuOptions) -> anyhow::Result<Qemu> {
    ensure!(options.elf.is_file(), "there is no firmware in {}: build it first", options.elf.display());
    let folder = TemporaryFolder::new().context("cannot make a temporary folder")?;
    let mut listeners = Vec::new();
    for name in Wiring::of(options.board).sockets() {
        let path = folder.path().join(name);
        let listener = UnixListener::bind(&path).with_context(|| format!("cannot listen on {}", path.display()))?;
        listener.set_nonblocking(true)?;
        listeners.push((name, listener));
    }
    let mut command = Command::new(&options.program);
    // Sound would make QEMU complain on machines without.
    command.args(options.arguments(folder.path())).env("QEMU_AUDIO_DRV", "none");
    let mut process = Process::start(&mut command)?;
    match connect(options, &listeners, &mut process) {
        Ok(Connections { qmp, console, link, log }) => Ok(Qemu { process, qmp, console, link, log, folder }),
        Err(error) => Err(process.explain(error)),
    }
}

struct Connections {
    qmp: Qmp,
    console: Console,
    link: UnixStream,
    log: Option<UnixStream>,
}

fn connect(
    options: &QemuOptions,
    listeners: &[(&str, UnixListener)],
    process: &mut Process,
) -> anyhow::Result<Connections> {
    let deadline = Instant::now() + CONNECT_LIMIT;
    let mut streams = HashMap::new();
    for (name, listener) in listeners {
        streams.insert(*name, accept(name, listener, process, deadline)?);
    }
    let mut stream = |name| streams.remove(name).with_context(|| format!("the board has no {name}"));
    let (control, console, link) = (stream(CONTROL)?, stream("console")?, stream("link")?);
    let log = stream("log").ok();
    let mut copies: Vec<Box<dyn Write + Send>> = Vec::new();
    if let Some(path) = &options.console_file {
        let file = File::create(path).with_context(|| format!("cannot write the console to {}", path.display()))?;
        copies.push(Box::new(file));
    }
    if options.console_on_stdout {
        copies.push(Box::new(std::io::stdout()));
    }
    Ok(Connections { qmp: Qmp::connect(control)?, console: Console::start(console, copies)?, link, log })
}

/// Waits until QEMU calls on `listener`, as long as it runs.
fn accept(name: &str, listener: &UnixListener, process: &mut Process, deadline: Instant) -> anyhow::Result<UnixStream> {
    loop {
        match listener.accept() {
            Ok((stream, _)) => {
                stream.set_nonblocking(false)?;
                return Ok(stream);
            }
            Err(error) if error.kind() == ErrorKind::WouldBlock => {}
            Err(error) => return Err(error).with_context(|| format!("cannot accept QEMU's {name}")),
        }
        ensure!(process.wait(Duration::ZERO)?.is_none(), "QEMU ended before its {name} was connected");
        ensure!(Instant::now() < deadline, "QEMU did not connect its {name} within {} s", CONNECT_LIMIT.as_secs());
        thread::sleep(POLL);
    }
}
