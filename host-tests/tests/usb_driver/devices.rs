//! Devices that misbehave: each ends in a named error in time, and the next good one works.

use dwc2_host::{Config, Fault, SpeedLimit, TransferError};
use embassy_usb_driver::EndpointType;
use embassy_usb_driver::host::pipe::{Bulk, In};
use embassy_usb_driver::host::{DeviceEvent, PipeError, UsbHostController, UsbPipe};
use usb_model::faulty::{Fault as Mischief, Faulty};
use usb_model::hub::Hub;
use usb_model::shared::Shared;
use usb_model::wire::Speed;

use crate::gadget::{GIVE, Gadget, KEEP};
use crate::rig::Rig;
use crate::stack::{HubHost, Known, endpoint, enumerate_root, setup};

/// Where a device hangs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Place {
    Root,
    /// Behind a hub at high speed, and at full speed.
    Hub(SpeedLimit),
}

const PLACES: [Place; 3] = [Place::Root, Place::Hub(SpeedLimit::High), Place::Hub(SpeedLimit::Full)];

type Culprit = Shared<Faulty<Gadget>>;

/// A rig with a device that may misbehave, and the device once it has an address.
async fn start(rig: &Rig, place: Place, culprit: &Culprit) -> (Option<HubHost>, Known) {
    if place == Place::Root {
        rig.plug(culprit.clone());
        return (None, enumerate_root(rig, 5).await.unwrap());
    }
    let mut hub = Hub::new(Speed::High);
    hub.plug(2, Box::new(culprit.clone()));
    rig.plug(hub);
    let mut host = HubHost::on_root(rig).await.unwrap();
    let known = host.enumerate(rig, 2, 5).await.unwrap();
    (Some(host), known)
}

fn rig_at(place: Place) -> Rig {
    let limit = match place {
        Place::Hub(limit) => limit,
        Place::Root => SpeedLimit::High,
    };
    Rig::new(Config::new().with_speed_limit(limit))
}

/// Runs `scene` with a device of every slower speed at every place.
fn everywhere(scene: impl AsyncFn(&Rig, &Culprit, Known, u16)) {
    for place in PLACES {
        for speed in [Speed::Low, Speed::Full] {
            let rig = rig_at(place);
            let culprit = Shared::new(Faulty::new(Gadget::counting(speed)));
            rig.run(async {
                let (_hub, known) = start(&rig, place, &culprit).await;
                scene(&rig, &culprit, known, if speed == Speed::Low { 8 } else { 64 }).await;
            });
        }
    }
}

/// After a failure of whatever kind.
async fn works(known: &Known, packet: u16) {
    known.clear_buffer().await;
    let mut control = known.control(packet);
    control.control_out(&setup(0x40, KEEP, 0, 0, 20), &[6; 20]).await.unwrap();
    let mut got = [0; 20];
    assert_eq!(control.control_in(&setup(0xc0, GIVE, 0, 0, 20), &mut got).await, Ok(20));
    assert_eq!(got, [6; 20]);
}

#[test]
fn one_that_answers_nak_for_ever_times_out() {
    everywhere(async |rig, culprit, known, packet| {
        let mut control = known.control(packet);
        culprit.lock().break_after(0, Mischief::NakForever);
        // USB 2.0 §9.2.6.4: 500 ms for data, 50 ms without; a poll, and a frame to halt the channel, on top.
        for (length, limit) in [(20, 500_000), (0, 50_000)] {
            let begun = rig.now();
            let error = control.control_out(&setup(0x40, KEEP, 0, 0, length), &[1; 20]).await;
            let took = rig.now() - begun;
            assert_eq!(error, Err(PipeError::Timeout));
            assert_eq!(control.last_error(), Some(TransferError::Timeout));
            assert!((limit..limit + 5_000).contains(&took), "{took} us");
        }
        let error = control.control_in(&setup(0xc0, GIVE, 0, 0, 20), &mut [0; 20]).await;
        assert_eq!(error, Err(PipeError::Timeout));
        culprit.lock().mend();
        drop(control);
        works(&known, packet).await;
    });
}

