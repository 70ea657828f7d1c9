//! Small programs in the Cortex-A9's machine code, and a board that runs them.

use simulator::{Event, Image, Machine, PowerOn, Violation, time};

/// Something that a program does.
#[derive(Debug, Clone, Copy)]
pub enum Step {
    /// Writes a word to an address.
    Write(u32, u32),
    /// Reads a word.
    Read(u32),
    /// Any instruction.
    Raw(u32),
}

pub use Step::{Raw, Read, Write};

/// DSB.
pub const DSB: Step = Raw(0xF57F_F04F);
/// The handler of interrupts, and what every program ends with: `wfi; b .-4`.
const SLEEP: [u32; 2] = [0xE320_F003, 0xEAFF_FFFD];

/// `movw` and `movt`: loads a register with any number.
fn load(register: u32, value: u32) -> [u32; 2] {
    let half = |opcode: u32, half: u32| opcode | (half >> 12) << 16 | register << 12 | half & 0xFFF;
    [half(0xE300_0000, value & 0xFFFF), half(0xE340_0000, value >> 16)]
}

/// `mcr` or `mrc p15, opc1, r0, crn, crm, opc2`.
const fn coprocessor(base: u32, [opc1, crn, crm, opc2]: [u32; 4]) -> u32 {
    base | opc1 << 21 | crn << 16 | opc2 << 5 | crm
}

/// Writes r0 to a register of the system control coprocessor.
pub const fn mcr(name: [u32; 4]) -> Step {
    Raw(coprocessor(0xEE00_0F10, name))
}

/// Loads r0.
pub fn r0(value: u32) -> [Step; 2] {
    load(0, value).map(Raw)
}

/// Returns an image that does the steps and then sleeps.
pub fn image(steps: &[Step]) -> Image {
    let mut words = Vec::new();
    for step in steps {
        match *step {
            Write(address, value) => {
                words.extend(load(1, address));
                words.extend(load(0, value));
                // str r0, [r1]
                words.push(0xE581_0000);
            }
            Read(address) => {
                words.extend(load(1, address));
                // ldr r2, [r1]
                words.push(0xE591_2000);
            }
            Raw(word) => words.push(word),
        }
    }
    words.extend(SLEEP);
    Image::from_binary(words.iter().flat_map(|word| word.to_le_bytes()).collect())
}

/// Runs a machine for a millisecond.
pub fn run(machine: &mut Machine) -> Result<Event, Violation> {
    machine.run(time::milliseconds(1))
}

/// Runs steps on a board and returns the machine; they must be right.
pub fn passes(steps: &[Step]) -> Machine {
    let mut machine = PowerOn::new(image(steps)).start();
    match run(&mut machine) {
        Ok(Event::Limit) => machine,
        other => panic!("{other:?}"),
    }
}

/// Runs steps on a board, and returns why it stopped them.
pub fn stops(steps: &[Step]) -> Violation {
    let mut machine = PowerOn::new(image(steps)).start();
    run(&mut machine).expect_err("the simulator stops the run")
}
