//! Plugs pulled at every moment, and driver objects dropped at every moment.

use dwc2_host::{Config, PIPES, SpeedLimit};
use embassy_usb_driver::EndpointType;
use embassy_usb_driver::host::pipe::{self, Control, In, InOut, Interrupt};
use embassy_usb_driver::host::{DeviceEvent, HostError, PipeError, UsbHostAllocator, UsbHostController, UsbPipe};
use usb_model::hub::Hub;
use usb_model::shared::Shared;
use usb_model::wire::Speed;

use crate::gadget::{GIVE, Gadget, KEEP};
use crate::rig::{Rig, both};
use crate::stack::{HubHost, Known, endpoint, enumerate_root, setup};

/// Control data and reports until something fails.
async fn use_for_ever(known: &Known, packet: u16) -> PipeError {
    let session = async {
        loop {
            let mut control = known.control(packet);
            control.control_out(&setup(0x40, KEEP, 0, 0, 70), &[6; 70]).await?;
            control.control_in(&setup(0xc0, GIVE, 0, 0, 70), &mut [0; 70]).await?;
            known.reports(8, 1).request_in(&mut [0; 8]).await?;
            // The toggles of a new pipe are DATA0: so are the device's after this.
            control.control_out(&setup(0, 9, 1, 0, 0), &[]).await?;
        }
    };
    let end: Result<(), PipeError> = session.await;
    end.unwrap_err()
}

/// Lets `count` more transactions go by.
async fn transactions(rig: &Rig, count: u64) {
    let end = rig.machine().core.transactions() + count;
    std::future::poll_fn(|context| {
        context.waker().wake_by_ref();
        if rig.machine().core.transactions() >= end { std::task::Poll::Ready(()) } else { std::task::Poll::Pending }
    })
    .await;
}

#[test]
fn a_plug_pulled_at_any_transaction_is_noticed_and_the_next_device_works() {
    for speed in [Speed::Low, Speed::Full, Speed::High] {
        let packet = if speed == Speed::Low { 8 } else { 64 };
        for count in 0..40 {
            let rig = Rig::new(Config::new());
            rig.plug(Gadget::counting(speed));
            rig.run(async {
                let known = enumerate_root(&rig, 5).await.unwrap();
                let pull = async {
                    transactions(&rig, count).await;
                    rig.unplug();
                    rig.now()
                };
                let (error, pulled) = both(use_for_ever(&known, packet), pull).await;
                assert_eq!(error, PipeError::Disconnected);
                assert!(rig.now() - pulled < 2_000, "noticed after {} us", rig.now() - pulled);
                let mut controller = rig.driver.controller();
                assert_eq!(controller.wait_for_device_event().await, DeviceEvent::Disconnected);
                rig.plug(Gadget::counting(speed));
                let again = enumerate_root(&rig, 6).await.unwrap();
                assert_eq!(again.reports(8, 1).request_in(&mut [0; 8]).await, Ok(4));
            });
            assert_eq!(rig.driver.take_fault(), None);
        }
    }
}

#[test]
fn a_plug_pulled_behind_a_hub_at_any_transaction_leaves_the_others_working() {
    for limit in [SpeedLimit::High, SpeedLimit::Full] {
        for speed in [Speed::Low, Speed::Full, Speed::High] {
            let packet = if speed == Speed::Low { 8 } else { 64 };
            for count in 0..30 {
                let rig = Rig::new(Config::new().with_speed_limit(limit));
                let hub = Shared::new(Hub::new(Speed::High));
                rig.plug(hub.clone());
                hub.lock().plug(1, Box::new(Gadget::counting(speed)));
                hub.lock().plug(2, Box::new(Gadget::counting(Speed::Full)));
                rig.run(async {
                    let mut host = HubHost::on_root(&rig).await.unwrap();
                    let known = host.enumerate(&rig, 1, 5).await.unwrap();
                    let other = host.enumerate(&rig, 2, 6).await.unwrap();
                    let mut others = other.reports(64, 2);
                    let pull = async {
                        transactions(&rig, count).await;
                        drop(hub.lock().unplug(1));
                    };
                    let (error, ()) = both(use_for_ever(&known, packet), pull).await;
                    assert_eq!(error, PipeError::BadResponse, "{limit:?} {speed:?} after {count}");
                    // The hub's driver does what it has to.
                    assert_eq!(host.status(1).await.unwrap().0 & 3, 0);
                    known.clear_buffer().await;
                    for expected in 0..20_u32 {
                        let mut report = [0; 4];
                        assert_eq!(others.request_in(&mut report).await, Ok(4));
                        assert_eq!(u32::from_le_bytes(report), expected);
                    }
                    hub.lock().plug(1, Box::new(Gadget::counting(speed)));
                    let again = host.enumerate(&rig, 1, 7).await.unwrap();
                    assert_eq!(again.reports(8, 1).request_in(&mut [0; 8]).await, Ok(4));
                });
            }
        }
    }
}

