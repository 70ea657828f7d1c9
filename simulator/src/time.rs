//! Virtual time. It is counted in clocks of the processor and passes only as instructions run,
//! so a run repeats exactly.
//!
//! **The model's assumption**: an instruction takes one clock. Accesses to registers take the time
//! below on top; caches and SDRAM take none.

/// Clocks of the processor since power-on.
pub type Clocks = u64;

/// The processor's clock, as U-Boot's SPL sets it on the DE1-SoC.
pub const CPU_HERTZ: u64 = 800_000_000;

/// Processor clocks in a clock of PERIPHCLK (200 MHz): SCU, GIC, private and global timers.
pub const PERIPHERAL_CLOCK: Clocks = 4;
/// Processor clocks in a clock of l4_sp (100 MHz): UARTs, SP timers, GPIO.
pub const L4_SP_CLOCK: Clocks = 8;
/// Processor clocks in a clock of OSC1 (25 MHz): L4 watchdogs.
pub const OSC1_CLOCK: Clocks = 32;

/// What a read of a peripheral's register takes: 100 ns.
pub const REGISTER_READ: Clocks = 80;
/// What a posted write takes: 25 ns, the 40 million words a second measured on the bridge.
pub const REGISTER_WRITE: Clocks = 20;
/// What a read through a bridge takes: 0.5 µs, as long as 20 posted writes.
pub const BRIDGE_READ: Clocks = 400;

/// Returns the clocks in so many microseconds.
pub const fn microseconds(count: u64) -> Clocks {
    count * (CPU_HERTZ / 1_000_000)
}

/// Returns the clocks in so many milliseconds.
pub const fn milliseconds(count: u64) -> Clocks {
    microseconds(count * 1000)
}

/// Returns a duration in milliseconds, for a person.
pub fn in_milliseconds(clocks: Clocks) -> f64 {
    clocks as f64 * 1e3 / CPU_HERTZ as f64
}

/// Returns a duration in nanoseconds, rounded down.
pub const fn in_nanoseconds(clocks: Clocks) -> u64 {
    clocks * 1_000 / (CPU_HERTZ / 1_000_000)
}
