//! `cargo xtask pad`: a session as a DualShock 3 at a socket.

use std::thread;
use std::time::Duration;

use anyhow::Context;
use controls::DualShock3Report;
use usb_model::dualshock3::Temper;
use usb_redir::Socket;

use crate::cli::PadArguments;
use crate::fake_pad::FakePad;
use crate::session;

/// A frame's time, which a session's lines stand for.
const FRAME: Duration = Duration::from_micros(16_667);

/// Plays until it is interrupted.
///
/// # Errors
///
/// When the session cannot be read, or nobody can listen at the socket.
pub fn run(arguments: &PadArguments) -> anyhow::Result<()> {
    let parts = match &arguments.session {
        Some(path) => session::read(path)?,
        None => session::demo()?,
    };
    let pad = FakePad::new(0);
    let socket = Socket::bind(&arguments.socket).with_context(|| {
        format!("cannot listen at {}: name a file that is not there yet", arguments.socket.display())
    })?;
    socket.plug_in(pad.device(Temper::Sony));
    println!("a DualShock 3 waits at {}; in another terminal:", arguments.socket.display());
    println!("  cargo xtask run --board raspi2b --pad {}", arguments.socket.display());
    println!("Ctrl-C ends it");
    let mut report = DualShock3Report::default().to_bytes();
    let mut awake = false;
    loop {
        for frame in parts.iter().flat_map(|part| &part.frames) {
            report = frame.unwrap_or(report);
            // Nobody hears a pad that sleeps.
            if pad.is_awake() && pad.waiting() == 0 {
                pad.say(report);
            }
            if awake != pad.is_awake() {
                awake = !awake;
                println!("{}", if awake { "the pad is in use" } else { "the pad is no longer in use" });
            }
            for complaint in socket.complaints() {
                eprintln!("{complaint}");
            }
            thread::sleep(FRAME);
        }
    }
}
