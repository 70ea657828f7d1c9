//! Devices behind hubs: split transactions, and preambles.

use dwc2_host::{Config, SpeedLimit};
use embassy_usb_driver::Speed;
use embassy_usb_driver::host::UsbPipe;
use usb_model::hub::Hub;
use usb_model::shared::Shared;
use usb_model::wire;

use crate::gadget::{GIVE, Gadget, KEEP};
use crate::rig::{Rig, both};
use crate::stack::{HubHost, Known, setup};

fn rig_with_hub(limit: SpeedLimit) -> (Rig, Shared<Hub>) {
    let rig = Rig::new(Config::new().with_speed_limit(limit));
    let hub = Shared::new(Hub::new(wire::Speed::High));
    rig.plug(hub.clone());
    (rig, hub)
}

fn first_packet(speed: wire::Speed) -> u16 {
    if speed == wire::Speed::Low { 8 } else { 64 }
}

/// The next `count` reports of a counting gadget, whole and in order.
async fn expect_reports(known: &Known, bytes: u16, interval: u8, count: u32) {
    let mut reports = known.reports(bytes, interval);
    let mut first = None;
    for step in 0..count {
        let mut report = [0; 64];
        assert_eq!(reports.request_in(&mut report).await, Ok(4));
        let number = u32::from_le_bytes([report[0], report[1], report[2], report[3]]);
        assert_eq!(number, *first.get_or_insert(number) + step);
    }
    assert_eq!(first, Some(0));
}

#[test]
fn control_data_of_every_length_comes_back_through_a_hub() {
    for limit in [SpeedLimit::High, SpeedLimit::Full] {
        for speed in [wire::Speed::Low, wire::Speed::Full, wire::Speed::High] {
            let (rig, hub) = rig_with_hub(limit);
            hub.lock().plug(2, Box::new(Gadget::new(speed)));
            rig.run(async {
                let mut host = HubHost::on_root(&rig).await.unwrap();
                let known = host.enumerate(&rig, 2, 5).await.unwrap();
                let mut control = known.control(first_packet(speed));
                for length in [0_u16, 1, 8, 9, 64, 65, 200, 513] {
                    let sent: Vec<u8> = (0..length).map(|at| (at * 7 + length) as u8).collect();
                    control.control_out(&setup(0x40, KEEP, 0, 0, length), &sent).await.unwrap();
                    let mut got = vec![0; usize::from(length)];
                    let count = control.control_in(&setup(0xc0, GIVE, 0, 0, length), &mut got).await.unwrap();
                    assert_eq!((count, &got), (usize::from(length), &sent), "{limit:?} {speed:?} {length}");
                }
            });
        }
    }
}

#[test]
fn a_thousand_reports_arrive_in_order_through_a_hub() {
    for limit in [SpeedLimit::High, SpeedLimit::Full] {
        for speed in [wire::Speed::Low, wire::Speed::Full, wire::Speed::High] {
            let (rig, hub) = rig_with_hub(limit);
            hub.lock().plug(1, Box::new(Gadget::counting(speed)));
            rig.run_for(30_000_000, async {
                let mut host = HubHost::on_root(&rig).await.unwrap();
                let known = host.enumerate(&rig, 1, 5).await.unwrap();
                expect_reports(&known, 8, if speed == wire::Speed::Low { 10 } else { 1 }, 1000).await;
            })
            .expect("reports that come at all");
        }
    }
}

#[test]
fn pad_and_keyboard_report_side_by_side_while_the_hub_is_asked() {
    for limit in [SpeedLimit::High, SpeedLimit::Full] {
        let (rig, hub) = rig_with_hub(limit);
        hub.lock().plug(1, Box::new(Gadget::counting(wire::Speed::Full)));
        hub.lock().plug(3, Box::new(Gadget::counting(wire::Speed::Low)));
        rig.run_for(30_000_000, async {
            let mut host = HubHost::on_root(&rig).await.unwrap();
            let pad = host.enumerate(&rig, 1, 5).await.unwrap();
            let keyboard = host.enumerate(&rig, 3, 6).await.unwrap();
            let asking = async {
                for _ in 0..200 {
                    assert_eq!(host.status(1).await.unwrap().0 & 3, 3);
                }
            };
            let reading = both(expect_reports(&pad, 64, 1, 400), expect_reports(&keyboard, 8, 8, 50));
            both(asking, reading).await;
        })
        .expect("reports from both");
    }
}

/// Their splits meet in the same microframes, and some complete splits have to go out twice.
#[test]
fn four_devices_share_a_translator() {
    use wire::Speed::{Full, Low};
    for speeds in [[Low, Low, Full, Full], [Full, Low, Full, Low], [Low, Full, Full, Full]] {
        let (rig, hub) = rig_with_hub(SpeedLimit::High);
        rig.run_for(30_000_000, async {
            let mut host = HubHost::on_root(&rig).await.unwrap();
            let mut known = Vec::new();
            for (port, speed) in (1..).zip(speeds) {
                hub.lock().plug(port.into(), Box::new(Gadget::counting(speed)));
                known.push(host.enumerate(&rig, port, 4 + port as u8).await.unwrap());
            }
            let reports = |at: usize| expect_reports(&known[at], first_packet(speeds[at]), 8, 200);
            // The slow bus is busy with this now and then when an interrupt endpoint has its turn.
            let asking = async {
                for _ in 0..300 {
                    let mut control = known[0].control(first_packet(speeds[0]));
                    control.control_out(&setup(0x40, KEEP, 0, 0, 64), &[5; 64]).await.unwrap();
                }
            };
            both(both(asking, reports(1)), both(reports(2), reports(3))).await;
        })
        .expect("reports from all");
    }
}

#[test]
fn output_reports_reach_their_device() {
    for limit in [SpeedLimit::High, SpeedLimit::Full] {
        let (rig, hub) = rig_with_hub(limit);
        let gadget = Shared::new(Gadget::new(wire::Speed::Full));
        hub.lock().plug(4, Box::new(gadget.clone()));
        rig.run(async {
            let mut host = HubHost::on_root(&rig).await.unwrap();
            let known = host.enumerate(&rig, 4, 5).await.unwrap();
            let mut output = known.output(64, 2);
            for number in 0..20_u8 {
                output.request_out(&[number; 49], false).await.unwrap();
            }
        });
        let expected: Vec<Vec<u8>> = (0..20).map(|number| vec![number; 49]).collect();
        assert_eq!(gadget.lock().received, expected);
    }
}

#[test]
fn a_hub_at_full_speed_reaches_low_speed_by_preamble_and_at_high_speed_by_splits() {
    for (limit, speed) in [(SpeedLimit::High, Speed::High), (SpeedLimit::Full, Speed::Full)] {
        let (rig, hub) = rig_with_hub(limit);
        hub.lock().plug(1, Box::new(Gadget::new(wire::Speed::Low)));
        rig.run(async {
            let mut host = HubHost::on_root(&rig).await.unwrap();
            assert_eq!(host.reset_port(&rig, 1).await, Ok(Speed::Low));
        });
        let expected = if speed == Speed::High { wire::Speed::High } else { wire::Speed::Full };
        assert_eq!(rig.machine().core.port_speed(), Some(expected));
    }
}
