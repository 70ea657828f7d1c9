//! The build that differs in all that may differ: a FIFO of 64 words, no interrupt line, and flip-flops and memories
//! that begin anyhow. What reset forgets to set would show here alone.

mod common;

use common::pair::Pair;
use common::random::Random;
use common::stream::random_stream;
use fpga_regs::Port;
use fpga_regs::registers::{Capabilities, Register, Status};
use rtl_sim::{Frame, Rtl};

/// Power-on states that are looked at: a flip-flop would begin alike in all of them once in two billion times.
const POWER_ONS: u32 = 32;
const SEEDS: [u32; 3] = [1, 2, 3];
/// For each seed.
const TRIANGLES: u32 = 1000;

#[test]
fn it_comes_out_of_reset_at_rest_whatever_the_power_on_state() {
    let depth = Rtl::SCRAMBLED_FIFO_DEPTH as u16;
    let mut memories = Vec::new();
    for seed in 0..POWER_ONS {
        let mut rtl = Rtl::scrambled(seed);
        for register in Register::ALL.iter().copied() {
            if let Some(reset) = register.info().reset {
                assert_eq!(rtl.read(register), reset, "{register:?}, seed {seed}");
            }
        }
        let expected = Capabilities::default().with_fifo_depth(depth).with_pixel_units(2).with_interrupt(false);
        assert_eq!(rtl.read(Register::Capabilities), expected.0);
        assert_eq!(rtl.read(Register::Status), Status::default().with_fifo_free(depth).0);
        assert!(!rtl.irq());
        memories.push(rtl.memories().depths);
    }
    // The seeds do something: else this file would show nothing.
    assert!(memories[0] != memories[1] && memories[1] != memories[2], "all seeds begin with the same memories");
    assert!(memories.iter().all(|depths| depths.iter().any(|depth| *depth != 0)), "memories begin with zeros");
}

#[test]
fn its_sync_pulses_have_the_timing_of_640_by_480() {
    Frame::take(&mut Rtl::scrambled(4), |_| ()).expect("the timing is right");
}

#[test]
fn random_streams_equal_the_model() {
    for seed in SEEDS {
        random_stream(&mut Pair::of(Rtl::scrambled(seed)), TRIANGLES, &mut Random::new(seed.into()));
    }
}
