//! How long things take, in the bus's own time.

use dwc2_host::{Config, Pipe, SpeedLimit};
use embassy_usb_driver::host::pipe::{In, Interrupt};
use embassy_usb_driver::host::{PipeError, UsbPipe};
use usb_model::hub::Hub;
use usb_model::shared::Shared;
use usb_model::wire::Speed;

use crate::gadget::Gadget;
use crate::rig::{Rig, both};
use crate::stack::{HubHost, Known, enumerate_root, setup};

/// A gadget behind a hub that is plugged in at power-on.
fn behind_hub(limit: SpeedLimit, speed: Speed) -> (Rig, Shared<Gadget>) {
    let rig = Rig::new(Config::new().with_speed_limit(limit));
    let gadget = Shared::new(Gadget::new(speed));
    let mut hub = Hub::new(Speed::High);
    hub.plug(2, Box::new(gadget.clone()));
    rig.plug(hub);
    (rig, gadget)
}

async fn reach(rig: &Rig) -> (HubHost, Known) {
    let mut host = HubHost::on_root(rig).await.unwrap();
    let known = host.enumerate(rig, 2, 5).await.unwrap();
    (host, known)
}

#[test]
fn the_first_report_comes_within_a_second_and_a_half_of_power() {
    for limit in [SpeedLimit::High, SpeedLimit::Full] {
        for speed in [Speed::Low, Speed::Full, Speed::High] {
            let (rig, gadget) = behind_hub(limit, speed);
            gadget.lock().counting = Some(0);
            let took = rig.run(async {
                let (_host, known) = reach(&rig).await;
                known.reports(8, 10).request_in(&mut [0; 8]).await.unwrap();
                rig.now()
            });
            println!("{limit:?} {speed:?}: {took} us from power-on, hub included");
            assert!(took < 1_500_000);
        }
    }
}

#[test]
fn a_report_is_there_within_its_interval_and_a_millisecond() {
    for limit in [SpeedLimit::High, SpeedLimit::Full] {
        for (speed, interval) in [(Speed::Full, 1), (Speed::Full, 4), (Speed::Full, 8), (Speed::Low, 10)] {
            let (rig, gadget) = behind_hub(limit, speed);
            let (_host, known) = rig.run(reach(&rig));
            let mut reports = known.reports(8, interval);
            let mut worst = 0;
            for round in 0..300_u64 {
                let mut report = [0; 8];
                let pressed = rig.now() + round * 613 % 17_000;
                gadget.lock().pressed = Some((pressed, vec![round as u8; 5]));
                assert_eq!(rig.run(reports.request_in(&mut report)), Ok(5));
                worst = worst.max(rig.now() - pressed);
            }
            println!("{limit:?} {speed:?}, every {interval} ms: {worst} us at worst");
            assert!(worst < u64::from(interval) * 1_000 + 1_000, "{worst} us for {interval} ms");
        }
    }
}

#[test]
fn an_endpoint_is_polled_as_often_as_it_asks_for_and_not_much_more() {
    for limit in [SpeedLimit::High, SpeedLimit::Full] {
        for interval in [1_u64, 2, 3, 5, 8, 10, 16, 32] {
            let (rig, gadget) = behind_hub(limit, Speed::Full);
            let (_host, known) = rig.run(reach(&rig));
            let mut reports = known.reports(8, interval as u8);
            assert!(rig.run_for(50 * interval * 1_000, reports.request_in(&mut [0; 8])).is_none());
            let gadget = gadget.lock();
            let steps: Vec<u64> = gadget.polls.windows(2).map(|pair| pair[1] - pair[0]).collect();
            let (least, most) = (steps.iter().min().unwrap(), steps.iter().max().unwrap());
            // A transaction has its place anywhere in its frame.
            assert!(*most <= interval * 1_000 + 400, "{limit:?} {interval} ms: {most} us");
            assert!(*least + 1_000 >= interval * 1_000 - 400, "{limit:?} {interval} ms: {least} us");
        }
    }
}

