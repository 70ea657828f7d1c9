//! Rules of what a channel is told to move.

use dwc2_host::Config;
use usb_model::violation::Rule;
use usb_model::wire::Speed;

use super::{assert_broken, channel_register, full_speed_rig, offset, on_channels, root_session, starts_interrupt};
use crate::rig::Rig;

/// HCTSIZ with other bytes.
fn with_bytes(size: u32, bytes: u32) -> u32 {
    size & !0x7_ffff | bytes
}

#[test]
fn packet_count() {
    let rig = full_speed_rig();
    on_channels(&rig, offset::HCTSIZ, |size| size + (1 << 19));
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::PacketCount);
}

#[test]
fn input_multiple() {
    let rig = full_speed_rig();
    on_channels(&rig, offset::HCTSIZ, |size| if size & 0x7_ffff == 64 { with_bytes(size, 63) } else { size });
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::InputMultiple);
}

#[test]
fn packet_size() {
    let rig = full_speed_rig();
    on_channels(&rig, offset::HCCHAR, |value| value & !0x7ff | 48);
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::PacketSize);
}

#[test]
fn setup_shape() {
    let rig = full_speed_rig();
    on_channels(&rig, offset::HCTSIZ, |size| if size >> 29 & 3 == 3 { with_bytes(size, 7) } else { size });
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::SetupShape);
}

#[test]
fn control_stage() {
    let rig = full_speed_rig();
    let mut empty = false;
    // The status stage after data from the device goes the same way as the data.
    rig.tamper_writes(move |_, offset, value| {
        let register = channel_register(offset);
        if register == Some(offset::HCTSIZ) {
            empty = value & 0x7_ffff == 0;
        }
        Some(if register == Some(offset::HCCHAR) && empty { value | 1 << 15 } else { value })
    });
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::ControlStage);
}

#[test]
fn toggle() {
    // Of control data, of the status stage, of an interrupt endpoint: whichever comes first.
    let rig = full_speed_rig();
    on_channels(&rig, offset::HCTSIZ, |size| if size >> 29 & 3 == 2 { size & !(3 << 29) } else { size });
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::Toggle);
    // Of interrupt endpoints alone.
    let rig = full_speed_rig();
    rig.tamper_writes(|machine, offset, value| {
        if starts_interrupt(offset, value) {
            let size = machine.core.read(offset + offset::HCTSIZ);
            machine.core.write(offset + offset::HCTSIZ, size & !(3 << 29));
        }
        Some(value)
    });
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::Toggle);
}

#[test]
fn low_speed_bit() {
    let rig = full_speed_rig();
    on_channels(&rig, offset::HCCHAR, |value| value & !(1 << 17));
    root_session(&rig, Speed::Low);
    assert_broken(&rig, Rule::LowSpeedBit);
}

#[test]
fn periodic_count() {
    let rig = full_speed_rig();
    on_channels(&rig, offset::HCCHAR, |value| value & !(3 << 20));
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::PeriodicCount);
}

#[test]
fn odd_frame() {
    let rig = full_speed_rig();
    on_channels(&rig, offset::HCCHAR, |value| if value >> 18 & 3 == 3 { value ^ 1 << 29 } else { value });
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::OddFrame);
}

#[test]
fn ping() {
    let rig = Rig::new(Config::new());
    on_channels(&rig, offset::HCTSIZ, |size| size & !(1 << 31));
    root_session(&rig, Speed::High);
    assert_broken(&rig, Rule::Ping);
}
