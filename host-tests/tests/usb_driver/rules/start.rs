//! Rules of the core's start and of the root port.

use dwc2_host::Config;
use embassy_usb_driver::host::UsbPipe;
use usb_model::violation::Rule;
use usb_model::wire::Speed;

use super::{assert_broken, full_speed_rig, hub_session, offset, on_channels, on_register, root_session, starts};
use crate::gadget::Gadget;
use crate::rig::Rig;
use crate::stack::enumerate_root;

const RESET: u32 = 1;

#[test]
fn reset_while_busy() {
    let rig = full_speed_rig();
    rig.tamper_writes(|machine, offset, value| {
        if offset == offset::GRSTCTL && value & RESET != 0 {
            machine.core.write(offset, value);
        }
        Some(value)
    });
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::ResetWhileBusy);
}

#[test]
fn access_in_reset() {
    let rig = full_speed_rig();
    rig.tamper_writes(|machine, offset, value| {
        if offset == offset::GRSTCTL && value & RESET != 0 {
            machine.core.write(offset, value);
            machine.core.write(offset::GAHBCFG, 0);
            return None;
        }
        Some(value)
    });
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::AccessInReset);
}

#[test]
fn device_mode() {
    let rig = full_speed_rig();
    // A driver that does not wait until the core is a host.
    rig.tamper_reads(|_, offset, value| if offset == offset::GINTSTS { value | 1 } else { value });
    rig.machine().tamper.haste = 9;
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::DeviceMode);
}

#[test]
fn phy_without_reset() {
    let rig = full_speed_rig();
    let mut was_reset = false;
    rig.tamper_writes(move |_, offset, value| {
        was_reset |= offset == offset::GRSTCTL && value & RESET != 0;
        Some(if offset == offset::GUSBCFG && was_reset { value | 1 << 7 } else { value })
    });
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::PhyWithoutReset);
}

#[test]
fn both_roles() {
    let rig = full_speed_rig();
    on_register(&rig, offset::GUSBCFG, |value| value | 1 << 30);
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::BothRoles);
}

#[test]
fn fifo_overlap() {
    let rig = full_speed_rig();
    on_register(&rig, offset::GNPTXFSIZ, |value| value - 100);
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::FifoOverlap);
}

#[test]
fn fifo_too_deep() {
    let rig = full_speed_rig();
    on_register(&rig, offset::HPTXFSIZ, |value| value & 0xffff | 8_000 << 16);
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::FifoTooDeep);
}

#[test]
fn fifo_too_small() {
    for (register, small) in [(offset::GRXFSIZ, 17), (offset::GNPTXFSIZ, 15 << 16), (offset::HPTXFSIZ, 1 << 16)] {
        let rig = full_speed_rig();
        on_register(
            &rig,
            register,
            move |value| if register == offset::GRXFSIZ { small } else { value & 0xffff | small },
        );
        root_session(&rig, Speed::Full);
        assert_broken(&rig, Rule::FifoTooSmall);
    }
}

#[test]
fn fifo_not_flushed() {
    for flush in [1 << 4, 1 << 5] {
        let rig = full_speed_rig();
        on_register(&rig, offset::GRSTCTL, move |value| value & !flush);
        root_session(&rig, Speed::Full);
        assert_broken(&rig, Rule::FifoNotFlushed);
    }
}

#[test]
fn clock_select() {
    let rig = full_speed_rig();
    on_register(&rig, offset::HCFG, |value| value | 1);
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::ClockSelect);
}

#[test]
fn frame_interval() {
    let rig = full_speed_rig();
    on_register(&rig, offset::HFIR, |value| value + 1);
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::FrameInterval);
}

#[test]
fn descriptor_dma() {
    let rig = full_speed_rig();
    on_register(&rig, offset::HCFG, |value| value | 1 << 23);
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::DescriptorDma);
}

#[test]
fn port_enable_written() {
    let rig = full_speed_rig();
    on_register(&rig, offset::HPRT, |value| value | 1 << 2);
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::PortEnableWritten);
}

#[test]
fn port_event_lost() {
    let rig = full_speed_rig();
    // A driver that answers every interrupt by clearing all that the port says, before it reads it.
    rig.tamper_writes(|machine, offset, value| {
        if offset == offset::GINTSTS {
            machine.core.write(offset::HPRT, 1 << 12 | 0x2a);
        }
        Some(value)
    });
    root_session(&rig, Speed::Full);
    rig.unplug();
    rig.pass(5_000);
    assert_broken(&rig, Rule::PortEventLost);
}

#[test]
fn port_unpowered() {
    let rig = full_speed_rig();
    on_register(&rig, offset::HPRT, |value| if value & 1 << 8 != 0 { value & !(1 << 12) } else { value });
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::PortUnpowered);
}

#[test]
fn debounce() {
    let rig = full_speed_rig();
    rig.pass(300_000);
    rig.machine().tamper.haste = 1;
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::Debounce);
}

#[test]
fn reset_too_short() {
    let rig = full_speed_rig();
    rig.pass(300_000);
    rig.machine().tamper.haste = 1;
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::ResetTooShort);
}

#[test]
fn reset_recovery() {
    let rig = full_speed_rig();
    rig.pass(300_000);
    rig.machine().tamper.haste = 1;
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::ResetRecovery);
}

#[test]
fn reset_under_traffic() {
    let rig = full_speed_rig();
    rig.tamper_writes(|machine, offset, value| {
        if starts(offset, value) {
            machine.core.write(offset, value);
            machine.core.write(offset::HPRT, 1 << 12 | 1 << 8);
            return None;
        }
        Some(value)
    });
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::ResetUnderTraffic);
}

#[test]
fn port_not_enabled() {
    let rig = full_speed_rig();
    rig.plug(Gadget::counting(Speed::Full));
    let mut reports = rig.run(async {
        let mut reports = enumerate_root(&rig, 5).await.unwrap().reports(8, 8);
        reports.request_in(&mut [0; 8]).await.unwrap();
        reports
    });
    // A driver that does not see the device go, and asks it again 8 ms later.
    rig.tamper_reads(|_, offset, value| match offset {
        offset::HPRT => value & !0x2a | 5,
        offset::GINTSTS => value & !(1 << 29),
        _ => value,
    });
    rig.unplug();
    assert!(rig.run_for(20_000, reports.request_in(&mut [0; 8])).is_none());
    assert_broken(&rig, Rule::PortNotEnabled);
}

#[test]
fn not_unmasked() {
    let rig = full_speed_rig();
    on_channels(&rig, offset::HCINTMSK, |_| 0);
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::NotUnmasked);
}

#[test]
fn interrupt_ignored() {
    let rig = full_speed_rig();
    // A driver that never clears what the port reports.
    on_register(&rig, offset::HPRT, |value| value & !0x2a);
    rig.latency.set(500);
    root_session(&rig, Speed::Full);
    assert_broken(&rig, Rule::InterruptIgnored);
}

#[test]
fn no_such_channel() {
    // A core with eight channels that a driver takes for one with sixteen.
    let rig = Rig::on(usb_model::dwc2::Build::raspi2b(), Config::new());
    rig.tamper_reads(|_, offset, value| if offset == offset::GHWCFG2 { value | 0xf << 14 } else { value });
    hub_session(&rig);
    assert_broken(&rig, Rule::NoSuchChannel);
}
