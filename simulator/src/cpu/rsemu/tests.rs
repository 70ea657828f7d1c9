//! The same instructions by the library and quickly: registers, flags, memory and time are the same after.

use std::sync::atomic::Ordering::Relaxed;

use rsemu::cpu::arm::aprofile::Regs;

use super::*;
use crate::devices::Hardware;
use crate::devices::fpga_manager::FpgaManager;
use crate::fpga::faulty::Faulty;
use crate::fpga::model::Model;
use crate::memory::Memory;

const TABLE: u32 = 0x3FFF_0000;
/// A section of write-back memory, for all.
const WRITE_BACK: u32 = 0xC0E;
/// Where the program sees its code and data, and where they are.
const CODE: u32 = 0x1010_0000;
const DATA: u32 = 0x1000_8000;
const MOVED: u32 = 0x1000_0000;
/// Bytes of data that are compared, around [`DATA`].
const WINDOW: u32 = 0x4000;
/// Instructions of each kind.
const SAMPLES: usize = 2_000;
/// Of the samples of a kind, one in so many runs quickly at least; the others have a condition that fails,
/// too, or are unpredictable.
const QUICK_SHARE: usize = 40;

/// A kind of instruction: its name, the bits that make it one, and their values.
type Kind = (&'static str, u32, u32);
const KINDS: &[Kind] = &[
    ("data, register", 0x0E00_0010, 0x0000_0000),
    ("data, shifted by register", 0x0E00_0090, 0x0000_0010),
    ("data, constant", 0x0E00_0000, 0x0200_0000),
    ("MOVW, MOVT", 0x0FB0_0000, 0x0300_0000),
    ("hints", 0x0FFF_FFFE, 0x0320_F000),
    ("multiplications", 0x0F00_00F0, 0x0000_0090),
    ("SMUL by halves", 0x0FE0_F090, 0x0160_0080),
    ("BX, BLX", 0x0FFF_FFD0, 0x012F_FF10),
    ("CLZ", 0x0FFF_0FF0, 0x016F_0F10),
    ("media", 0x0E00_0010, 0x0600_0010),
    ("extensions", 0x0F80_03F0, 0x0680_0070),
    ("REV, REV16", 0x0FFF_0F70, 0x06BF_0F30),
    ("RBIT", 0x0FFF_0FF0, 0x06FF_0F30),
    ("UBFX, SBFX", 0x0FA0_0070, 0x07A0_0050),
    ("BFI, BFC", 0x0FE0_0070, 0x07C0_0010),
    ("SMMUL, SMMLA", 0x0FF0_00D0, 0x0750_0010),
    ("PKHBT, PKHTB", 0x0FF0_0030, 0x0680_0010),
    ("LDR, STR by constant", 0x0E00_0000, 0x0400_0000),
    ("LDR, STR by register", 0x0E00_0010, 0x0600_0000),
    ("LDRH, STRH and so on by register", 0x0E40_0F90, 0x0000_0090),
    ("LDRH, STRH and so on by constant", 0x0E40_0090, 0x0040_0090),
    ("LDM, STM", 0x0E00_0000, 0x0800_0000),
    ("LDM, STM of few", 0x0E00_F0F0, 0x0800_0000),
    ("B, BL", 0x0E00_0000, 0x0A00_0000),
];
/// Kinds of Thumb code. What has both halves of the word in its mask is long, with its first half on top.
const THUMB: &[Kind] = &[
    ("shifts, sums", 0xE000, 0x0000),
    ("sums of three", 0xFC00, 0x1800),
    ("constants", 0xE000, 0x2000),
    ("two registers", 0xFC00, 0x4000),
    ("high registers", 0xFC00, 0x4400),
    ("LDR of a constant", 0xF800, 0x4800),
    ("LDR, STR by register", 0xF000, 0x5000),
    ("LDR, STR by constant", 0xE000, 0x6000),
    ("LDRH, STRH by constant", 0xF000, 0x8000),
    ("LDR, STR on the stack", 0xF000, 0x9000),
    ("addresses", 0xF000, 0xA000),
    ("stack and extensions", 0xFF00, 0xB000),
    ("extensions", 0xFF00, 0xB200),
    ("comparing branches", 0xF500, 0xB100),
    ("LDM, PUSH", 0xFE00, 0xB400),
    ("LDM, POP", 0xFE00, 0xBC00),
    ("LDM, STM", 0xF000, 0xC000),
    ("reversals", 0xFF00, 0xBA00),
    ("IT", 0xFF00, 0xBF00),
    ("hints", 0xFFEF, 0xBF00),
    ("branches by condition", 0xF000, 0xD000),
    ("branches", 0xF800, 0xE000),
    ("LDM, STM, long", 0xFE50_2000, 0xE810_0000),
    ("LDRD, STRD", 0xFE40_0000, 0xE840_0000),
    ("LDR by table", 0xFFF0_FFE0, 0xE8D0_F000),
    ("data, register", 0xFE00_8000, 0xEA00_0000),
    ("data, constant", 0xFA00_8000, 0xF000_0000),
    ("data, plain constant", 0xFA00_8000, 0xF200_0000),
    ("branches, long", 0xF800_8000, 0xF000_8000),
    ("LDR, STR by constant, long", 0xFF80_0000, 0xF880_0000),
    ("LDR, STR by register, long", 0xFF80_0FC0, 0xF800_0000),
    ("LDR, STR with an index", 0xFF80_0800, 0xF800_0800),
    ("LDRSB, LDRSH", 0xFE80_0000, 0xF880_0000),
    ("shifts by register, extensions", 0xFF80_F080, 0xFA00_F000),
    ("extensions, long", 0xFF80_F0C0, 0xFA00_F080),
    ("reversals, CLZ", 0xFFC0_F0C0, 0xFA80_F080),
    ("multiplications", 0xFF80_00C0, 0xFB00_0000),
    ("multiplications, long", 0xFF80_0000, 0xFB80_0000),
    ("barriers", 0xFFFF_FFE0, 0xF3BF_8F40),
];
/// Conditions of a block, in CPSR: of two instructions, the first if equal, the other if not; of one, if carry is set.
const BLOCKS: [u32; 3] = [0, 0x0000_0C00, 0x0000_2800];

/// Kinds that access memory, which shall mostly be where it is compared.
const TRANSFERS: &[&str] = &["LDR", "LDM"];
const BARRIERS: &[u32] = &[0xF57F_F04F, 0xF57F_F05A, 0xF5D1_F000, 0xF551_F020, 0xF7D2_F003];

/// A sequence of numbers that look random.
struct Random {
    state: u64,
    /// Numbers that are no address are below this.
    wild: u32,
}

impl Random {
    fn next(&mut self) -> u32 {
        self.state ^= self.state << 13;
        self.state ^= self.state >> 7;
        self.state ^= self.state << 17;
        (self.state.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 32) as u32
    }

    fn one_in(&mut self, count: u32) -> bool {
        self.next().is_multiple_of(count)
    }

    /// Returns what a register may hold: an address, something small, anything.
    fn value(&mut self) -> u32 {
        match self.next() % 8 {
            0..4 => DATA + 8 * (self.next() % 0x100) - 0x400,
            4 => DATA + self.next() % 0x100,
            5 => self.next() % 64 * 4,
            6 => [0, 1, u32::MAX, 1 << 31, i32::MAX as u32, 0xFFFF, 31, 32, 33, 255][self.next() as usize % 10],
            _ => self.next() % self.wild,
        }
    }

    fn registers(&mut self, before: Regs) -> Regs {
        let mut registers = before;
        registers.r = std::array::from_fn(|_| self.value());
        registers.r[15] = CODE;
        registers.cpsr = before.cpsr & 0x0FFF_FFFF | self.next() & 0xF000_0000;
        registers
    }
}

/// A core, its MMU on, with a piece of memory that the program sees elsewhere.
fn core() -> Interpreter {
    let manager = FpgaManager::new(true, 0b01010);
    let bus = Arc::new(Bus::new(Hardware::as_uboot_leaves_it(Faulty::new(Box::new(Model::default())), manager)));
    bus.caches.flush_loader();
    for section in 0..4096 {
        let moved = if section >> 8 == DATA >> 28 { MOVED } else { 0 };
        bus.sdram().set_word(TABLE + 4 * section, (section << 20) + moved + WRITE_BACK);
    }
    let start = Start {
        entry: CODE,
        stack: DATA,
        translation_table: TABLE,
        vectors: 0x3F00_0000,
        cached: true,
        arguments: [0; 2],
    };
    let mut core = Interpreter::new(bus);
    core.start(&start);
    core
}

/// Returns the addresses of the data, where they are.
fn window() -> impl Iterator<Item = u32> {
    (DATA + MOVED - WINDOW / 2..DATA + MOVED + WINDOW / 2).step_by(4)
}

/// Returns what is at an address before.
fn pattern(address: u32) -> u32 {
    address.wrapping_mul(0x9E37_79B1)
}

/// What an instruction left behind.
#[derive(PartialEq, Eq)]
struct After {
    registers: Regs,
    data: Vec<u32>,
    time: u64,
}

/// Puts an instruction and its data into memory, and registers into the core.
fn prepare(core: &Interpreter, word: u32, registers: Regs) {
    let long = registers.is_thumb() && word >> 16 != 0;
    let word = if long { word.rotate_left(16) } else { word };
    let memory: &Memory = core.bus.sdram();
    memory.set_word(CODE + MOVED, word);
    // A store that went astray may have been to it.
    memory.line(CODE + MOVED).store(0, Relaxed);
    for address in window() {
        memory.set_word(address, pattern(address));
    }
    core.arm.set_regs(registers);
    core.bus.set_now(0);
    core.bus.set_deadline(1);
}

fn after(core: &Interpreter) -> After {
    let data = window().map(|address| core.bus.sdram().word(address)).collect();
    After { registers: core.arm.regs(), data, time: core.bus.now() }
}

/// Runs random instructions of a kind; returns how many ran quickly and their conditions held.
fn compare_kind(core: &mut Interpreter, random: &mut Random, kind: Kind, before: Regs, thumb: bool) -> usize {
    let (name, mask, value) = kind;
    random.wild = if TRANSFERS.iter().any(|transfer| name.starts_with(transfer)) { 64 } else { u32::MAX };
    let mut quick = 0;
    for _ in 0..SAMPLES {
        let mut registers = random.registers(before);
        let condition = if random.one_in(4) { random.next() % 15 } else { 14 };
        let mut word = random.next() & !mask | value;
        let mut always = true;
        if thumb {
            // Hints are no IT, and the library would sleep by some.
            word |= u32::from(mask == 0xFF00 && value == 0xBF00 && word & 15 == 0);
            word &= if mask >> 16 == 0 { 0xFFFF } else { u32::MAX };
            registers.cpsr |= psr::T | if random.one_in(3) { BLOCKS[random.next() as usize % BLOCKS.len()] } else { 0 };
        } else {
            word = condition << 28 | word & 0x0FFF_FFFF;
            always = condition == 14;
        }
        // An instruction whose condition fails runs quickly, whatever it is.
        quick += usize::from(compare(core, word, registers) && always);
    }
    quick
}

/// Has the library and then the quick core run an instruction; whether both did.
fn compare(core: &mut Interpreter, word: u32, registers: Regs) -> bool {
    prepare(core, word, registers);
    core.arm.step();
    let time = core.bus.now() + 1;
    core.bus.set_now(time);
    if core.bus.take_violation().is_some() {
        // Somewhere outside of memory.
        return false;
    }
    let library = after(core);
    prepare(core, word, registers);
    let (count, _) = core.quick.run(&core.arm, &core.bus, core.system.as_ref(), false);
    if count == 0 {
        let untouched = core.arm.regs() == registers && core.bus.now() == 0;
        assert!(untouched, "{word:#010x} was begun and handed over");
        return false;
    }
    let quick = after(core);
    let report = |what: &After| format!("{:x?} cpsr {:08x} time {}", what.registers.r, what.registers.cpsr, what.time);
    assert!(
        library == quick,
        "{word:#010x} on {:x?} cpsr {:08x}:\nlibrary {}\nquick   {}\nmemory {}",
        registers.r,
        registers.cpsr,
        report(&library),
        report(&quick),
        if library.data == quick.data { "equal" } else { "differs" }
    );
    true
}

#[test]
fn what_runs_quickly_does_the_same_as_by_the_library() {
    let mut core = core();
    let before = core.arm.regs();
    let mut random = Random { state: 0x1234_5678_9ABC_DEF1, wild: u32::MAX };
    for (kinds, thumb) in [(KINDS, false), (THUMB, true)] {
        for kind in kinds {
            let count = compare_kind(&mut core, &mut random, *kind, before, thumb);
            assert!(count >= SAMPLES / QUICK_SHARE, "of {SAMPLES} {} only {count} ran quickly", kind.0);
        }
    }
    for word in BARRIERS {
        let registers = random.registers(before);
        assert!(compare(&mut core, *word, registers), "{word:#010x}");
    }
}

#[test]
fn what_it_does_not_know_is_the_library_s() {
    let mut core = core();
    let before = core.arm.regs();
    let mut random = Random { state: 7, wild: u32::MAX };
    // MRS, MSR, CPS, SVC, UDF, VADD.F64, LDREX, STREX, WFI, LDM with a status, RFE, MRC, ISB.
    let words = [
        0xE10F_0000,
        0xE121_F000,
        0xF102_0080,
        0xEF00_0000,
        0xE7F0_00F0,
        0xEE31_0B02,
        0xE191_0F9F,
        0xE182_0F91,
        0xE320_F003,
        0xE8D1_8001,
        0xF891_0A00,
        0xEE11_0F10,
        0xF57F_F06F,
    ];
    for word in words {
        let registers = random.registers(before);
        prepare(&core, word, registers);
        let (count, _) = core.quick.run(&core.arm, &core.bus, core.system.as_ref(), false);
        assert_eq!((count, core.arm.regs() == registers), (0, true), "{word:#010x}");
    }
}

#[test]
fn an_interrupt_that_is_not_masked_is_taken_by_the_library() {
    let mut core = core();
    let registers = Regs { cpsr: core.arm.regs().cpsr & !psr::I, ..core.arm.regs() };
    // NOP
    prepare(&core, 0xE320_F000, registers);
    assert_eq!(core.quick.run(&core.arm, &core.bus, core.system.as_ref(), true), (0, false));
    assert_eq!(core.quick.run(&core.arm, &core.bus, core.system.as_ref(), false), (1, true));
}

#[test]
fn code_that_changes_is_taken_apart_again() {
    let mut core = core();
    let registers = Regs { r: [0; 16], ..core.arm.regs() };
    let registers = Regs {
        r: {
            let mut r = registers.r;
            r[15] = CODE;
            r
        },
        ..registers
    };
    for value in [1, 2] {
        // MOV r0, #value
        prepare(&core, 0xE3A0_0000 | value, registers);
        core.quick.run(&core.arm, &core.bus, core.system.as_ref(), false);
        assert_eq!(core.arm.regs().r[0], value);
    }
}

#[test]
fn a_translation_that_changes_is_asked_for_again() {
    let mut core = core();
    let mut registers = core.arm.regs();
    registers.r[1] = DATA;
    registers.r[15] = CODE;
    // LDR r0, [r1]
    let load = |core: &mut Interpreter| {
        prepare(core, 0xE591_0000, registers);
        core.quick.run(&core.arm, &core.bus, core.system.as_ref(), false);
        core.arm.regs().r[0]
    };
    assert_eq!(load(&mut core), pattern(DATA + MOVED));
    core.bus.sdram().set_word(DATA + 2 * MOVED, 42);
    core.bus.sdram().set_word(TABLE + (DATA >> 20) * 4, ((DATA + 2 * MOVED) & !0xF_FFFF) + WRITE_BACK);
    // MCR p15, 0, r0, c8, c7, 0: TLBIALL.
    prepare(&core, 0xEE08_0F17, registers);
    core.arm.step();
    assert_eq!(load(&mut core), 42);
}
