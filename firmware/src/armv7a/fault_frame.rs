//! The registers of a program that a fault stopped.

use core::fmt;

/// The registers, in the order in which the entries of the fault handlers store them.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FaultFrame {
    /// r0 to r12.
    pub registers: [u32; 13],
    /// The stack pointer.
    pub sp: u32,
    /// The link register.
    pub lr: u32,
    /// Where it happened.
    pub pc: u32,
    /// The status register.
    pub cpsr: u32,
}

impl FaultFrame {
    /// Returns where an undefined instruction stands: the processor names the one behind it, which is four bytes on in
    /// ARM code and two in Thumb (ARM DDI 0406, §B1.8.3); the entry takes four off.
    pub fn undefined_instruction(&self) -> u32 {
        const THUMB: u32 = 1 << 5;
        self.pc.wrapping_add(if self.cpsr & THUMB == 0 { 0 } else { 2 })
    }
}

const _: () = assert!(size_of::<FaultFrame>() == 17 * 4);

/// Four registers a line, each line ended.
impl fmt::Display for FaultFrame {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names = ["r0", "r1", "r2", "r3", "r4", "r5", "r6", "r7", "r8", "r9", "r10", "r11", "r12"];
        let named = names.into_iter().zip(self.registers);
        let rest = [("sp", self.sp), ("lr", self.lr), ("cpsr", self.cpsr)];
        for (index, (name, value)) in named.chain(rest).enumerate() {
            let end = if index % 4 == 3 { "\n" } else { "" };
            write!(out, "  {name:<5}{value:08x}{end}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::string::ToString;

    #[test]
    fn an_undefined_instruction_is_found_in_arm_and_thumb_code() {
        let of = |cpsr| FaultFrame { registers: [0; 13], sp: 0, lr: 0, pc: 0x0100_0ffc, cpsr }.undefined_instruction();
        assert_eq!((of(0x6000_001F), of(0x6000_003F)), (0x0100_0ffc, 0x0100_0ffe));
    }

    #[test]
    fn a_frame_is_printed_four_registers_a_line() {
        let registers = core::array::from_fn(|index| index as u32 * 0x1111_1111);
        let frame = FaultFrame { registers, sp: 0x0680_0000, lr: 0x0100_1234, pc: 0, cpsr: 0x6000_001F };
        let text = frame.to_string();
        assert_eq!(
            text,
            "  r0   00000000  r1   11111111  r2   22222222  r3   33333333\n  \
             r4   44444444  r5   55555555  r6   66666666  r7   77777777\n  \
             r8   88888888  r9   99999999  r10  aaaaaaaa  r11  bbbbbbbb\n  \
             r12  cccccccc  sp   06800000  lr   01001234  cpsr 6000001f\n"
        );
    }
}
