//! The program's life.

use fpga_regs::{Renderer, Timeouts};
use static_cell::ConstStaticCell;

use super::board::Board;
use super::bridge_port::BridgePort;
use super::fpga_manager::FpgaManager;
use super::interrupt_wait::InterruptWait;
use super::memory_map::FPGA_MANAGER;
use super::viewer::ViewerBoard;
use crate::app::{Application, Memory, Prepared};
use crate::armv7a::exceptions::park;
use crate::mmio::Registers;

/// Runs for ever: sets the board up, waits for the FPGA, draws frames, and waits again when the FPGA goes.
///
/// The watchdog resets the board when a round of the loop takes more than 2.7 s.
///
/// # Panics
/// When `memory` is taken already.
pub fn run(memory: &'static ConstStaticCell<Memory>) -> ! {
    let Some(drivers) = Board::take() else { park() };
    // Not before the MMU is on: the cell is taken by LDREX and STREX.
    let memory = memory.take();
    let clock = drivers.clock;
    let mut board = ViewerBoard::new(drivers);
    board.tell_start();
    board.configure_if_asked();
    board.hold_if_asked();
    // A large mesh file takes seconds to check: before the watchdog runs.
    let prepared = match Prepared::new(&mut board, memory) {
        Ok(prepared) => prepared,
        Err(error) => panic!("{error}"),
    };
    let renderer = board.connect(|| {
        // SAFETY: `connect` has opened the bridges, and the loop below uses the port while they are; the port of
        // an attempt before is dropped. The manager always answers, and this one only reads.
        let port = unsafe { BridgePort::new(FpgaManager::new(Registers::at(FPGA_MANAGER))) };
        Renderer::new(port, InterruptWait::new(clock), Timeouts::default())
    });
    let mut application = Application::new(board, renderer, prepared);
    application.greet();
    loop {
        let (board, renderer) = application.parts();
        if !board.fpga.is_usable() {
            board.disconnect();
            board.connect(|| renderer.restart());
        }
        application.run_once();
        application.board().fpga.advance();
    }
}
