//! A keyboard: the picture that its keys make is the one that the same reports make over the link.

use anyhow::ensure;
use controls::serial::kind;
use firmware::scene::Scene;

use super::rig::Rig;
use crate::checks::State;
use crate::machine::{Link, with_host};
use crate::qemu::UsbDevice;

/// Keys, held one after the other: QEMU's name, the usage (HID Usage Tables, page 0x07), frames.
const KEYS: [(&str, u8, usize); 6] =
    [("d", 0x07, 6), ("e", 0x08, 5), ("spc", 0x2C, 2), ("z", 0x1D, 4), ("r", 0x15, 2), ("w", 0x1A, 5)];

/// One keyboard on the root port, at high speed.
pub fn on_the_root_port(state: &State) -> anyhow::Result<()> {
    let rig = Rig::start(state, "usb-keyboard", vec![UsbDevice::keyboard("1")])?;
    check(rig, "usb root: keyboard (0627:0001 class 0x03, high speed")
}

/// One behind a hub, at full speed.
pub fn behind_a_hub(state: &State) -> anyhow::Result<()> {
    let rig = Rig::start(state, "usb-keyboard-behind-hub", vec![UsbDevice::hub("1"), UsbDevice::keyboard("1.3")])?;
    check(rig, "usb 3: keyboard (0627:0001 class 0x03, full speed")
}

fn check(mut rig: Rig, attached: &str) -> anyhow::Result<()> {
    rig.told(attached, 1)?;
    rig.begin(Scene::Plate)?;
    let mut found = vec![rig.frame()?];
    let mut reports = 0;
    for (name, _, frames) in KEYS {
        for (down, frames) in [(true, frames), (false, 1)] {
            rig.key(name, down)?;
            reports += 1;
            rig.until(&format!("the report of {name}"), |tally| tally.keyboard.count == reports)?;
            for _ in 0..frames {
                found.push(rig.frame()?);
            }
        }
    }
    let tally = rig.status()?.tally;
    let (expected, taken) = expected()?;
    ensure!(found == expected, "the keys made other pictures than their reports make: {found:x?}, {expected:x?}");
    ensure!(tally.keyboard == taken, "other reports were taken in than the keys make: {tally:?}");
    let different = found.windows(2).filter(|pair| pair[0] != pair[1]).count();
    ensure!(different > found.len() / 2, "the keys moved nothing: {found:x?}");
    println!("{} key reports, {} frames", tally.keyboard.count, found.len());
    rig.quit()
}

/// The pictures that the keys make, and the tally, on this computer.
fn expected() -> anyhow::Result<(Vec<u32>, firmware::intake::Reports)> {
    with_host(|machine| {
        let mut link = Link::new(machine);
        link.begin(Scene::Plate.index() as u8)?;
        let frame = |link: &mut Link<'_, _>| {
            link.step()?;
            anyhow::Ok(link.screen()?.0)
        };
        let mut pictures = vec![frame(&mut link)?];
        for (_, usage, frames) in KEYS {
            for (usage, frames) in [(usage, frames), (0, 1)] {
                link.report(kind::KEYBOARD, &[0, 0, usage, 0, 0, 0, 0, 0])?;
                for _ in 0..frames {
                    pictures.push(frame(&mut link)?);
                }
            }
        }
        Ok((pictures, link.status()?.tally.keyboard))
    })
}
