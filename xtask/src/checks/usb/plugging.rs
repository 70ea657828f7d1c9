//! Devices that come, go, come again and take each other's place.

use std::thread;
use std::time::Duration;

use anyhow::ensure;
use controls::DualShock3Report;
use usb_model::dualshock3::Temper;

use super::rig::{Rig, Server};
use crate::checks::State;
use crate::fake_pad::FakePad;
use crate::qemu::UsbDevice;

/// Times that a keyboard is pulled out and plugged in again.
const ROUNDS: usize = 3;
/// A keyboard is ready after about so long: 100 ms to settle, 50 ms of reset, requests.
const STARTED_MS: u64 = 280;
/// From one moment at which a keyboard is torn out to the next.
const STARTING_STEP_MS: usize = 20;
/// By then, all is told.
const SETTLED: Duration = Duration::from_millis(1_000);
/// Reports that a pad says each time.
const REPORTS: u32 = 20;

/// Nothing, a keyboard, nothing, a keyboard … on the root port; then a pad in its place, and another
/// one in that one's.
pub fn on_the_root_port(state: &State) -> anyhow::Result<()> {
    let keyboard = UsbDevice::keyboard("1");
    let mut rig = Rig::start(state, "usb-plugging", Vec::new())?;
    let mut typed = 0;
    for round in 1..=ROUNDS {
        rig.plug(&keyboard)?;
        rig.told("usb root: keyboard (", round)?;
        typed += type_a_key(&mut rig, typed)?;
        rig.unplug(&keyboard)?;
        rig.told("usb root: keyboard has gone", round)?;
    }
    rig.quit()?;
    let stages = torn_out_while_it_starts(state)?;

    let (server, pad) = (Server::new()?, FakePad::new(0));
    let mut rig = Rig::start(state, "usb-plugging-pads", vec![server.at("1")])?;
    swap_pads(&mut rig, &server, &pad, "usb root: DualShock 3")?;
    println!("{ROUNDS} keyboards and 4 pads came and went on the root port, {stages} were torn out while they started");
    rig.quit()
}

/// Tears keyboards out while they are being asked who they are, each a bit later than the one before;
/// then one works. Returns how many were torn out.
fn torn_out_while_it_starts(state: &State) -> anyhow::Result<usize> {
    let keyboard = UsbDevice::keyboard("1");
    let mut rig = Rig::start(state, "usb-torn-out", Vec::new())?;
    let moments: Vec<u64> = (0..=STARTED_MS).step_by(STARTING_STEP_MS).collect();
    for milliseconds in &moments {
        rig.plug(&keyboard)?;
        thread::sleep(Duration::from_millis(*milliseconds));
        rig.unplug(&keyboard)?;
        thread::sleep(Duration::from_millis(STARTING_STEP_MS as u64));
    }
    // The last one's news may still be on its way.
    thread::sleep(SETTLED);
    let before = rig.count("usb root: keyboard (");
    ensure!(before < moments.len(), "every keyboard was ready before it was torn out");
    rig.plug(&keyboard)?;
    rig.told("usb root: keyboard (", before + 1)?;
    type_a_key(&mut rig, 0)?;
    rig.quit_whatever_went_wrong()?;
    Ok(moments.len())
}

/// The same behind a hub, the keyboard and the pad at once.
pub fn behind_a_hub(state: &State) -> anyhow::Result<()> {
    let (server, pad) = (Server::new()?, FakePad::new(0));
    let keyboard = UsbDevice::keyboard("1.1");
    let mut rig = Rig::start(state, "usb-plugging-behind-hub", vec![UsbDevice::hub("1"), server.at("1.2")])?;
    rig.told("usb root: hub with 8 ports", 1)?;
    let mut typed = 0;
    for round in 1..=ROUNDS {
        rig.plug(&keyboard)?;
        rig.told("usb 1: keyboard (", round)?;
        typed += type_a_key(&mut rig, typed)?;
        rig.unplug(&keyboard)?;
        rig.told("usb 1: keyboard has gone", round)?;
    }
    rig.plug(&keyboard)?;
    swap_pads(&mut rig, &server, &pad, "usb 2: DualShock 3")?;
    // The keyboard beside the pads has stayed.
    typed += type_a_key(&mut rig, typed)?;
    ensure!(rig.status()?.tally.keyboard.count == typed, "the keyboard's reports are not all there");
    println!("{ROUNDS} keyboards and 4 pads came and went behind a hub");
    rig.quit()
}

/// Types a key; returns how many reports that made.
fn type_a_key(rig: &mut Rig, typed: u32) -> anyhow::Result<u32> {
    for (down, reports) in [(true, 1), (false, 2)] {
        rig.key("c", down)?;
        rig.until("the key's report", |tally| tally.keyboard.count == typed + reports)?;
    }
    Ok(2)
}

/// Plugs a pad in, out, and in again; then others, without a pause, in its place.
fn swap_pads(rig: &mut Rig, server: &Server, pad: &FakePad, name: &str) -> anyhow::Result<()> {
    let (came, went) = (format!("{name} ("), format!("{name} has gone"));
    for (round, pull_out) in [(1, true), (2, false), (3, false), (4, true)] {
        server.socket.plug_in(pad.device(Temper::Sony));
        rig.told(&came, round)?;
        rig.told(&went, round - 1)?;
        for number in 0..REPORTS {
            let mut report = DualShock3Report::default().to_bytes();
            report[48] = number as u8;
            report[7] = round as u8;
            pad.say(report);
        }
        let wanted = pad.said().count + REPORTS;
        let tally = rig.until("the pad's reports", |tally| tally.pad.count >= wanted)?;
        ensure!(tally.pad == pad.said(), "pad {round} said {:?}, the firmware took in {:?}", pad.said(), tally.pad);
        if pull_out {
            server.socket.pull_out();
            rig.told(&went, round)?;
        }
    }
    server.check()
}
