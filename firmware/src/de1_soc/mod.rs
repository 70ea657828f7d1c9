//! The DE1-SoC: for now its addresses, and its serial console. The rest of its bring-up (bridges,
//! FPGA, USB, interrupts) is a later step.

pub mod memory_map;
pub mod uart16550;
