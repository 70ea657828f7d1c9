//! The boards.

use std::fmt;

use clap::ValueEnum;

/// A board the firmware runs on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, ValueEnum)]
pub enum Board {
    /// ARM Versatile Express with a Cortex-A9, as QEMU models it
    VexpressA9,
    /// Raspberry Pi 2 with the DE1-SoC's USB controller, as QEMU models it
    Raspi2b,
    /// Terasic DE1-SoC, in its simulator, which runs the image that is flashed
    De1Soc,
}

impl Board {
    /// All boards.
    pub const ALL: [Self; 3] = [Self::VexpressA9, Self::Raspi2b, Self::De1Soc];

    /// Returns whether QEMU has the board; the others have a simulator of their own.
    pub const fn runs_in_qemu(self) -> bool {
        matches!(self, Self::VexpressA9 | Self::Raspi2b)
    }

    /// Returns the board's name: the firmware's feature and binary have the same.
    pub const fn name(self) -> &'static str {
        match self {
            Self::VexpressA9 => "vexpress-a9",
            Self::Raspi2b => "raspi2b",
            Self::De1Soc => "de1-soc",
        }
    }
}

impl fmt::Display for Board {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}
