//! Cores that are broken, or not the right ones: each is named in time, and works once it is mended.

use dwc2_host::{Config, Fault};
use embassy_usb_driver::host::{DeviceEvent, PipeError, UsbHostController, UsbPipe};
use usb_model::dwc2::{Build, Core, Defects};
use usb_model::violation::Log;
use usb_model::wire::Speed;

use crate::gadget::{GIVE, Gadget};
use crate::rig::{Rig, both};
use crate::stack::{enumerate_root, setup};

/// After a fault the driver tries again in a second; to a device that works it takes some 200 ms more.
const AGAIN_US: u64 = 1_500_000;

fn works_soon(rig: &Rig) {
    let session = async {
        let known = enumerate_root(rig, 9).await.unwrap();
        assert_eq!(known.reports(8, 1).request_in(&mut [0; 8]).await, Ok(4));
    };
    rig.run_for(AGAIN_US, session).expect("a device that works again");
}

#[test]
fn a_core_that_does_not_start_is_named_and_tried_again() {
    for (defects, fault, limit) in [
        (Defects { never_idle: true, ..Defects::default() }, Fault::NeverIdle, 12_000),
        (Defects { never_leaves_reset: true, ..Defects::default() }, Fault::ResetStuck, 12_000),
        (Defects { never_host: true, ..Defects::default() }, Fault::NotHost, 115_000),
        (Defects { never_flushes: true, ..Defects::default() }, Fault::FlushStuck, 40_000),
        (Defects { never_enables: true, ..Defects::default() }, Fault::PortNotEnabled, 260_000),
    ] {
        let rig = Rig::new(Config::new());
        rig.machine().core.defects = defects;
        rig.plug(Gadget::counting(Speed::Full));
        assert_eq!(rig.fault_within(limit), Some(fault));
        // It is tried again after a second, and not before.
        assert_eq!(rig.fault_within(990_000), None);
        assert_eq!(rig.fault_within(20_000 + limit), Some(fault));
        rig.machine().core.defects = Defects::default();
        if fault == Fault::ResetStuck || fault == Fault::FlushStuck {
            // What hangs for ever in the core needs the board's reset.
            rig.replace_core(Build::cyclone_v());
            rig.plug(Gadget::counting(Speed::Full));
        }
        works_soon(&rig);
    }
}

#[test]
fn another_core_is_left_alone() {
    for (change, fault) in [
        ((|build: &mut Build| build.id = 0x5533_310a) as fn(&mut Build), Fault::WrongCore { id: 0x5533_310a }),
        (|build| build.id = 0, Fault::WrongCore { id: 0 }),
        (|build| build.id = u32::MAX, Fault::WrongCore { id: u32::MAX }),
        (|build| build.hardware[1] &= !(3 << 3), Fault::NoInternalDma { hardware: 0x208f_fc80 }),
        (|build| build.hardware[2] = 1_000 << 16, Fault::FifoTooSmall { needed: 1_572, present: 1_000 }),
    ] {
        let mut build = Build::cyclone_v();
        change(&mut build);
        let rig = Rig::on(build, Config::new());
        rig.tamper_writes(|_, offset, value| panic!("write of {value:#x} to {offset:#x}"));
        assert_eq!(rig.fault_within(2_000), Some(fault));
        assert!(!fault.to_string().is_empty());
    }
}

#[test]
fn channels_that_never_run_time_out_or_are_named() {
    let rig = Rig::new(Config::new());
    rig.plug(Gadget::counting(Speed::Full));
    rig.run(async {
        let known = enumerate_root(&rig, 5).await.unwrap();
        let mut control = known.control(64);
        // A control transfer has its time-out.
        rig.machine().core.defects.never_runs = true;
        let begun = rig.now();
        let error = control.control_in(&setup(0xc0, GIVE, 0, 0, 20), &mut [0; 20]).await;
        assert_eq!(error, Err(PipeError::Timeout));
        assert!((500_000..505_000).contains(&(rig.now() - begun)));
        // An interrupt endpoint's channel halts every frame, or is broken.
        let begun = rig.now();
        assert_eq!(known.reports(8, 1).request_in(&mut [0; 8]).await, Err(PipeError::Disconnected));
        assert!(rig.now() - begun < 60_000);
        assert_eq!(rig.driver.take_fault(), Some(Fault::ChannelStuck { channel: 0 }));
        rig.machine().core.defects = Defects::default();
        assert_eq!(rig.driver.controller().wait_for_device_event().await, DeviceEvent::Disconnected);
    });
    works_soon(&rig);
}

#[test]
fn a_channel_that_does_not_halt_is_named() {
    let rig = Rig::new(Config::new());
    rig.plug(Gadget::counting(Speed::Full));
    rig.run(async {
        let known = enumerate_root(&rig, 5).await.unwrap();
        let mut control = known.control(64);
        rig.machine().core.defects = Defects { never_runs: true, never_halts: true, ..Defects::default() };
        let begun = rig.now();
        let error = control.control_out(&setup(0x40, 1, 0, 0, 0), &[]).await;
        assert_eq!(error, Err(PipeError::Disconnected));
        // The transfer's 50 ms, and 10 ms to halt.
        assert!((60_000..64_000).contains(&(rig.now() - begun)), "{}", rig.now() - begun);
        assert_eq!(rig.driver.take_fault(), Some(Fault::ChannelStuck { channel: 0 }));
        rig.machine().core.defects = Defects::default();
    });
    works_soon(&rig);
}

