//! Rules of split transactions.

use dwc2_host::Config;
use usb_model::hub::Hub;
use usb_model::shared::Shared;
use usb_model::violation::Rule;
use usb_model::wire::Speed;

use super::{
    assert_broken, channel_register, full_speed_rig, hub_session, offset, on_channels, root_session, starts,
    starts_interrupt,
};
use crate::gadget::Gadget;
use crate::rig::{Rig, both};
use crate::stack::{HubHost, enumerate};

const COMPLETE: u32 = 1 << 16;
const SPLIT: u32 = 1 << 31;

fn rig() -> Rig {
    Rig::new(Config::new())
}

#[test]
fn split_missing() {
    let rig = rig();
    on_channels(&rig, offset::HCSPLT, |_| 0);
    hub_session(&rig);
    assert_broken(&rig, Rule::SplitMissing);
}

#[test]
fn split_on_slow_bus() {
    let rig = full_speed_rig();
    on_channels(&rig, offset::HCSPLT, |_| SPLIT | 3 << 14 | 1 << 7 | 1);
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::SplitOnSlowBus);
}

#[test]
fn split_hub() {
    let rig = rig();
    on_channels(&rig, offset::HCSPLT, |value| if value & SPLIT != 0 { value ^ 3 } else { value });
    hub_session(&rig);
    assert_broken(&rig, Rule::SplitHub);
}

#[test]
fn split_size() {
    let rig = rig();
    rig.tamper_writes(|machine, offset, value| {
        if starts(offset, value) && machine.core.read(offset + offset::HCSPLT) & SPLIT != 0 {
            let size = machine.core.read(offset + offset::HCTSIZ);
            machine.core.write(offset + offset::HCTSIZ, size + 64 + (1 << 19));
        }
        Some(value)
    });
    hub_session(&rig);
    assert_broken(&rig, Rule::SplitSize);
}

#[test]
fn split_position() {
    let rig = rig();
    on_channels(&rig, offset::HCSPLT, |value| value & !(3 << 14));
    hub_session(&rig);
    assert_broken(&rig, Rule::SplitPosition);
}

#[test]
fn start_split_frame() {
    let rig = rig();
    // A driver that has the microframes wrong by two.
    rig.tamper_reads(|_, offset, value| if offset == offset::HFNUM { (value + 2) & 0x3fff } else { value });
    hub_session(&rig);
    assert_broken(&rig, Rule::StartSplitFrame);
}

#[test]
fn complete_split_frame() {
    let rig = rig();
    // A driver that thinks a microframe has passed, once a start split is out.
    rig.tamper_reads(|machine, offset, value| {
        let out = |channel: u32| {
            let base = 0x500 + channel * 0x20;
            let periodic = machine.core.read(base) >> 18 & 3 == 3;
            periodic && machine.core.read(base + offset::HCSPLT) & (SPLIT | COMPLETE) == SPLIT
        };
        if offset == offset::HFNUM && (0..4).any(out) { (value + 1) & 0x3fff } else { value }
    });
    hub_session(&rig);
    assert_broken(&rig, Rule::CompleteSplitFrame);
}

#[test]
fn complete_split_order() {
    let rig = rig();
    let mut held: Option<(u32, u32)> = None;
    // The first of two complete splits is held back and goes out right after the second.
    rig.tamper_writes(move |machine, offset, value| {
        let complete =
            machine.core.read(offset / 0x20 * 0x20 + offset::HCSPLT) & (SPLIT | COMPLETE) == SPLIT | COMPLETE;
        if channel_register(offset).is_none() || !starts_interrupt(offset, value) || !complete {
            return Some(value);
        }
        match held.take() {
            None => {
                held = Some((offset, value));
                None
            }
            Some((first, kept)) => {
                machine.core.write(offset, value);
                machine.core.write(first, kept & !(1 << 29) | value & 1 << 29);
                None
            }
        }
    });
    hub_session(&rig);
    assert_broken(&rig, Rule::CompleteSplitOrder);
}

#[test]
fn complete_without_start() {
    let rig = rig();
    on_channels(&rig, offset::HCSPLT, |value| if value & SPLIT != 0 { value | COMPLETE } else { value });
    hub_session(&rig);
    assert_broken(&rig, Rule::CompleteWithoutStart);
}

#[test]
fn split_restarted() {
    let rig = rig();
    on_channels(&rig, offset::HCSPLT, |value| value & !COMPLETE);
    hub_session(&rig);
    assert_broken(&rig, Rule::SplitRestarted);
}

#[test]
fn split_abandoned() {
    let rig = Rig::new(Config::new().with_halt_limit_us(u32::MAX));
    // Complete splits of control endpoints never leave the driver.
    rig.tamper_writes(|machine, offset, value| {
        let complete = starts(offset, value) && machine.core.read(offset + offset::HCSPLT) & COMPLETE != 0;
        (!complete).then_some(value)
    });
    let hub = Shared::new(Hub::new(Speed::High));
    rig.plug(hub.clone());
    hub.lock().plug(1, Box::new(Gadget::new(Speed::Full)));
    let session = async {
        let mut host = HubHost::on_root(&rig).await.unwrap();
        let speed = host.reset_port(&rig, 1).await.unwrap();
        let route = host.route(1, speed);
        let asking = async {
            for _ in 0..60 {
                host.status(1).await.unwrap();
                rig.sleep(2_000).await;
            }
        };
        both(asking, enumerate(&rig, speed, route, 5)).await
    };
    let _ = rig.run_for(1_000_000, session);
    assert_broken(&rig, Rule::SplitAbandoned);
}