#[test]
fn a_loose_contact_does_not_confuse() {
    let rig = Rig::new(Config::new());
    for round in 0..30_u64 {
        rig.plug(Gadget::counting(Speed::High));
        rig.pass(round * 7_919 % 230_000);
        rig.unplug();
        rig.pass(round * 104_729 % 1_500);
    }
    rig.plug(Gadget::counting(Speed::High));
    let known = rig.run(async {
        loop {
            // Devices that came and went meanwhile may be announced first.
            if let Ok(known) = enumerate_root(&rig, 5).await {
                break known;
            }
        }
    });
    assert_eq!(rig.run(known.reports(8, 1).request_in(&mut [0; 8])), Ok(4));
    assert_eq!(rig.driver.take_fault(), None);
}

#[test]
fn a_request_dropped_at_any_moment_leaves_the_pipe_usable() {
    for limit in [SpeedLimit::High, SpeedLimit::Full] {
        let rig = Rig::new(Config::new().with_speed_limit(limit));
        let gadget = Shared::new(Gadget::new(Speed::Full));
        gadget.lock().hesitation = 2;
        let mut hub = Hub::new(Speed::High);
        hub.plug(1, Box::new(gadget.clone()));
        rig.plug(hub);
        let (known, _host) = rig.run(async {
            let mut host = HubHost::on_root(&rig).await.unwrap();
            (host.enumerate(&rig, 1, 5).await.unwrap(), host)
        });
        let mut control = known.control(64);
        for round in 0..200_u64 {
            let sent = [round as u8; 70];
            let _ = rig.run_for(round * 37 % 3_000, control.control_out(&setup(0x40, KEEP, 0, 0, 70), &sent));
            rig.pass(round % 3 * 500);
            rig.run(control.control_out(&setup(0x40, KEEP, 0, 0, 70), &sent)).unwrap();
            let mut got = [0; 70];
            assert_eq!(rig.run(control.control_in(&setup(0xc0, GIVE, 0, 0, 70), &mut got)), Ok(70));
            assert_eq!(got, sent);
        }
        // A report request that is dropped loses no report.
        gadget.lock().counting = Some(0);
        gadget.lock().hesitation = 0;
        let mut reports = known.reports(8, 2);
        for expected in 0..400_u64 {
            let mut report = [0; 4];
            let early = rig.run_for(expected * 61 % 2_500, reports.request_in(&mut report));
            rig.pass(expected % 4 * 300);
            if early.is_none() {
                assert_eq!(rig.run(reports.request_in(&mut report)), Ok(4));
            }
            assert_eq!(u64::from(u32::from_le_bytes(report)), expected);
        }
    }
}

