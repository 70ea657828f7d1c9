//! Devices on the root port.

use dwc2_host::{Config, SpeedLimit};
use embassy_usb_driver::Speed;
use embassy_usb_driver::host::UsbPipe;
use usb_model::shared::Shared;
use usb_model::wire;

use crate::gadget::{GIVE, Gadget, KEEP};
use crate::rig::Rig;
use crate::stack::{connected, enumerate_root, setup};

#[test]
fn a_device_of_every_speed_is_found() {
    for (device, limit, expected) in [
        (wire::Speed::Low, SpeedLimit::High, Speed::Low),
        (wire::Speed::Full, SpeedLimit::High, Speed::Full),
        (wire::Speed::High, SpeedLimit::High, Speed::High),
        (wire::Speed::High, SpeedLimit::Full, Speed::Full),
    ] {
        let rig = Rig::new(Config::new().with_speed_limit(limit));
        rig.plug(Gadget::new(device));
        assert_eq!(rig.run(connected(&rig)), expected);
    }
}

#[test]
fn control_data_of_every_length_comes_back() {
    for speed in [wire::Speed::Low, wire::Speed::Full, wire::Speed::High] {
        let rig = Rig::new(Config::new());
        rig.plug(Gadget::new(speed));
        let packet = if speed == wire::Speed::Low { 8 } else { 64 };
        rig.run(async {
            let known = enumerate_root(&rig, 5).await.unwrap();
            let mut control = known.control(packet);
            for length in [0_u16, 1, 7, 8, 9, 63, 64, 65, 127, 128, 511, 512, 513, 1024, 1500] {
                let sent: Vec<u8> = (0..length).map(|at| (at * 7 + length) as u8).collect();
                control.control_out(&setup(0x40, KEEP, 0, 0, length), &sent).await.unwrap();
                let mut got = vec![0; usize::from(length)];
                let count = control.control_in(&setup(0xc0, GIVE, 0, 0, length), &mut got).await.unwrap();
                let expected = if length == 0 { 0 } else { usize::from(length) };
                assert_eq!((count, &got), (expected, &sent), "{speed:?}, {length} bytes");
            }
        });
    }
}

#[test]
fn reports_arrive_in_order_once_each() {
    for speed in [wire::Speed::Low, wire::Speed::Full, wire::Speed::High] {
        let rig = Rig::new(Config::new());
        let device = Shared::new(Gadget::counting(speed));
        rig.plug(device.clone());
        rig.run(async {
            let known = enumerate_root(&rig, 5).await.unwrap();
            let mut reports = known.reports(8, 1);
            for expected in 0..300_u32 {
                let mut bytes = [0; 8];
                assert_eq!(reports.request_in(&mut bytes).await, Ok(4));
                assert_eq!(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]), expected, "{speed:?}");
            }
        });
    }
}