#[test]
fn one_that_stalls_everything_is_told_apart_and_works_again() {
    everywhere(async |_, culprit, known, packet| {
        let mut control = known.control(packet);
        culprit.lock().break_after(0, Mischief::StallAll);
        for length in [0, 20] {
            let error = control.control_out(&setup(0x40, KEEP, 0, 0, length), &[1; 20]).await;
            assert_eq!(error, Err(PipeError::Stall));
            let error = control.control_in(&setup(0xc0, GIVE, 0, 0, length), &mut [0; 20]).await;
            assert_eq!(error, Err(PipeError::Stall));
        }
        assert_eq!(known.reports(8, 1).request_in(&mut [0; 8]).await, Err(PipeError::Stall));
        culprit.lock().mend();
        drop(control);
        works(&known, packet).await;
    });
}

#[test]
fn an_unknown_request_is_stalled_and_the_next_one_served() {
    everywhere(async |_, _, known, packet| {
        let error = known.control(packet).control_in(&setup(0xc0, 99, 0, 0, 4), &mut [0; 4]).await;
        assert_eq!(error, Err(PipeError::Stall));
        works(&known, packet).await;
    });
}

#[test]
fn one_that_babbles_is_told_apart_and_works_again() {
    everywhere(async |_, culprit, known, packet| {
        let mut control = known.control(packet);
        culprit.lock().break_after(0, Mischief::Babble(usize::from(packet) + 1));
        let error = control.control_in(&setup(0xc0, GIVE, 0, 0, 20), &mut [0; 20]).await;
        assert_eq!(error, Err(PipeError::Babble));
        assert_eq!(known.reports(8, 1).request_in(&mut [0; 8]).await, Err(PipeError::Babble));
        culprit.lock().mend();
        drop(control);
        works(&known, packet).await;
    });
}

#[test]
fn data_longer_than_asked_for_never_leaves_the_buffer() {
    everywhere(async |_, culprit, known, packet| {
        culprit.lock().device().kept = vec![3; 8];
        let mut reports = known.reports(8, 1);
        let mut small = [0xee; 4];
        assert_eq!(reports.request_in(&mut small[..3]).await, Err(PipeError::BufferOverflow));
        assert_eq!(small, [0xee; 4]);
        // A packet is whole, the transfer is not: what the device has beyond wLength is refused.
        culprit.lock().break_after(1, Mischief::Babble(8));
        let mut control = known.control(packet);
        let error = control.control_in(&setup(0xc0, GIVE, 0, 0, 4), &mut small).await;
        assert_eq!(error, Err(PipeError::BufferOverflow));
        assert_eq!(small, [0xee; 4]);
        culprit.lock().mend();
        // The caller's bytes must cover wLength.
        let error = control.control_in(&setup(0xc0, GIVE, 0, 0, 5), &mut small).await;
        assert_eq!(error, Err(PipeError::BufferOverflow));
        drop(control);
        works(&known, packet).await;
    });
}

#[test]
fn a_babble_past_the_end_of_the_frame_costs_the_port_and_the_device_comes_back() {
    let rig = Rig::new(Config::new());
    let culprit = Shared::new(Faulty::new(Gadget::new(Speed::Full)));
    rig.run(async {
        let (_, known) = start(&rig, Place::Root, &culprit).await;
        let mut control = known.control(64);
        culprit.lock().break_after(1, Mischief::Babble(1_500));
        let error = control.control_in(&setup(0xc0, GIVE, 0, 0, 20), &mut [0; 20]).await.unwrap_err();
        assert!(matches!(error, PipeError::Babble | PipeError::Disconnected), "{error:?}");
        culprit.lock().mend();
        let event = rig.driver.controller().wait_for_device_event().await;
        assert_eq!(event, DeviceEvent::Disconnected);
        assert_eq!(rig.driver.take_fault(), Some(Fault::PortDisabled));
        let again = enumerate_root(&rig, 6).await.unwrap();
        works(&again, 64).await;
    });
}

#[test]
fn three_strikes_end_a_transfer_and_two_do_not() {
    everywhere(async |_, culprit, known, packet| {
        // Once at every stage of a transfer of 20 bytes.
        for good in 0..8 {
            culprit.lock().break_for(good, 2, Mischief::Vanish);
            works(&known, packet).await;
        }
        culprit.lock().mend();
        let mut control = known.control(packet);
        culprit.lock().break_after(2, Mischief::Vanish);
        let error = control.control_out(&setup(0x40, KEEP, 0, 0, 20), &[6; 20]).await;
        assert_eq!(error, Err(PipeError::BadResponse));
        assert_eq!(control.last_error(), Some(TransferError::NoAnswer));
        culprit.lock().mend();
        drop(control);
        works(&known, packet).await;
    });
}