#[test]
fn pipes_run_out_and_come_back() {
    let rig = Rig::new(Config::new());
    rig.plug(Gadget::new(Speed::Full));
    let known = rig.run(enumerate_root(&rig, 5)).unwrap();
    for _ in 0..3 {
        let info = endpoint(1, EndpointType::Interrupt, true, 8, 1);
        let pipes: Vec<_> = (0..PIPES).map(|_| known.pipe::<Interrupt, In>(&info)).collect();
        let more = known.allocator.alloc_pipe::<Interrupt, In>(5, &info, None);
        assert_eq!(more.err(), Some(HostError::OutOfPipes));
        drop(pipes);
    }
    // Those dropped in the middle of a transfer come back, too.
    for round in 0..50_u64 {
        let mut bulk = known.reports(8, 1);
        let _ = rig.run_for(round * 53 % 2_000, bulk.request_in(&mut [0; 8]));
        drop(bulk);
        let mut control = known.control(64);
        let _ = rig.run_for(round * 31 % 400, control.control_in(&setup(0x80, 6, 0x0100, 0, 18), &mut [0; 18]));
        drop(control);
    }
    rig.pass(10_000);
    let info = endpoint(0, EndpointType::Control, true, 64, 0);
    let pipes: Vec<_> = (0..PIPES).map(|_| known.pipe::<Control, InOut>(&info)).collect();
    assert_eq!(pipes.len(), PIPES);
}

#[test]
fn more_pipes_than_channels_take_turns() {
    let rig = Rig::on(usb_model::dwc2::Build::raspi2b(), Config::new());
    rig.plug(Gadget::new(Speed::Full));
    let known = rig.run(enumerate_root(&rig, 5)).unwrap();
    let mut pipes: Vec<_> = (0..PIPES).map(|_| known.control(64)).collect();
    let ask = |pipe: &mut crate::stack::ControlPipe| {
        let mut got = [0; 18];
        assert_eq!(rig.run(pipe.control_in(&setup(0x80, 6, 0x0100, 0, 18), &mut got)), Ok(18));
    };
    pipes.iter_mut().for_each(ask);
    // Two requests to one control endpoint do not mix.
    let [first, second] = &mut pipes[..2] else { unreachable!() };
    let (mut a, mut b) = ([0; 18], [0; 18]);
    let (setup_a, setup_b) = (setup(0x80, 6, 0x0100, 0, 18), setup(0x80, 6, 0x0200, 0, 18));
    let done = rig.run(both(first.control_in(&setup_a, &mut a), second.control_in(&setup_b, &mut b)));
    assert_eq!(done, (Ok(18), Ok(9)));
    assert_eq!((a[1], b[1]), (1, 2));
}

#[test]
fn endpoints_that_do_not_exist_are_refused() {
    let rig = Rig::new(Config::new());
    let allocator = rig.driver.allocator();
    let control = |bytes| endpoint(0, EndpointType::Control, true, bytes, 0);
    let nothing_there = allocator.alloc_pipe::<Control, InOut>(0, &control(8), None);
    assert_eq!(nothing_there.err(), Some(HostError::NoSuchDevice));
    rig.plug(Gadget::new(Speed::Full));
    rig.run(crate::stack::connected(&rig));
    for bytes in [0, 1, 7, 9, 63, 65, 512, 1024] {
        let refused = allocator.alloc_pipe::<Control, InOut>(0, &control(bytes), None);
        assert_eq!(refused.err(), Some(HostError::InvalidDescriptor), "{bytes}");
    }
    let interrupt = |bytes| endpoint(1, EndpointType::Interrupt, true, bytes, 1);
    for (address, info, error) in [
        (128, interrupt(8), HostError::InvalidDescriptor),
        (1, interrupt(0), HostError::InvalidDescriptor),
        (1, interrupt(65), HostError::InvalidDescriptor),
        (1, endpoint(1, EndpointType::Interrupt, false, 8, 1), HostError::InvalidDescriptor),
        (1, endpoint(1, EndpointType::Bulk, true, 8, 1), HostError::InvalidDescriptor),
        (1, endpoint(1, EndpointType::Isochronous, true, 8, 1), HostError::InvalidDescriptor),
    ] {
        assert_eq!(allocator.alloc_pipe::<Interrupt, In>(address, &info, None).err(), Some(error));
    }
}