#[test]
fn interrupts_may_be_a_quarter_of_a_millisecond_late() {
    for latency in [2, 30, 60, 110, 150, 200, 240] {
        let (rig, gadget) = behind_hub(SpeedLimit::High, Speed::Full);
        gadget.lock().counting = Some(0);
        rig.latency.set(latency);
        rig.run(async {
            let (_host, known) = reach(&rig).await;
            let mut reports = known.reports(8, 4);
            for expected in 0..100 {
                let mut report = [0; 4];
                assert_eq!(reports.request_in(&mut report).await, Ok(4), "latency {latency}");
                assert_eq!(u32::from_le_bytes(report), expected, "latency {latency}");
            }
        });
    }
}

/// Between the look at HFNUM and the start of a channel the (micro)frame may turn.
#[test]
fn time_may_pass_between_two_accesses() {
    for limit in [SpeedLimit::High, SpeedLimit::Full] {
        for seed in 0..24 {
            let rig = Rig::new(Config::new().with_speed_limit(limit));
            rig.take_time(seed, 1 + seed as usize * 10);
            let mut hub = Hub::new(Speed::High);
            hub.plug(1, Box::new(Gadget::counting(Speed::Full)));
            hub.plug(2, Box::new(Gadget::counting(Speed::Low)));
            rig.plug(hub);
            rig.run(async {
                let mut host = HubHost::on_root(&rig).await.unwrap();
                let pad = host.enumerate(&rig, 1, 5).await.unwrap();
                let keyboard = host.enumerate(&rig, 2, 6).await.unwrap();
                let (mut fast, mut slow) = (pad.reports(8, 1), keyboard.reports(8, 10));
                both(count(&mut fast, 400), count(&mut slow, 40)).await;
            });
        }
    }
}

/// Reads that many reports; none is lost or comes twice.
async fn count(reports: &mut Pipe<'static, Interrupt, In>, number: u32) {
    for expected in 0..number {
        let mut report = [0; 4];
        assert_eq!(reports.request_in(&mut report).await, Ok(4));
        assert_eq!(u32::from_le_bytes(report), expected);
    }
}

#[test]
fn interrupts_later_than_that_starve_interrupt_splits_and_nothing_else() {
    let (rig, gadget) = behind_hub(SpeedLimit::High, Speed::Full);
    gadget.lock().counting = Some(0);
    rig.latency.set(700);
    let (mut host, known) = rig.run(reach(&rig));
    assert!(rig.run_for(100_000, known.reports(8, 4).request_in(&mut [0; 8])).is_none());
    assert_eq!(rig.run(host.status(2)).unwrap().0 & 3, 3);
    // It is not silent for ever.
    let silent = rig.run_for(1_000_000, known.reports(8, 1).request_in(&mut [0; 8]));
    assert_eq!(silent, Some(Err(PipeError::BadResponse)));
    rig.latency.set(2);
    assert_eq!(rig.run(known.reports(8, 4).request_in(&mut [0; 8])), Ok(4));
}

#[test]
fn without_its_interrupt_line_all_works_but_interrupt_splits() {
    for limit in [SpeedLimit::High, SpeedLimit::Full] {
        let (rig, gadget) = behind_hub(limit, Speed::Full);
        gadget.lock().counting = Some(0);
        rig.interrupts.set(false);
        // Nobody listens to the line.
        rig.tamper_writes(|_, offset, value| Some(if offset == 0x008 { value & !1 } else { value }));
        let (mut host, known) = rig.run(reach(&rig));
        assert_eq!(rig.run(host.status(2)).unwrap().0 & 3, 3);
        let mut control = known.control(64);
        let mut descriptor = [0; 18];
        assert_eq!(rig.run(control.control_in(&setup(0x80, 6, 0x0100, 0, 18), &mut descriptor)), Ok(18));
        let mut reports = known.reports(8, 4);
        let report = rig.run_for(100_000, reports.request_in(&mut [0; 8]));
        assert_eq!(report.is_some(), limit == SpeedLimit::Full);
        rig.take_rules();
    }
    let rig = Rig::new(Config::new());
    rig.plug(Gadget::counting(Speed::High));
    rig.interrupts.set(false);
    rig.tamper_writes(|_, offset, value| Some(if offset == 0x008 { value & !1 } else { value }));
    rig.run(async {
        let known = enumerate_root(&rig, 5).await.unwrap();
        for _ in 0..50 {
            known.control(64).control_in(&setup(0x80, 6, 0x0100, 0, 18), &mut [0; 18]).await.unwrap();
        }
    });
    rig.take_rules();
}
