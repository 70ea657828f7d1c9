//! Halfspace on QEMU's vexpress-a9.
#![no_std]
#![no_main]

use cortex_a_rt::entry;
use firmware::app::Memory;
use firmware::software_fpga::ModelMemory;
use firmware::vexpress_a9::{Board, exit, viewer};
use static_cell::ConstStaticCell;

static MODEL: ConstStaticCell<ModelMemory> = ConstStaticCell::new(ModelMemory::new());
static MEMORY: ConstStaticCell<Memory> = ConstStaticCell::new(Memory::new());

#[entry]
fn main() -> ! {
    let Some(board) = Board::take() else { exit(1) };
    defmt::info!("start-up done after {=u64} us", board.clock.microseconds());
    match viewer::application(board, MODEL.take(), MEMORY.take()) {
        Ok(mut application) => {
            application.greet();
            loop {
                application.run_once();
            }
        }
        Err(error) => panic!("{error}"),
    }
}