#[test]
fn packets_that_a_speed_does_not_have_are_refused() {
    use EndpointType::{Bulk, Control, Interrupt};
    // USB 2.0 §5.5.3, §5.7.3, §5.8.3.
    for (speed, kind, sizes) in [
        (Speed::Low, Control, &[16, 64][..]),
        (Speed::Low, Interrupt, &[0, 9, 64]),
        (Speed::Low, Bulk, &[8, 64]),
        (Speed::Full, Control, &[0, 9, 512]),
        (Speed::Full, Interrupt, &[0, 65, 1_024]),
        (Speed::Full, Bulk, &[0, 9, 512]),
        (Speed::High, Control, &[8, 32, 512]),
        (Speed::High, Interrupt, &[0, 1_025]),
        (Speed::High, Bulk, &[8, 64]),
    ] {
        let rig = Rig::new(Config::new());
        rig.plug(Gadget::new(speed));
        rig.run(crate::stack::connected(&rig));
        let allocator = rig.driver.allocator();
        for &bytes in sizes {
            let info = endpoint(if kind == Control { 0 } else { 1 }, kind, true, bytes, 1);
            let error = match kind {
                Control => allocator.alloc_pipe::<pipe::Control, pipe::InOut>(1, &info, None).err(),
                Bulk => allocator.alloc_pipe::<pipe::Bulk, In>(1, &info, None).err(),
                _ => allocator.alloc_pipe::<pipe::Interrupt, In>(1, &info, None).err(),
            };
            assert_eq!(error, Some(HostError::InvalidDescriptor), "{speed:?} {kind:?} {bytes}");
        }
        let largest = endpoint(1, Interrupt, true, 1_024, 1);
        let error = allocator.alloc_pipe::<pipe::Interrupt, In>(1, &largest, None).err();
        let no_room = speed == Speed::High;
        assert_eq!(error == Some(HostError::InsufficientMemory), no_room, "{speed:?}");
    }
}

#[test]
fn a_bus_reset_brings_the_device_to_its_default_state() {
    for speed in [Speed::Low, Speed::Full, Speed::High] {
        let rig = Rig::new(Config::new());
        rig.plug(Gadget::counting(speed));
        rig.run(async {
            let known = enumerate_root(&rig, 5).await.unwrap();
            let mut reports = known.reports(8, 1);
            let resetting = async {
                rig.sleep(10_000).await;
                rig.driver.controller().bus_reset().await;
            };
            let reading = async {
                loop {
                    if let Err(error) = reports.request_in(&mut [0; 8]).await {
                        break error;
                    }
                }
            };
            let (error, ()) = both(reading, resetting).await;
            assert_eq!(error, PipeError::Disconnected);
            // The old pipe is no good any more, a new one is.
            assert_eq!(reports.request_in(&mut [0; 8]).await, Err(PipeError::Disconnected));
            let root = match speed {
                Speed::Low => embassy_usb_driver::Speed::Low,
                Speed::Full => embassy_usb_driver::Speed::Full,
                Speed::High => embassy_usb_driver::Speed::High,
            };
            let again = crate::stack::enumerate(&rig, root, None, 6).await.unwrap();
            assert_eq!(again.reports(8, 1).request_in(&mut [0; 8]).await, Ok(4));
        });
        assert_eq!(rig.driver.take_fault(), None);
    }
}

#[test]
fn a_driver_that_is_shut_down_leaves_the_port_dark_and_starts_again() {
    let rig = Rig::new(Config::new());
    rig.plug(Gadget::counting(Speed::Full));
    rig.run(async {
        let known = enumerate_root(&rig, 5).await.unwrap();
        let mut reports = known.reports(8, 1);
        assert_eq!(reports.request_in(&mut [0; 8]).await, Ok(4));
        rig.driver.shut_down();
        rig.sleep(50_000).await;
        assert_eq!(rig.machine().core.port_state(), (false, false));
        assert!(!rig.machine().core.irq());
        assert_eq!(reports.request_in(&mut [0; 8]).await, Err(PipeError::Disconnected));
        rig.driver.start();
        let again = enumerate_root(&rig, 6).await.unwrap();
        assert_eq!(again.reports(8, 1).request_in(&mut [0; 8]).await, Ok(4));
    });
}
