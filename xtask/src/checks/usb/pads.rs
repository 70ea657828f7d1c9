//! A DualShock 3 behind a hub, with a keyboard beside it.

use anyhow::{Context, ensure};
use controls::DualShock3Report;
use firmware::intake::Reports;
use firmware::scene::Scene;
use usb_model::dualshock3::Temper;

use super::rig::{Rig, Server};
use crate::checks::State;
use crate::fake_pad::FakePad;
use crate::golden::{self, Golden};
use crate::qemu::UsbDevice;
use crate::report::checksum_text;
use crate::session;

/// Reports of the long run.
const REPORTS: u16 = 1_200;
/// Least time from one to the next.
const REPORT_INTERVAL_US: u64 = 4_000;
/// After so many reports a key goes down or up.
const REPORTS_A_KEY: u16 = 10;

/// The demonstration's plate, played on the pad: every frame equals the golden one. The pad's tilt is
/// smoothed report by report, so one that is lost or doubled changes the picture.
pub fn session_beside_a_keyboard(state: &State) -> anyhow::Result<()> {
    let golden = Golden::read(golden::DEMO)?.context("the golden file is missing")?;
    let parts = session::demo()?;
    let (part, golden) = (&parts[0], &golden.scenes[0]);
    ensure!(part.scene == Scene::Plate && golden.name == "plate", "the session begins with the plate");
    let (server, pad) = (Server::new()?, FakePad::new(0));
    server.socket.plug_in(pad.device(Temper::Sony));
    let usb = vec![UsbDevice::hub("1"), UsbDevice::keyboard("1.1"), server.at("1.2")];
    let mut rig = Rig::start(state, "usb-pad-session", usb)?;
    rig.told("usb 1: keyboard", 1)?;
    rig.told("usb 2: DualShock 3", 1)?;
    rig.begin(Scene::Plate)?;
    let mut said = 0;
    for (index, (frame, expected)) in part.frames.iter().zip(&golden.frame_checksums).enumerate() {
        if let Some(report) = frame {
            pad.say(*report);
            said += 1;
            rig.until("the pad's report", |tally| tally.pad.count == said)?;
        }
        let found = checksum_text(rig.frame()?);
        ensure!(found == *expected, "frame {index} of the plate by USB is {found}, by the serial line {expected}");
    }
    // The keyboard beside it works as well.
    rig.key("ret", true)?;
    rig.until("the Enter key", |tally| tally.keyboard.count == 1)?;
    rig.frame()?;
    rig.told("scene: torus", 1)?;
    ensure!(pad.outputs().iter().any(|report| report.get(9) == Some(&0x02)), "lamp 1 is not lit: {:?}", pad.outputs());
    println!("{said} pad reports, {} golden frames", part.frames.len());
    server.check()?;
    rig.quit()
}

/// 1,200 reports of a pad and 240 of a keyboard while frames are drawn: none is lost, none doubled.
pub fn long_run(state: &State) -> anyhow::Result<()> {
    let (server, pad) = (Server::new()?, FakePad::new(REPORT_INTERVAL_US));
    server.socket.plug_in(pad.device(Temper::Sony));
    let usb = vec![UsbDevice::hub("1"), UsbDevice::keyboard("1.1"), server.at("1.2")];
    let mut rig = Rig::start(state, "usb-long-run", usb)?;
    rig.told("usb 1: keyboard", 1)?;
    rig.told("usb 2: DualShock 3", 1)?;
    let mut keys = Reports::default();
    for number in 0..REPORTS {
        pad.say(numbered(number));
    }
    for (index, after) in (0..REPORTS).step_by(REPORTS_A_KEY.into()).enumerate() {
        let wanted = u32::from(after);
        rig.until("the pad's next reports", |tally| tally.pad.count >= wanted)?;
        // D goes down, then A; next time D goes up, then A.
        let down = index.is_multiple_of(2);
        for (name, held) in
            [("d", if down { [0x07, 0] } else { [0x04, 0] }), ("a", if down { [0x07, 0x04] } else { [0, 0] })]
        {
            rig.key(name, down)?;
            keys.add(&[0, 0, held[0], held[1], 0, 0, 0, 0]);
        }
    }
    let (said, typed) = (u32::from(REPORTS), keys.count);
    let tally = rig.until("every report", |tally| tally.pad.count >= said && tally.keyboard.count >= typed)?;
    ensure!(tally.pad == pad.said(), "the pad said {:?}, the firmware took in {:?}", pad.said(), tally.pad);
    ensure!(tally.keyboard == keys, "the keys made {keys:?}, the firmware took in {:?}", tally.keyboard);
    ensure!(tally.unreadable == 0 && tally.disconnected == 0, "not all could be read: {tally:?}");
    println!("{} pad and {} key reports, none lost, none doubled", tally.pad.count, tally.keyboard.count);
    server.check()?;
    rig.quit()
}

/// A report that carries a number, where a real pad has its yaw gyroscope, and moves with it.
fn numbered(number: u16) -> [u8; DualShock3Report::LENGTH] {
    let mut report = DualShock3Report::default().to_bytes();
    report[6] = number as u8;
    report[47..49].copy_from_slice(&number.to_be_bytes());
    report
}