/// As QEMU's core keeps one whose device has gone.
#[test]
fn a_patient_channel_ends_with_its_request() {
    let rig = Rig::new(Config::new().with_patient_interrupts(true));
    rig.plug(Gadget::counting(Speed::Full));
    rig.run(async {
        let known = enumerate_root(&rig, 5).await.unwrap();
        let mut reports = known.reports(8, 1);
        rig.machine().core.defects.never_runs = true;
        assert!(rig.run_for(1_000_000, reports.request_in(&mut [0; 8])).is_none());
        assert_eq!(rig.driver.take_fault(), None);
        rig.machine().core.defects = Defects::default();
        // The request was dropped: its channel has 20 ms to come to an end, and 10 ms to halt.
        let begun = rig.now();
        assert_eq!(reports.request_in(&mut [0; 8]).await, Ok(4));
        assert!(rig.now() - begun < 32_000, "{}", rig.now() - begun);
        // One that does not halt then is stuck.
        rig.machine().core.defects = Defects { never_runs: true, never_halts: true, ..Defects::default() };
        assert!(rig.run_for(100_000, reports.request_in(&mut [0; 8])).is_none());
        let begun = rig.now();
        assert!(matches!(rig.fault_within(40_000), Some(Fault::ChannelStuck { .. })));
        assert!(rig.now() - begun < 33_000, "{}", rig.now() - begun);
        rig.machine().core.defects = Defects::default();
    });
    // A core that runs nothing calls the halt of a channel a break of its rules.
    rig.take_rules();
    works_soon(&rig);
}

#[test]
fn a_bus_error_is_named() {
    let rig = Rig::new(Config::new());
    rig.plug(Gadget::counting(Speed::Full));
    rig.run(async {
        let known = enumerate_root(&rig, 5).await.unwrap();
        rig.machine().core.defects.bus_error = true;
        let error = known.control(64).control_in(&setup(0x80, 6, 0x0100, 0, 18), &mut [0; 18]).await;
        assert_eq!(error, Err(PipeError::Disconnected));
        assert_eq!(rig.driver.take_fault(), Some(Fault::DmaError { channel: 0 }));
        rig.machine().core.defects = Defects::default();
    });
    works_soon(&rig);
}

#[test]
fn over_current_turns_the_power_off() {
    let rig = Rig::new(Config::new());
    rig.plug(Gadget::counting(Speed::Full));
    rig.run(async {
        let known = enumerate_root(&rig, 5).await.unwrap();
        let mut reports = known.reports(8, 1);
        let short = async {
            rig.sleep(5_000).await;
            rig.machine().core.set_overcurrent(true);
        };
        let reading = async { while reports.request_in(&mut [0; 8]).await.is_ok() {} };
        both(reading, short).await;
        let mut controller = rig.driver.controller();
        assert_eq!(controller.wait_for_device_event().await, DeviceEvent::Overcurrent);
        assert_eq!(controller.wait_for_device_event().await, DeviceEvent::Disconnected);
        assert_eq!(rig.driver.take_fault(), Some(Fault::OverCurrent));
        assert_eq!(rig.machine().core.port_state(), (false, false));
        rig.machine().core.set_overcurrent(false);
    });
    works_soon(&rig);
}

#[test]
fn dma_memory_that_does_not_do_is_named() {
    use dwc2_host::{Clock, DMA_BYTES, DmaMemory, Dwc2, Registers};

    struct Board(usize, u32, Core);

    impl Registers for Board {
        fn read_register(&mut self, offset: u32) -> u32 {
            self.2.read(offset)
        }

        fn write_register(&mut self, offset: u32, value: u32) {
            panic!("write of {value:#x} to {offset:#x}");
        }
    }

    impl DmaMemory for Board {
        fn length(&self) -> usize {
            self.0
        }

        fn bus_address(&self) -> u32 {
            self.1
        }

        fn copy_in(&mut self, _: usize, _: &[u8]) {}
        fn copy_out(&mut self, _: usize, _: &mut [u8]) {}
        fn clean(&mut self, _: usize, _: usize) {}
        fn invalidate(&mut self, _: usize, _: usize) {}
    }

    impl Clock for Board {
        fn now_us(&self) -> u64 {
            0
        }
    }

    for (length, address) in [(DMA_BYTES - 1, 0x1000), (DMA_BYTES, 0x1020)] {
        let mut board = Board(length, address, Core::new(Build::cyclone_v(), Log::default()));
        let driver = Dwc2::new(&mut board, Config::new());
        driver.poll();
        assert_eq!(driver.take_fault(), Some(Fault::BadDmaMemory { length, address }));
    }
}
