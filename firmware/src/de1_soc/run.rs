//! The program's life.

use fpga_regs::{Renderer, Timeouts};

use super::board::Board;
use super::bridge_port::BridgePort;
use super::fpga_manager::FpgaManager;
use super::interrupt_wait::InterruptWait;
use super::memory_map::FPGA_MANAGER;
use super::viewer::ViewerBoard;
use crate::app::{Application, Memory};
use crate::armv7a::exceptions::park;
use crate::mmio::Registers;

/// Runs for ever: sets the board up, waits for the FPGA, draws frames, and waits again when the FPGA goes.
///
/// The watchdog resets the board when a round of the loop takes more than 2.7 s.
pub fn run(memory: &'static mut Memory) -> ! {
    let Some(drivers) = Board::take() else { park() };
    let clock = drivers.clock;
    let mut board = ViewerBoard::new(drivers);
    board.tell_start();
    board.configure_if_asked();
    board.hold_if_asked();
    let renderer = board.connect(|| {
        // SAFETY: `connect` has opened the bridges, and the loop below uses the port while they are; the port of
        // an attempt before is dropped. The manager always answers, and this one only reads.
        let port = unsafe { BridgePort::new(FpgaManager::new(Registers::at(FPGA_MANAGER))) };
        Renderer::new(port, InterruptWait::new(clock), Timeouts::default())
    });
    let mut application = match Application::new(board, renderer, memory) {
        Ok(application) => application,
        Err(error) => panic!("{error}"),
    };
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
