//! What a board may choose.

/// The fastest speed that the root port takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum SpeedLimit {
    /// High speed where the device has it; full- and low-speed devices behind a high-speed hub are
    /// reached by split transactions.
    #[default]
    High,
    /// Full speed, whatever the device could do (HCFG.FSLSSUPP): the port never chirps, a hub comes up at
    /// full speed, and nothing is split.
    Full,
}

/// Run-time choices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct Config {
    /// The fastest speed of the root port.
    pub speed_limit: SpeedLimit,
    /// The ULPI PHY drives an external supply of VBUS (GUSBCFG bit 20); without effect on other PHYs.
    pub external_vbus: bool,
    /// Microseconds after which an interrupt or split channel that has not halted by itself is a
    /// [`ChannelStuck`](crate::Fault::ChannelStuck). The core halts it within two frames.
    pub halt_limit_us: u32,
    /// That limit is not for interrupt endpoints without splits: such a channel runs until its device answers. QEMU's
    /// model does that to a device of the PC's that has nothing to say, and to one that has gone. The wait ends with the
    /// request: one that is dropped has its channel halted 20 ms later, and a channel that does not halt in another
    /// 10 ms is stuck.
    pub patient_interrupts: bool,
}

impl Config {
    /// High speed, VBUS from an external supply: what the DE1-SoC has.
    pub const fn new() -> Self {
        Self { speed_limit: SpeedLimit::High, external_vbus: true, halt_limit_us: 50_000, patient_interrupts: false }
    }

    /// The same with another speed limit.
    #[must_use]
    pub const fn with_speed_limit(mut self, limit: SpeedLimit) -> Self {
        self.speed_limit = limit;
        self
    }

    /// The same with or without an external supply of VBUS.
    #[must_use]
    pub const fn with_external_vbus(mut self, external: bool) -> Self {
        self.external_vbus = external;
        self
    }

    /// The same with another limit for channels that halt by themselves.
    #[must_use]
    pub const fn with_halt_limit_us(mut self, limit: u32) -> Self {
        self.halt_limit_us = limit;
        self
    }

    /// The same with channels of interrupt endpoints that run until the device answers, or without.
    #[must_use]
    pub const fn with_patient_interrupts(mut self, patient: bool) -> Self {
        self.patient_interrupts = patient;
        self
    }
}

impl Default for Config {
    fn default() -> Self {
        Self::new()
    }
}
