//! The verilated device and the software model, given the same words.

use fpga_regs::Port;
use fpga_regs::packet::{Clear, Fence, swap};
use fpga_regs::registers::{Capabilities, Control, Interrupts, Register, Status};
use fpga_regs::screen::{PIXELS, Rgb332, WIDTH};
use raster_model::{Device, Memory};
use rtl_sim::Rtl;

/// Longest that anything a test pushes at once may take.
const PATIENCE: u64 = 20_000_000;

pub struct Pair {
    pub rtl: Rtl,
    pub model: Device<'static>,
}

impl Pair {
    /// Returns both enabled, with the same memories: both buffers and the depth buffer cleared.
    pub fn new(units: u32) -> Self {
        Self::of(Rtl::new(units))
    }

    /// Returns this device, just out of reset, and its model, made likewise.
    pub fn of(mut rtl: Rtl) -> Self {
        let leak = |bytes: usize| vec![0u8; bytes].leak();
        let memory = Memory::new([leak(PIXELS), leak(PIXELS)], vec![0; PIXELS].leak()).expect("of the right sizes");
        let has = Capabilities(rtl.read(Register::Capabilities));
        let fifo = vec![0; has.fifo_depth().into()].leak();
        let model = Device::new(memory, fifo).expect("of the right sizes").with_interrupt(has.interrupt());
        let mut pair = Self { rtl, model };
        pair.write(Register::Control, Control::default().with_enable(true).0);
        for _ in 0..2 {
            pair.push(&Clear { colour: Rgb332(0x1c), depth: 0xffff }.encode());
            pair.push(&swap());
            pair.rtl.rest(PATIENCE);
        }
        pair
    }

    pub fn push(&mut self, words: &[u32]) {
        self.model.push(words);
        self.rtl.push(words);
    }

    pub fn write(&mut self, register: Register, value: u32) {
        self.model.write(register, value);
        self.rtl.write(register, value);
    }

    /// Ends a packet that is under way, then compares all that must be equal.
    pub fn compare(&mut self, what: &str) {
        if let Some(middle) = self.model.mid_packet() {
            let zeros = vec![0; middle.missing];
            self.push(&zeros);
        }
        self.push(&Fence { tag: 0x600d }.encode());
        self.compare_registers(what);
        self.compare_memories(what);
    }

    /// Brings the device to rest and compares every register that has no clock in it.
    pub fn compare_registers(&mut self, what: &str) {
        self.rtl.rest(PATIENCE);
        self.compare_at_rest(what);
    }

    /// Compares registers without waiting for rest.
    pub fn compare_at_rest(&mut self, what: &str) {
        let units = self.rtl.units();
        for register in Register::ALL.iter().copied() {
            let (mut found, mut expected) = (self.rtl.read(register), self.model.read(register));
            match register {
                // The model has one pixel unit.
                Register::Capabilities => expected = expected & !0xff_0000 | units << 16,
                // The model has no clock: `clocks.rs` has those.
                Register::BusyCycles | Register::StalledCycles => continue,
                Register::Interrupts => {
                    let mask = Interrupts::default().with_low_water(true).0;
                    (found, expected) = (found | mask, expected | mask);
                }
                Register::Status => {
                    let mask = Status::default().with_vertical_blank(true).0;
                    (found, expected) = (found | mask, expected | mask);
                }
                _ => {}
            }
            assert_eq!(found, expected, "{register:?} at {units} units, {what}: device (left), model (right)");
        }
    }

    pub fn compare_memories(&mut self, what: &str) {
        let memories = self.rtl.memories();
        let units = self.rtl.units();
        let at = |index: usize| (index % WIDTH as usize, index / WIDTH as usize);
        for (name, found, expected) in
            [("back", memories.back(), self.model.back()), ("front", memories.front(), self.model.front())]
        {
            if let Some(index) = (0..PIXELS).find(|&index| found[index] != expected[index]) {
                let differ = (0..PIXELS).filter(|&index| found[index] != expected[index]).count();
                panic!(
                    "{name} buffer at {units} units, {what}: {differ} pixels differ, the first at {:?}: {:#x}, not {:#x}",
                    at(index),
                    found[index],
                    expected[index]
                );
            }
        }
        let depths = self.model.depth();
        if let Some(index) = (0..PIXELS).find(|&index| memories.depths[index] != depths[index]) {
            panic!(
                "depth at {units} units, {what}: {:#x} at {:?}, not {:#x}",
                memories.depths[index],
                at(index),
                depths[index]
            );
        }
    }
}