#[test]
fn a_wrong_toggle_is_never_taken_for_data() {
    everywhere(async |_, culprit, known, _| {
        let mut reports = known.reports(8, 1);
        let mut numbers = Vec::new();
        for step in 0..50 {
            if step % 10 == 5 {
                culprit.lock().break_for(0, 1, Mischief::WrongToggle);
            }
            let mut report = [0; 4];
            assert_eq!(reports.request_in(&mut report).await, Ok(4));
            numbers.push(u32::from_le_bytes(report));
        }
        // The packet with the wrong toggle is dropped, and the next one, whose toggle is the device's next but not the host's.
        let steps: Vec<u32> = numbers.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert_eq!(steps.iter().filter(|step| **step == 3).count(), 5, "{numbers:?}");
        assert_eq!(steps.iter().filter(|step| **step == 1).count(), 44, "{numbers:?}");
    });
}

#[test]
fn one_that_vanishes_at_any_transaction_ends_in_an_error_and_the_next_one_works() {
    for place in PLACES {
        for good in 0..40 {
            let rig = rig_at(place);
            let culprit = Shared::new(Faulty::new(Gadget::counting(Speed::Full)));
            rig.run(async {
                let (hub, known) = start(&rig, place, &culprit).await;
                culprit.lock().break_after(good, Mischief::Vanish);
                let begun = rig.now();
                let error = async {
                    loop {
                        let mut control = known.control(64);
                        control.control_out(&setup(0x40, KEEP, 0, 0, 70), &[6; 70]).await?;
                        control.control_in(&setup(0xc0, GIVE, 0, 0, 70), &mut [0; 70]).await?;
                        known.reports(64, 1).request_in(&mut [0; 64]).await?;
                        // The toggles of a new pipe are DATA0: so are the device's after this.
                        control.control_out(&setup(0, 9, 1, 0, 0), &[]).await?;
                    }
                };
                let error: Result<(), PipeError> = error.await;
                assert_eq!(error, Err(PipeError::BadResponse), "{place:?} after {good}");
                assert!(rig.now() - begun < 700_000);
                // Another one in its place.
                if let Some(mut host) = hub {
                    known.clear_buffer().await;
                    culprit.lock().mend();
                    let again = host.enumerate_again(&rig, 2, 6).await.unwrap();
                    works(&again, 64).await;
                } else {
                    rig.unplug();
                    rig.plug(Gadget::new(Speed::Full));
                    works(&enumerate_root(&rig, 6).await.unwrap(), 64).await;
                }
            });
        }
    }
}

#[test]
fn an_endpoint_that_has_nothing_is_left_alone_when_nobody_waits() {
    let rig = Rig::new(Config::new());
    let gadget = Shared::new(Gadget::new(Speed::Full));
    rig.plug(gadget.clone());
    let known = rig.run(enumerate_root(&rig, 5)).unwrap();
    let mut reports = known.reports(8, 4);
    assert!(rig.run_for(100_000, reports.request_in(&mut [0; 8])).is_none());
    let polls = gadget.lock().polls.len();
    assert!((24..=27).contains(&polls), "{polls} polls in 100 ms");
    rig.pass(100_000);
    assert!(gadget.lock().polls.len() <= polls + 1);
    // Nor does a bulk endpoint keep its channel.
    let mut bulk = known.pipe::<Bulk, In>(&endpoint(3, EndpointType::Bulk, true, 64, 0));
    assert!(rig.run_for(20_000, bulk.request_in(&mut [0; 64])).is_none());
    gadget.lock().bulk.extend([1, 2, 3]);
    rig.pass(20_000);
    assert_eq!(gadget.lock().bulk.len(), 3);
    assert_eq!(rig.run(bulk.request_in(&mut [0; 64])), Ok(3));
}

#[test]
fn a_device_without_an_address_does_not_answer_for_another() {
    let rig = Rig::new(Config::new());
    rig.plug(Gadget::new(Speed::Full));
    rig.run(async {
        let known = enumerate_root(&rig, 5).await.unwrap();
        let stranger = Known { address: 77, ..known };
        let error = stranger.control(64).control_in(&setup(0x80, 6, 0x0100, 0, 8), &mut [0; 8]).await;
        assert_eq!(error, Err(PipeError::BadResponse));
        works(&known, 64).await;
    });
}

#[test]
fn slow_answers_are_waited_for() {
    everywhere(async |_, culprit, known, packet| {
        for hesitation in [1, 3, 10] {
            culprit.lock().device().hesitation = hesitation;
            works(&known, packet).await;
        }
    });
}
