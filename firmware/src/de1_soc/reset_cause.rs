//! Why the processor was reset.

use core::fmt;

/// The reset manager's STAT. Several causes may be set: a warm reset adds its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ResetCause(pub u32);

/// Bits and names of the causes (`alt_rstmgr.h`).
const CAUSES: [(u32, &str); 14] = [
    (0, "power-on"),
    (1, "cold reset key or power supply"),
    (2, "cold reset by the FPGA"),
    (3, "cold reset by boundary scan"),
    (4, "cold reset by software"),
    (8, "warm reset key"),
    (9, "warm reset by the FPGA"),
    (10, "warm reset by software"),
    (12, "watchdog of core 0"),
    (13, "watchdog of core 1"),
    (14, "watchdog 0"),
    (15, "watchdog 1"),
    (18, "debug reset by the FPGA"),
    (19, "debug reset by JTAG"),
];

impl ResetCause {
    /// Returns whether a watchdog reset the board.
    #[must_use]
    pub const fn is_watchdog(self) -> bool {
        self.0 >> 12 & 0xF != 0
    }

    /// Returns whether the memory and the system manager's hand-off words were lost with the reset.
    #[must_use]
    pub const fn is_cold(self) -> bool {
        self.0 & 0x1F != 0
    }

    /// Returns whether software asked for a warm reset.
    #[must_use]
    pub const fn is_warm_by_software(self) -> bool {
        self.0 >> 10 & 1 == 1
    }
}

impl fmt::Display for ResetCause {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut separator = "";
        for (bit, name) in CAUSES {
            if self.0 >> bit & 1 == 1 {
                write!(out, "{separator}{name}")?;
                separator = ", ";
            }
        }
        // The program was started a second time, by hand or over JTAG.
        if separator.is_empty() { out.write_str("none since the last start") } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::string::ToString;

    #[test]
    fn causes_have_names() {
        assert_eq!(ResetCause(1).to_string(), "power-on");
        assert_eq!(ResetCause(1 | 1 << 14).to_string(), "power-on, watchdog 0");
        assert_eq!(ResetCause(0).to_string(), "none since the last start");
        // Time-outs of the hand-shakes are no causes.
        assert_eq!(ResetCause(1 << 27).to_string(), "none since the last start");
    }

    #[test]
    fn watchdogs_and_cold_resets_are_told_apart() {
        for bit in 0..32 {
            let cause = ResetCause(1 << bit);
            assert_eq!(cause.is_watchdog(), (12..16).contains(&bit), "bit {bit}");
            assert_eq!(cause.is_cold(), bit < 5, "bit {bit}");
        }
    }
}
