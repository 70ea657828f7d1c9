//! Rules of DMA and caches.

use dwc2_host::Config;
use embassy_usb_driver::EndpointType;
use embassy_usb_driver::host::UsbPipe;
use embassy_usb_driver::host::pipe::{Bulk, In};
use usb_model::violation::Rule;
use usb_model::wire::Speed;

use super::{assert_broken, full_speed_rig, hub_session, offset, on_channels, on_register, root_session};
use crate::gadget::{GIVE, Gadget};
use crate::rig::{Rig, Skip, both};
use crate::stack::{endpoint, enumerate_root, setup};

#[test]
fn dma_off() {
    let rig = full_speed_rig();
    on_register(&rig, offset::GAHBCFG, |value| value & !(1 << 5));
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::DmaOff);
}

#[test]
fn dma_unaligned() {
    let rig = full_speed_rig();
    on_channels(&rig, offset::HCDMA, |value| value + 2);
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::DmaUnaligned);
}

#[test]
fn dma_outside() {
    let rig = full_speed_rig();
    on_channels(&rig, offset::HCDMA, |value| value + 0x1000_0000);
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::DmaOutside);
}

#[test]
fn buffer_shared() {
    let rig = full_speed_rig();
    rig.plug(Gadget::new(Speed::Full));
    let session = async {
        let known = enumerate_root(&rig, 5).await.unwrap();
        let mut bulk = known.pipe::<Bulk, In>(&endpoint(3, EndpointType::Bulk, true, 64, 0));
        let mut control = known.control(64);
        // Every pipe has the first one's buffer.
        on_channels(&rig, offset::HCDMA, |value| value & !0x3fff | 64);
        let mut answer = [0; 64];
        both(bulk.request_in(&mut [0; 64]), control.control_in(&setup(0xc0, GIVE, 0, 0, 64), &mut answer)).await.1
    };
    // The bulk endpoint has nothing: its channel runs while the control transfer's do.
    assert!(rig.run_for(300_000, session).is_none());
    assert_broken(&rig, Rule::BufferShared);
}

#[test]
fn buffer_touched() {
    let rig = Rig::new(Config::new());
    rig.tamper_writes(|machine, _, value| {
        let mut first = [0; 1];
        for pipe in 0..16 {
            machine.memory.cpu_read(pipe * 576 + 64, &mut first);
        }
        Some(value)
    });
    hub_session(&rig);
    assert_broken(&rig, Rule::BufferTouched);
}

#[test]
fn not_cleaned() {
    let rig = full_speed_rig();
    rig.machine().tamper.skip_clean = true;
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::NotCleaned);
}

#[test]
fn dirty_under_write() {
    let rig = full_speed_rig();
    rig.machine().tamper.skip_invalidate = Skip::All;
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::DirtyUnderWrite);
}

#[test]
fn not_invalidated() {
    let rig = full_speed_rig();
    rig.machine().tamper.skip_invalidate = Skip::After;
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::NotInvalidated);
}
