//! Rules of channels.

use embassy_usb_driver::EndpointType;
use embassy_usb_driver::host::UsbPipe;
use embassy_usb_driver::host::pipe::{Bulk, In};
use usb_model::violation::Rule;
use usb_model::wire::Speed;

use super::{
    assert_broken, channel_register, full_speed_rig, offset, on_channels, root_session, starts, starts_interrupt,
};
use crate::gadget::Gadget;
use crate::stack::{endpoint, enumerate_root};

#[test]
fn channel_busy() {
    let rig = full_speed_rig();
    rig.tamper_writes(|machine, offset, value| {
        if starts(offset, value) {
            machine.core.write(offset, value);
            machine.core.write(offset + offset::HCTSIZ, 0);
            return None;
        }
        Some(value)
    });
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::ChannelBusy);
}

#[test]
fn not_acknowledged() {
    let rig = full_speed_rig();
    rig.tamper_writes(|_, offset, value| (channel_register(offset) != Some(offset::HCINT)).then_some(value));
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::NotAcknowledged);
}

#[test]
fn halt_incomplete() {
    let rig = full_speed_rig();
    on_channels(&rig, offset::HCCHAR, |value| if value & 1 << 30 != 0 { value & !(1 << 31) } else { value });
    rig.plug(Gadget::new(Speed::Full));
    let mut bulk = rig.run(async {
        let known = enumerate_root(&rig, 5).await.unwrap();
        known.pipe::<Bulk, In>(&endpoint(3, EndpointType::Bulk, true, 64, 0))
    });
    // The endpoint has nothing; dropping the request tells its channel to halt.
    assert!(rig.run_for(5_000, bulk.request_in(&mut [0; 64])).is_none());
    assert_broken(&rig, Rule::HaltIncomplete);
}

#[test]
fn periodic_halted() {
    let rig = full_speed_rig();
    rig.tamper_writes(|machine, offset, value| {
        if starts_interrupt(offset, value) {
            machine.core.write(offset, value);
            machine.core.write(offset, value | 1 << 30);
            return None;
        }
        Some(value)
    });
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::PeriodicHalted);
}
