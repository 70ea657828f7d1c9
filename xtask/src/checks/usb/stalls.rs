//! What holds a bus up: requests that a device refuses, and a keyboard that is torn out. Neither may
//! hold a frame up.

use std::thread;
use std::time::Duration;

use anyhow::ensure;
use controls::DualShock3Report;
use firmware::scene::Scene;
use usb_model::dualshock3::Temper;

use super::rig::{Rig, Server};
use crate::checks::State;
use crate::fake_pad::FakePad;
use crate::qemu::UsbDevice;

/// Reports of a pad that refused something.
const REPORTS: u32 = 50;
/// How long frames are counted.
const MEASURED: Duration = Duration::from_secs(3);
/// Times that the keyboard is torn out in that time.
const TORN_OUT: usize = 5;
/// The `-icount` shift of the frame rate's runs: an instruction takes a nanosecond, so that a frame
/// of the plate is drawn in time, and a busy computer makes no frame late.
const ICOUNT_SHIFT: u8 = 0;
/// What the display shows.
const FRAMES_PER_SECOND: f64 = 60.0;
/// How far the rate may be off: a frame in the time measured.
const TOLERANCE: f64 = 0.5;

/// A pad that refuses half of its wake-up wakes by the other half.
pub fn stalled_requests(state: &State) -> anyhow::Result<()> {
    for (temper, name) in [(Temper::RefusesReading, "reading"), (Temper::RefusesWriting, "writing")] {
        let (server, pad) = (Server::new()?, FakePad::new(0));
        server.socket.plug_in(pad.device(temper));
        let usb = vec![UsbDevice::hub("1"), server.at("1.2")];
        let mut rig = Rig::start(state, &format!("usb-stall-{name}"), usb)?;
        rig.told("usb 2: DualShock 3 (", 1)?;
        for number in 0..REPORTS {
            let mut report = DualShock3Report::default().to_bytes();
            report[48] = number as u8;
            pad.say(report);
        }
        let tally = rig.until("the pad's reports", |tally| tally.pad.count >= REPORTS)?;
        ensure!(tally.pad == pad.said(), "the pad said {:?}, the firmware took in {:?}", pad.said(), tally.pad);
        println!("a pad that refuses {name} its feature reports: {REPORTS} reports");
        server.check()?;
        rig.quit()?;
    }
    Ok(())
}

/// Frames come as fast with a keyboard that is torn out again and again as with none.
pub fn frame_rate(state: &State) -> anyhow::Result<()> {
    let (rate, slowest) = measured(state, "nothing plugged in", |_| Ok(()))?;
    let near = |found: f64| (found - rate).abs() <= TOLERANCE;
    ensure!((rate - FRAMES_PER_SECOND).abs() <= TOLERANCE, "{rate:.2} frames a second with nothing plugged in");
    let typing = |rig: &mut Rig| {
        rig.plug(&UsbDevice::keyboard("1"))?;
        rig.told("usb root: keyboard (", 1)?;
        for _ in 0..TORN_OUT {
            type_keys(rig)?;
        }
        Ok(())
    };
    let (typed, slowest_typed) = measured(state, "a keyboard in use", typing)?;
    let tearing = |rig: &mut Rig| {
        for round in 1..=TORN_OUT {
            rig.plug(&UsbDevice::keyboard("1"))?;
            rig.told("usb root: keyboard (", round)?;
            type_keys(rig)?;
            rig.key("d", true)?;
            rig.unplug(&UsbDevice::keyboard("1"))?;
        }
        rig.told("usb root: keyboard has gone", TORN_OUT)
    };
    let (torn, slowest_torn) = measured(state, "a keyboard torn out five times", tearing)?;
    ensure!(near(typed) && near(torn), "USB changes the frame rate: {rate:.2}, {typed:.2}, {torn:.2}");
    // A frame begins at a millisecond's tick: two may be a tick nearer or farther than others.
    let longest = slowest + 1_500;
    ensure!(
        slowest_typed <= longest && slowest_torn <= longest,
        "USB holds a frame up: {slowest}, {slowest_typed}, {slowest_torn} µs"
    );
    Ok(())
}

/// Counts frames of the plate while something happens on the bus: frames a second of the machine's
/// time, and the longest time from one to the next in microseconds.
fn measured(
    state: &State,
    what: &str,
    happening: impl FnOnce(&mut Rig) -> anyhow::Result<()>,
) -> anyhow::Result<(f64, u32)> {
    let name = what.replace(' ', "-");
    let mut rig = Rig::start_with(state, &format!("usb-rate-{name}"), |options| {
        options.icount_shift = Some(ICOUNT_SHIFT);
        options.skips_sleep = true;
    })?;
    rig.begin(Scene::Plate)?;
    rig.run_freely()?;
    thread::sleep(Duration::from_millis(500));
    let before = rig.status()?;
    happening(&mut rig)?;
    thread::sleep(MEASURED);
    let after = rig.status()?;
    let seconds = (after.ticks - before.ticks) as f64 / 1e6;
    let rate = f64::from(after.frames - before.frames) / seconds;
    let slowest = after.slowest_frame_ticks;
    println!("{what}: {rate:.2} frames a second over {seconds:.1} s, the slowest took {slowest} µs");
    rig.quit()?;
    Ok((rate, slowest))
}

fn type_keys(rig: &mut Rig) -> anyhow::Result<()> {
    for name in ["a", "s", "d"] {
        for down in [true, false] {
            rig.key(name, down)?;
            thread::sleep(Duration::from_millis(10));
        }
    }
    Ok(())
}
