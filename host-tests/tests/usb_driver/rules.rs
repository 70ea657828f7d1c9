//! Every rule of the model's: a driver that breaks it is noticed.
//!
//! The driver itself is right; between it and the model a thin layer changes, drops or adds register accesses, skips
//! cache maintenance, or speeds the driver's clock up ([`crate::rig`]). The table of rules in `docs/usb-rules.md` names a test of this module for each.

mod channels;
mod hubs;
mod memory;
mod splits;
mod start;
mod transfers;

use dwc2_host::{Config, SpeedLimit};
use embassy_usb_driver::EndpointType;
use embassy_usb_driver::host::pipe::{Bulk, In, Out};
use embassy_usb_driver::host::{PipeError, UsbPipe};
use usb_model::hub::Hub;
use usb_model::shared::Shared;
use usb_model::violation::Rule;
use usb_model::wire;

use crate::gadget::{GIVE, Gadget, KEEP};
use crate::rig::{Rig, both};
use crate::stack::{HubHost, Known, endpoint, enumerate_root, setup};

/// Offsets that many tests name.
mod offset {
    pub const GAHBCFG: u32 = 0x008;
    pub const GUSBCFG: u32 = 0x00c;
    pub const GRSTCTL: u32 = 0x010;
    pub const GINTSTS: u32 = 0x014;
    pub const GRXFSIZ: u32 = 0x024;
    pub const GNPTXFSIZ: u32 = 0x028;
    pub const GHWCFG2: u32 = 0x048;
    pub const HPTXFSIZ: u32 = 0x100;
    pub const HCFG: u32 = 0x400;
    pub const HFIR: u32 = 0x404;
    pub const HFNUM: u32 = 0x408;
    pub const HPRT: u32 = 0x440;
    pub const HCCHAR: u32 = 0x00;
    pub const HCSPLT: u32 = 0x04;
    pub const HCINT: u32 = 0x08;
    pub const HCINTMSK: u32 = 0x0c;
    pub const HCTSIZ: u32 = 0x10;
    pub const HCDMA: u32 = 0x14;
}

/// The register of a channel that an offset names.
fn channel_register(offset: u32) -> Option<u32> {
    (0x500..0x700).contains(&offset).then_some(offset % 0x20)
}

/// A write that starts a channel.
fn starts(offset: u32, value: u32) -> bool {
    channel_register(offset) == Some(offset::HCCHAR) && value >> 30 == 2
}

/// A write that starts a channel for an interrupt endpoint.
fn starts_interrupt(offset: u32, value: u32) -> bool {
    starts(offset, value) && value >> 18 & 3 == 3
}

/// Changes one register of every channel.
fn on_channels(rig: &Rig, register: u32, mut change: impl FnMut(u32) -> u32 + Send + 'static) {
    rig.tamper_writes(move |_, offset, value| {
        Some(if channel_register(offset) == Some(register) { change(value) } else { value })
    });
}

/// Changes one register.
fn on_register(rig: &Rig, register: u32, mut change: impl FnMut(u32) -> u32 + Send + 'static) {
    rig.tamper_writes(move |_, offset, value| Some(if offset == register { change(value) } else { value }));
}

/// What a session may take, broken or not.
const SESSION_US: u64 = 3_000_000;

/// A device on the root port: enumeration, control data both ways, reports, output, bulk.
fn root_session(rig: &Rig, speed: wire::Speed) {
    let mut gadget = Gadget::counting(speed);
    gadget.nyet = speed == wire::Speed::High;
    let bulk = gadget.bulk_bytes() as u16;
    rig.plug(gadget);
    let packet = if speed == wire::Speed::Low { 8 } else { 64 };
    let session = async {
        let known = enumerate_root(rig, 5).await?;
        use_device(&known, packet).await?;
        if speed != wire::Speed::Low {
            let mut out = known.pipe::<Bulk, Out>(&endpoint(3, EndpointType::Bulk, false, bulk, 0));
            let mut back = known.pipe::<Bulk, In>(&endpoint(3, EndpointType::Bulk, true, bulk, 0));
            for _ in 0..3 {
                out.request_out(&[7; 600], false).await?;
                back.request_in(&mut [0; 600]).await?;
            }
        }
        Ok::<(), PipeError>(())
    };
    let _ = rig.run_for(SESSION_US, session);
}

/// Control data both ways, reports, output.
async fn use_device(known: &Known, packet: u16) -> Result<(), PipeError> {
    let mut control = known.control(packet);
    control.control_out(&setup(0x40, KEEP, 0, 0, 70), &[9; 70]).await?;
    control.control_in(&setup(0xc0, GIVE, 0, 0, 70), &mut [0; 70]).await?;
    let (mut reports, mut output) = (known.reports(8, 4), known.output(8, 4));
    for _ in 0..10 {
        reports.request_in(&mut [0; 8]).await?;
        output.request_out(&[3; 5], false).await?;
    }
    Ok(())
}

/// A pad and a keyboard behind a hub, used side by side.
fn hub_session(rig: &Rig) {
    let hub = Shared::new(Hub::new(wire::Speed::High));
    rig.plug(hub.clone());
    hub.lock().plug(1, Box::new(Gadget::counting(wire::Speed::Full)));
    hub.lock().plug(2, Box::new(Gadget::counting(wire::Speed::Low)));
    let session = async {
        let mut host = HubHost::on_root(rig).await?;
        let pad = host.enumerate(rig, 1, 5).await?;
        let keyboard = host.enumerate(rig, 2, 6).await?;
        let asking = async {
            for _ in 0..100 {
                host.status(1).await?;
            }
            Ok::<(), PipeError>(())
        };
        let (asked, (used, typed)) = both(asking, both(use_device(&pad, 64), use_device(&keyboard, 8))).await;
        asked.and(used).and(typed)
    };
    let _ = rig.run_for(SESSION_US, session);
}

/// The rule was broken, whatever else was.
#[track_caller]
fn assert_broken(rig: &Rig, rule: Rule) {
    let rules = rig.take_rules();
    assert!(rules.contains(&rule), "{rule} went unnoticed; noticed: {rules:?}");
}

fn full_speed_rig() -> Rig {
    Rig::new(Config::new().with_speed_limit(SpeedLimit::Full))
}

#[test]
fn a_driver_that_nobody_tampers_with_breaks_none() {
    for speed in [wire::Speed::Low, wire::Speed::Full, wire::Speed::High] {
        root_session(&Rig::new(Config::new()), speed);
    }
    hub_session(&Rig::new(Config::new()));
    hub_session(&full_speed_rig());
}

#[test]
fn every_rule_has_its_test() {
    let sources = [
        include_str!("rules/start.rs"),
        include_str!("rules/memory.rs"),
        include_str!("rules/channels.rs"),
        include_str!("rules/transfers.rs"),
        include_str!("rules/splits.rs"),
        include_str!("rules/hubs.rs"),
    ];
    for rule in Rule::ALL {
        let head = format!("#[test]\nfn {}() {{", rule.test());
        let body = sources.iter().find_map(|source| source.split_once(&head)).map(|(_, body)| body);
        let body = body.and_then(|body| body.split_once("\n}\n")).map(|(body, _)| body);
        let asks = body.is_some_and(|body| body.contains(&format!("assert_broken(&rig, Rule::{rule})")));
        assert!(asks, "{rule} has no test `{}` that asserts it", rule.test());
    }
}
