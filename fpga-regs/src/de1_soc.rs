//! Where the DE1-SoC's FPGA project (`fpga/`) puts the agents, as the processor sees them.
//!
//! | agent | bridge | address |
//! | --- | --- | --- |
//! | registers | lightweight HPS-to-FPGA | [`REGISTERS`] |
//! | board I/O | lightweight HPS-to-FPGA | [`BOARD_IO`] |
//! | FIFO aperture | HPS-to-FPGA, 32 bits wide | [`FIFO_APERTURE`] |
//!
//! The project is set so that an access to any other address of the two bridges is answered with an
//! error, which is a data abort. The place for a FIFO aperture on the lightweight bridge
//! ([`LIGHTWEIGHT_APERTURE_OFFSET`](crate::screen::LIGHTWEIGHT_APERTURE_OFFSET)) is empty here.

/// Start of the lightweight HPS-to-FPGA bridge (2 MiB).
pub const LIGHTWEIGHT_BRIDGE: usize = 0xFF20_0000;
/// Start of the HPS-to-FPGA bridge (960 MiB).
pub const BRIDGE: usize = 0xC000_0000;

/// The register agent.
pub const REGISTERS: usize = LIGHTWEIGHT_BRIDGE;
/// The board's keys, switches, LEDs and displays.
pub const BOARD_IO: usize = LIGHTWEIGHT_BRIDGE + 0x2000;
/// The FIFO aperture, one KiB of words.
pub const FIFO_APERTURE: usize = BRIDGE;

/// Interrupt of the rasterizer in the processor's GIC: the first that the FPGA has (F2H IRQ 0). Level, active high.
pub const INTERRUPT: u32 = 72;
