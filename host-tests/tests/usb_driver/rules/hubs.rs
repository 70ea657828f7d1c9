//! Rules that a hub watches.

use usb_model::hub::Hub;
use usb_model::violation::Rule;
use usb_model::wire::Speed;

use super::{assert_broken, full_speed_rig};
use crate::gadget::Gadget;
use crate::stack::HubHost;

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
