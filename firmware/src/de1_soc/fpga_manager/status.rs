//! What the FPGA manager says of the FPGA.

use core::fmt;

use fpga_regs::error::NotConfigured;

/// What the FPGA does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// It has no power.
    Off,
    /// It is in reset.
    Reset,
    /// It waits for its image, or takes it in.
    Configuration,
    /// It has its image and starts.
    Initialisation,
    /// Its design runs.
    User,
    /// Something that the manager has no name for.
    Unknown,
}

/// The position of the MSEL switch (SW10, on the board's underside): who configures the FPGA, and how.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Switch(pub u8);

/// What [`Switch`] says of a configuration by the processor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Scheme {
    /// CTRL.CFGWDTH: 32 bits at a time, not 16.
    pub(super) wide: bool,
    /// CTRL.CDRATIO: log2 of the clocks for a word.
    pub(super) clock_ratio: u32,
}

impl Switch {
    /// Returns how the processor configures the FPGA with the switch like this; `None` when it may not.
    ///
    /// (Intel's HPS manual 683126, §5; the table of Linux's and U-Boot's `socfpga` drivers.)
    pub(super) const fn scheme(self) -> Option<Scheme> {
        // Bit 2 chooses the power-on delay; slow and fast are alike here.
        let (wide, clock_ratio) = match self.0 & !0b00100 {
            0b00000 => (false, 0),
            0b00001 => (false, 1),
            0b00010 => (false, 2),
            0b01000 => (true, 0),
            0b01001 => (true, 2),
            0b01010 => (true, 3),
            _ => return None,
        };
        Some(Scheme { wide, clock_ratio })
    }

    /// Returns whether the processor may configure the FPGA.
    #[must_use]
    pub const fn lets_processor(self) -> bool {
        self.scheme().is_some()
    }
}

impl fmt::Display for Switch {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "MSEL {:05b}", self.0)
    }
}

/// What the FPGA manager says of the FPGA.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Status {
    /// The mode field of STAT, 0…7.
    number: u8,
    /// The MSEL switch, as it was when the FPGA had power.
    pub switch: Switch,
    /// The design runs, by its own pin.
    pub init_done: bool,
}

impl Status {
    pub(super) const fn new(word: u32, init_done: bool) -> Self {
        Self { number: (word & 0b111) as u8, switch: Switch((word >> 3 & 0b1_1111) as u8), init_done }
    }

    /// Returns what the FPGA does.
    #[must_use]
    pub const fn mode(self) -> Mode {
        match self.number {
            0 => Mode::Off,
            1 => Mode::Reset,
            2 => Mode::Configuration,
            3 => Mode::Initialisation,
            4 => Mode::User,
            _ => Mode::Unknown,
        }
    }

    /// Returns whether a bridge to the FPGA may be opened and used.
    ///
    /// # Errors
    /// [`NotConfigured`] when it may not.
    pub const fn check(self) -> Result<(), NotConfigured> {
        match self.mode() {
            Mode::User if self.init_done => Ok(()),
            _ => Err(NotConfigured { mode: self.number }),
        }
    }
}

/// For a person: the mode, and what to do when the FPGA does not run.
impl fmt::Display for Status {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = match self.mode() {
            Mode::Off => "off",
            Mode::Reset => "reset",
            Mode::Configuration => "waits for its image",
            Mode::Initialisation => "starting",
            Mode::User if self.init_done => return write!(out, "FPGA configured ({})", self.switch),
            Mode::User => "user mode, but INIT_DONE is 0",
            Mode::Unknown => "unknown",
        };
        write!(out, "FPGA not configured (FPGA manager mode {:#x}, {name}; {}): ", self.number, self.switch)?;
        if self.switch.lets_processor() {
            out.write_str("load halfspace.rbf from U-Boot or halfspace.sof over JTAG, see README §Flash")
        } else {
            out.write_str(
                "load halfspace.sof over JTAG, or set switch SW10 to MSEL 01010 for U-Boot, see README §Flash",
            )
        }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::string::ToString;

    #[test]
    fn only_user_mode_with_init_done_is_configured() {
        for mode in 0..8 {
            for init_done in [false, true] {
                let status = Status::new(mode | 0b01010 << 3, init_done);
                let wanted = if mode == 4 && init_done { Ok(()) } else { Err(NotConfigured { mode: mode as u8 }) };
                assert_eq!(status.check(), wanted);
            }
        }
    }

    #[test]
    fn the_remedy_depends_on_the_switch() {
        let factory = Status::new(2 | 0b10010 << 3, false).to_string();
        assert!(factory.starts_with("FPGA not configured (FPGA manager mode 0x2, waits for its image; MSEL 10010): "));
        assert!(factory.contains("set switch SW10 to MSEL 01010"), "{factory}");
        let passive = Status::new(1 | 0b01010 << 3, false).to_string();
        assert!(passive.contains("halfspace.rbf from U-Boot"), "{passive}");
        assert_eq!(Status::new(4 | 0b01010 << 3, true).to_string(), "FPGA configured (MSEL 01010)");
    }

    /// The twelve positions of Intel's table, fast and slow, and no other.
    #[test]
    fn twelve_switch_positions_let_the_processor_configure() {
        let found: std::vec::Vec<u8> = (0..32).filter(|msel| Switch(*msel).lets_processor()).collect();
        assert_eq!(found, [0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14]);
        assert_eq!(Switch(0b01010).scheme(), Some(Scheme { wide: true, clock_ratio: 3 }));
        assert_eq!(Switch(0b00101).scheme(), Some(Scheme { wide: false, clock_ratio: 1 }));
    }
}
