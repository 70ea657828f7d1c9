//! The way to the FPGA: what must hold before a bridge answers, and what lies behind it.

use fpga_regs::de1_soc;
use fpga_regs::screen::FIFO_APERTURE_WORDS;

use super::Answer;
use super::clock_manager::ClockManager;
use super::fpga_manager::FpgaManager;
use super::l3::L3;
use super::map::Block;
use super::reset_manager::ResetManager;
use super::system_manager::SystemManager;

/// An agent in the FPGA.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Agent {
    /// The rasterizer's registers.
    Registers,
    /// The rasterizer's FIFO.
    Fifo,
    /// Keys, switches, lights, displays.
    BoardIo,
}

/// The blocks on which a bridge depends.
pub struct Gates<'a> {
    pub(super) l3: &'a L3,
    pub(super) resets: &'a ResetManager,
    pub(super) system: &'a SystemManager,
    pub(super) clocks: &'a ClockManager,
    pub(super) fpga: &'a FpgaManager,
}

const REGISTERS_BYTES: u32 = 0x1000;
const BOARD_IO_BYTES: u32 = 0x20;

/// Returns the agent at an offset of a bridge, and the offset in it.
///
/// # Errors
/// What keeps the bridge from answering.
pub fn agent(bridge: Block, offset: u32, gates: &Gates<'_>) -> Answer<(Agent, u32)> {
    let (bit, name, remap) = match bridge {
        Block::Bridge => (0, "hps2fpga", 3),
        _ => (1, "lwhps2fpga", 4),
    };
    if !gates.l3.opens(bit) {
        return Err(format!(
            "its window, which L3 remap bit {remap} ({name}) opens: on the board this is a decode error, an external abort"
        ));
    }
    if gates.resets.holds_bridge(bit) {
        return Err(format!("BRGMODRST bit {bit} ({name}) clear: on the board the processor hangs"));
    }
    if !gates.fpga.configured() {
        return Err("a configured FPGA (FPGA manager in user mode): on the board the processor hangs".into());
    }
    if !gates.system.fpga_interfaces() {
        return Err("FPGAINTF.GBL bit 0 of the system manager".into());
    }
    debug_assert!(gates.clocks.runs(super::map::Gate::Main(0)));
    let lightweight = |address: usize| (address - de1_soc::LIGHTWEIGHT_BRIDGE) as u32;
    let agents = match bridge {
        Block::Bridge => &[(Agent::Fifo, 0, 4 * FIFO_APERTURE_WORDS as u32)][..],
        _ => &[
            (Agent::Registers, lightweight(de1_soc::REGISTERS), REGISTERS_BYTES),
            (Agent::BoardIo, lightweight(de1_soc::BOARD_IO), BOARD_IO_BYTES),
        ],
    };
    agents
        .iter()
        .find(|(_, start, bytes)| offset.wrapping_sub(*start) < *bytes)
        .map(|(agent, start, _)| (*agent, offset - start))
        .ok_or_else(|| {
            "an agent at this address: on the board the default slave answers with an error, a data abort".into()
        })
}
