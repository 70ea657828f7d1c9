//! Accesses that would not work on the board end the run, with a report that says what was missing.

use crate::common::{Raw, Read, Step, Write, image, mcr, passes, r0, run, stops};
use simulator::violation::Access;
use simulator::{Event, PowerOn};

const FPGA_REGISTERS: u32 = 0xFF20_0000;
const FIFO: u32 = 0xC000_0000;
const UART0_LSR: u32 = 0xFFC0_2014;
const USB1_ID: u32 = 0xFFB4_0040;
const GPIO1_DATA: u32 = 0xFF70_9000;
const PERMODRST: u32 = 0xFFD0_5014;
const BRGMODRST: u32 = 0xFFD0_501C;
const REMAP: u32 = 0xFF80_0000;
const MAIN_GATES: u32 = 0xFFD0_4060;
const PERIPHERAL_GATES: u32 = 0xFFD0_40A0;
/// PERMODRST as U-Boot leaves it, but for these bits.
const RELEASED_BY_UBOOT: u32 = 1 << 6 | 1 << 8 | 1 << 16 | 1 << 22 | 1 << 29;

const OPEN_BRIDGES: [Step; 2] = [Write(BRGMODRST, 0), Write(REMAP, 0x19)];

fn release(bits: u32) -> Step {
    Write(PERMODRST, 0x3FFF_FFFF & !(RELEASED_BY_UBOOT | bits))
}

#[track_caller]
fn says(violation: &simulator::Violation, address: u32, needed: &str) {
    assert_eq!(violation.address, address, "{violation}");
    assert!(violation.to_string().contains(needed), "{violation}");
}

#[test]
fn a_block_in_reset_is_named_with_its_bit() {
    let violation = stops(&[Read(UART0_LSR), Read(USB1_ID)]);
    says(&violation, USB1_ID, "clear bit 3 of PERMODRST");
    assert_eq!((violation.access, violation.block.as_str()), (Access::Read(4), "USB1"));
    // Three instructions for the first read, two before the second's load.
    assert_eq!(violation.instruction, 0x0100_0014);
    assert!(violation.disassembly == "LDR r2, [r1]", "{violation}");
    passes(&[release(1 << 3), Read(USB1_ID)]);
}

#[test]
fn a_reset_that_is_turned_the_wrong_way_stops() {
    says(&stops(&[Write(GPIO1_DATA, 1 << 24)]), GPIO1_DATA, "clear bit 26 of PERMODRST");
    says(&stops(&[release(1 << 25), Write(GPIO1_DATA, 0)]), GPIO1_DATA, "bit 26");
    passes(&[release(1 << 26), Write(GPIO1_DATA, 1 << 24)]);
    // The console's own.
    says(&stops(&[Write(PERMODRST, 0x3FFF_FFFF), Read(UART0_LSR)]), UART0_LSR, "bit 16");
}

#[test]
fn a_clock_that_is_turned_off_stops() {
    says(&stops(&[Write(MAIN_GATES, 0x3FF & !(1 << 3)), Read(UART0_LSR)]), UART0_LSR, "its clock: Main(3)");
    let usb = [release(1 << 3), Write(PERIPHERAL_GATES, 0xFFF & !(1 << 2)), Read(USB1_ID)];
    says(&stops(&usb), USB1_ID, "its clock: Peripheral(2)");
    passes(&[release(1 << 3), Write(PERIPHERAL_GATES, 1 << 2), Read(USB1_ID)]);
}

#[test]
fn a_bridge_needs_everything() {
    says(&stops(&[Read(FPGA_REGISTERS)]), FPGA_REGISTERS, "L3 remap bit 4");
    says(&stops(&[Write(BRGMODRST, 0), Write(REMAP, 0x09), Read(FPGA_REGISTERS)]), FPGA_REGISTERS, "L3 remap bit 4");
    says(&stops(&[Write(REMAP, 0x19), Read(FPGA_REGISTERS)]), FPGA_REGISTERS, "BRGMODRST bit 1");
    says(&stops(&[Write(BRGMODRST, 0), Write(REMAP, 0x11), Write(FIFO, 0)]), FIFO, "L3 remap bit 3");
    let open = [&OPEN_BRIDGES[..], &[Read(FPGA_REGISTERS)]].concat();
    assert_eq!(passes(&open).registers().general[2], 0x4841_4C46);
    let mut unconfigured = PowerOn::new(image(&open)).unconfigured().start();
    says(&run(&mut unconfigured).unwrap_err(), FPGA_REGISTERS, "a configured FPGA");
    let nowhere = [&OPEN_BRIDGES[..], &[Read(FPGA_REGISTERS + 0x1000)]].concat();
    says(&stops(&nowhere), FPGA_REGISTERS + 0x1000, "default slave");
}

#[test]
fn what_is_not_modelled_is_said_to_be() {
    says(&stops(&[Read(0xFFC0_3014)]), 0xFFC0_3014, "a model");
    says(&stops(&[Read(0x8000_0000)]), 0x8000_0000, "a block of registers, or memory");
    says(&stops(&[Read(0xFFC0_2090)]), 0xFFC0_2090, "no register is modelled at offset 0x90");
    says(&stops(&[Read(REMAP)]), REMAP, "write only");
    // ldrb r2, [r1]: the last address loaded is the UART's.
    let byte = [Read(UART0_LSR), Step::Raw(0xE5D1_2000)];
    says(&stops(&byte), UART0_LSR, "a 32-bit access");
}

#[test]
fn an_exception_into_u_boot_is_not_run() {
    // A permanently undefined instruction.
    let violation = stops(&[Step::Raw(0xE7F0_00F0)]);
    assert_eq!((violation.access, violation.address), (Access::Fetch, 0x3F00_0004));
    assert!(violation.needed.contains("VBAR"), "{violation}");
}

#[test]
fn a_bridge_that_hangs_ends_by_the_watchdog() {
    use simulator::devices::ResetCause;
    const L4_WATCHDOG: u32 = 0xFFD0_2000;
    let steps = [&OPEN_BRIDGES[..], &[Write(L4_WATCHDOG + 4, 0), Write(L4_WATCHDOG, 1), Read(FPGA_REGISTERS)]].concat();
    let mut machine = PowerOn::new(image(&steps)).start();
    machine.hardware(|hardware| hardware.fpga.faults.hangs = true);
    let event = machine.run(simulator::time::milliseconds(10)).unwrap();
    assert_eq!(event, Event::Reset(ResetCause::L4Watchdog(0)));
    // 2^16 clocks of 25 MHz.
    assert!((2.62..2.64).contains(&simulator::time::in_milliseconds(machine.now())));
    let status = machine.hardware(|hardware| hardware.resets.read(0)).unwrap();
    assert_eq!(status, 1 << 14 | 1, "the watchdog's bit beside power-on's, which nobody cleared");
}

#[test]
fn an_exclusive_access_without_the_mmu_stops() {
    const SCTLR: [u32; 4] = [0, 1, 0, 0];
    // ldrex r0, [r1]
    let exclusive = Raw(0xE191_0F9F);
    passes(&[Read(0x0200_0000), exclusive]);
    let off = [r0(0x00C5_0878).as_slice(), &[mcr(SCTLR), Raw(0xF57F_F06F), exclusive]].concat();
    let violation = stops(&[[Read(0x0200_0000)].as_slice(), &off].concat());
    assert!(violation.to_string().contains("the MMU on"), "{violation}");
}
