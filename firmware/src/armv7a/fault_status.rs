//! What DFSR and IFSR say, in words (ARM DDI 0406, table B3-23).

/// Why a memory access failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FaultStatus(pub u32);

impl FaultStatus {
    /// Returns the cause.
    #[must_use]
    pub const fn cause(self) -> &'static str {
        match self.code() {
            0b00001 => "alignment fault",
            0b00010 => "debug event",
            0b00011 | 0b00110 => "access flag fault",
            0b00100 => "fault on instruction cache maintenance",
            0b00101 | 0b00111 => "nothing is mapped there",
            0b01000 => "external abort: the bus refused the access",
            0b01001 | 0b01011 => "domain fault",
            0b01100 | 0b01110 => "external abort on a translation table walk",
            0b01101 | 0b01111 => "permission fault: read only, or no code there",
            0b10000 => "TLB conflict",
            0b10100 => "cache lockdown fault",
            0b10110 => "imprecise external abort: the bus refused an earlier access, address unknown",
            0b11000 => "imprecise parity error, address unknown",
            0b11001 => "parity error",
            0b11010 => "coprocessor abort",
            0b11100 | 0b11110 => "parity error on a translation table walk",
            _ => "unknown cause",
        }
    }

    /// Returns whether the access was a write (DFSR alone tells).
    #[must_use]
    pub const fn is_write(self) -> bool {
        self.0 >> 11 & 1 == 1
    }

    /// Returns whether the fault address register names the access: not when it came late.
    #[must_use]
    pub const fn has_address(self) -> bool {
        !matches!(self.code(), 0b10110 | 0b11000)
    }

    /// Bits 3 to 0, with bit 10 above them.
    const fn code(self) -> u32 {
        self.0 & 0xF | (self.0 >> 10 & 1) << 4
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_code_is_split_over_the_word() {
        assert_eq!(FaultStatus(0x0805).cause(), "nothing is mapped there");
        assert!(FaultStatus(0x0805).is_write());
        assert!(!FaultStatus(0x0005).is_write());
        let imprecise = FaultStatus(0x0406);
        assert!(imprecise.cause().starts_with("imprecise external abort"));
        assert!(!imprecise.has_address());
        assert_eq!(FaultStatus(0x0006).cause(), "access flag fault");
        assert_eq!(FaultStatus(0x040F).cause(), "unknown cause");
    }
}
