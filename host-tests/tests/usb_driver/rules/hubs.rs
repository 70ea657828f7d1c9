//! Rules that a hub watches.

use dwc2_host::Config;
use embassy_usb_driver::host::{PipeError, UsbPipe};
use usb_model::faulty::{Fault, Faulty};
use usb_model::hub::Hub;
use usb_model::shared::Shared;
use usb_model::violation::Rule;
use usb_model::wire::Speed;

use super::{assert_broken, full_speed_rig};
use crate::gadget::{Gadget, KEEP};
use crate::rig::Rig;
use crate::stack::{HubHost, setup};

#[test]
fn address_shared() {
    let rig = full_speed_rig();
    let mut hub = Hub::new(Speed::Full);
    hub.plug(1, Box::new(Gadget::new(Speed::Full)));
    hub.plug(2, Box::new(Gadget::new(Speed::Full)));
    rig.plug(hub);
    // A stack that resets the second device while the first one is at address 0 still.
    rig.run(async {
        let mut host = HubHost::on_root(&rig).await.unwrap();
        host.reset_port(&rig, 1).await.unwrap();
        let _ = host.enumerate(&rig, 2, 5).await;
    });
    assert_broken(&rig, Rule::AddressShared);
}

/// A device behind a hub's translator that can be broken.
fn with_a_faulty_device() -> (Rig, Shared<Faulty<Gadget>>) {
    let rig = Rig::new(Config::new());
    let device = Shared::new(Faulty::new(Gadget::new(Speed::Full)));
    let mut hub = Hub::new(Speed::High);
    hub.plug(1, Box::new(device.clone()));
    rig.plug(hub);
    (rig, device)
}

#[test]
fn tt_not_cleared() {
    let (rig, device) = with_a_faulty_device();
    // A stack that tries again at once.
    rig.run(async {
        let mut host = HubHost::on_root(&rig).await.unwrap();
        let mut control = host.enumerate(&rig, 1, 5).await.unwrap().control(64);
        device.lock().break_for(2, 3, Fault::Vanish);
        let request = setup(0x40, KEEP, 0, 0, 20);
        assert_eq!(control.control_out(&request, &[6; 20]).await, Err(PipeError::BadResponse));
        assert_eq!(rig.take_rules(), []);
        assert_eq!(control.control_out(&request, &[6; 20]).await, Ok(()));
    });
    assert_broken(&rig, Rule::TtNotCleared);
}

/// A translator keeps what comes and what goes apart, for a control endpoint too.
#[test]
fn tt_half_cleared() {
    for input in [false, true] {
        let (rig, device) = with_a_faulty_device();
        rig.run(async {
            let mut host = HubHost::on_root(&rig).await.unwrap();
            let known = host.enumerate(&rig, 1, 5).await.unwrap();
            // After the SETUP, the data that comes.
            device.lock().break_for(1, 3, Fault::Vanish);
            let request = setup(0x80, 6, 0x0100, 0, 18);
            assert!(known.control(64).control_in(&request, &mut [0; 18]).await.is_err());
            known.clear_half_buffer(input).await;
            assert_eq!(rig.take_rules(), []);
            assert_eq!(known.control(64).control_in(&request, &mut [0; 18]).await, Ok(18));
        });
        if input {
            assert_eq!(rig.take_rules(), []);
        } else {
            assert_broken(&rig, Rule::TtNotCleared);
        }
    }
}
