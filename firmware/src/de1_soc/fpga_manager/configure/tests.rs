extern crate std;

use super::*;
use crate::mmio::mock::{Devices, MockBus};
use std::vec::Vec;

const MANAGER: usize = 0xFF70_6000;
const SINK: usize = 0xFFB9_0000;

/// An FPGA and its manager, as far as the manual tells how they answer. It takes `wanted` words that are not zero.
#[derive(Default)]
struct Fpga {
    mode: u32,
    switch: u32,
    control: u32,
    clocks_done: bool,
    words: Vec<u32>,
    wanted: usize,
    /// A step at which it does nothing any more.
    broken_at: Option<&'static str>,
}

impl Fpga {
    fn works(&self, step: &'static str) -> bool {
        self.broken_at != Some(step)
    }

    fn refuses(&self) -> bool {
        self.words.contains(&0)
    }

    fn complete(&self) -> bool {
        self.words.len() >= self.wanted && !self.refuses()
    }
}

impl Devices for Fpga {
    fn read(&mut self, address: usize) -> u32 {
        match address - MANAGER {
            0x000 => self.switch << 3 | self.mode,
            0x004 => self.control,
            0x00C => u32::from(self.clocks_done),
            0x850 => {
                let status = u32::from(!self.refuses());
                status | u32::from(self.complete()) << 1 | u32::from(self.mode == 4) << 2
            }
            other => panic!("read of {other:#x}"),
        }
    }

    fn write(&mut self, address: usize, value: u32) {
        if address == SINK {
            assert_eq!(self.control & 0x101, 0x101, "words before the way to the FPGA is open");
            assert_eq!(self.mode, 2, "words while the FPGA does not wait for them");
            self.words.push(value);
            return;
        }
        match address - MANAGER {
            0x004 => {
                if value & 0b101 == 0b101 && self.works("reset") {
                    self.mode = 1;
                    self.words.clear();
                } else if value & 1 == 1 && self.control & 0b100 != 0 && self.works("configuration") {
                    self.mode = 2;
                }
                self.control = value;
            }
            0x008 if self.works("clocks") => {
                assert!(self.complete(), "clocks before the image is complete");
                assert!(!self.clocks_done, "DCLKSTAT is cleared before clocks are sent");
                self.clocks_done = true;
                match (self.mode, value) {
                    (2, 4) if self.works("initialisation") => self.mode = 3,
                    (3, 0x5000) if self.works("user") => self.mode = 4,
                    _ => {}
                }
            }
            0x008 => {}
            0x00C => self.clocks_done &= value & 1 == 0,
            0x84C => {}
            other => panic!("write of {value:#x} to {other:#x}"),
        }
    }
}

/// Counts the time that is waited.
#[derive(Default)]
struct Clock(u64);

impl DelayNs for Clock {
    fn delay_ns(&mut self, nanoseconds: u32) {
        self.0 += u64::from(nanoseconds);
    }
}

fn configure(fpga: Fpga, image: &[u32]) -> (Result<(), ConfigureError>, MockBus<Fpga>, u64) {
    let bus = MockBus::new(fpga);
    let mut manager = FpgaManager::new(Registers::on(bus.clone(), MANAGER));
    let mut clock = Clock::default();
    let result = manager.configure(image, &Registers::on(bus.clone(), SINK), &mut clock);
    (result, bus, clock.0 / 1_000)
}

fn blank() -> Fpga {
    Fpga { mode: 2, switch: 0b01010, control: 0x200, wanted: 3, ..Fpga::default() }
}

#[test]
fn an_image_goes_in_and_the_design_runs() {
    let (result, bus, _) = configure(blank(), &[7, 8, 9]);
    assert_eq!(result, Ok(()));
    bus.devices(|fpga| {
        assert_eq!((fpga.mode, fpga.words.as_slice()), (4, &[7, 8, 9][..]));
        assert_eq!(fpga.control, WIDE | 3 << 6, "32 bits, ratio 8, and the processor has let go");
    });
    let controls: Vec<u32> =
        bus.take_writes().into_iter().filter(|(at, _)| *at == MANAGER + 4).map(|write| write.1).collect();
    assert_eq!(controls, [0x2C0, 0x2C1, 0x2C5, 0x2C1, 0x3C1, 0x2C1, 0x2C0]);
}

#[test]
fn a_design_that_runs_is_replaced() {
    let (result, bus, _) = configure(Fpga { mode: 4, ..blank() }, &[1, 2, 3]);
    assert_eq!((result, bus.devices(|fpga| fpga.mode)), (Ok(()), 4));
}

#[test]
fn a_switch_that_forbids_it_is_named_and_nothing_is_written() {
    let (result, bus, _) = configure(Fpga { switch: 0b10010, ..blank() }, &[1, 2, 3]);
    assert_eq!(result, Err(ConfigureError::WrongSwitch { switch: Switch(0b10010) }));
    assert_eq!(bus.take_writes(), []);
}

#[test]
fn every_step_that_fails_has_its_name_and_a_bounded_wait() {
    let stuck = |wanted, found| ConfigureError::ModeStuck { wanted, found };
    for (step, error) in [
        ("reset", stuck(Mode::Reset, Mode::Configuration)),
        ("configuration", stuck(Mode::Configuration, Mode::Reset)),
        ("clocks", ConfigureError::ClockStuck),
        ("initialisation", stuck(Mode::Initialisation, Mode::Configuration)),
        ("user", stuck(Mode::User, Mode::Initialisation)),
    ] {
        let (result, bus, waited_us) = configure(Fpga { broken_at: Some(step), ..blank() }, &[1, 2, 3]);
        assert_eq!(result, Err(error), "{step}");
        assert!(waited_us <= u64::from(STEP_LIMIT_US) + 1_000, "{step}: {waited_us} µs");
        assert_eq!(bus.devices(|fpga| fpga.control) & 0x105, 0, "{step}: the processor has let go");
    }
}

#[test]
fn an_image_of_the_wrong_kind_or_length_is_told_apart() {
    let (result, ..) = configure(blank(), &[1, 0, 3]);
    assert_eq!(result, Err(ConfigureError::Refused { switch: Switch(0b01010) }));
    let (result, ..) = configure(blank(), &[1, 2]);
    assert_eq!(result, Err(ConfigureError::Incomplete { bytes: 8 }));
    let (result, ..) = configure(blank(), &[]);
    assert_eq!(result, Err(ConfigureError::Incomplete { bytes: 0 }));
}
