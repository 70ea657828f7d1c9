//! How a core was built, and what may be wrong with one.

/// What a core reads as, and what it has.
#[derive(Debug, Clone, Copy)]
pub struct Build {
    /// GSNPSID.
    pub id: u32,
    /// GHWCFG1…4.
    pub hardware: [u32; 4],
    /// GUSBCFG after power-on.
    pub phy: u32,
    /// Bits of GUSBCFG that cannot be written.
    pub phy_fixed: u32,
    /// GRXFSIZ, GNPTXFSIZ and HPTXFSIZ after power-on.
    pub fifos: [u32; 3],
    /// The ID pin says host: how long the core takes to believe it, in microseconds.
    pub id_debounce_us: Option<u64>,
}

impl Build {
    /// The Cyclone V's: 2.93a, 16 channels, 8,064 words, ULPI, ID pin grounded.
    pub fn cyclone_v() -> Self {
        Self {
            id: 0x4f54_293a,
            hardware: [0, 0x208f_fc90, 0x1f80_02e8, 0xfe0f_0020],
            phy: 0x1410,
            phy_fixed: 0x0078,
            fifos: [0x2000, 0x2000_2000, 0x2000_4000],
            id_debounce_us: Some(100_000),
        }
    }

    /// QEMU's raspi2b: 2.94a, 8 channels, 4,096 words, UTMI+.
    pub fn raspi2b() -> Self {
        Self {
            id: 0x4f54_294a,
            hardware: [0, 0x250d_c016, 0x1000_0044, 0],
            phy: 0x1400,
            phy_fixed: 0,
            fifos: [0x400, 0x0400_0000, 0x01f4_0000],
            id_debounce_us: None,
        }
    }

    /// Channels.
    pub fn channels(&self) -> usize {
        (self.hardware[1] >> 14 & 0xf) as usize + 1
    }

    /// Words of FIFO memory.
    pub fn fifo_words(&self) -> u32 {
        self.hardware[2] >> 16
    }
}

/// What is wrong with a core.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Defects {
    /// Channels that are told to halt do not.
    pub never_halts: bool,
    /// Channels take no part in traffic: they run for ever.
    pub never_runs: bool,
    /// The bus master is never idle.
    pub never_idle: bool,
    /// A soft reset never ends.
    pub never_leaves_reset: bool,
    /// The core never becomes a host.
    pub never_host: bool,
    /// A flush never ends.
    pub never_flushes: bool,
    /// The port stays disabled after a reset.
    pub never_enables: bool,
    /// DMA meets a bus error.
    pub bus_error: bool,
}
