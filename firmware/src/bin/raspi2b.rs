//! Halfspace on QEMU's raspi2b.
#![no_std]
#![no_main]

use cortex_a_rt::entry;
use firmware::app::Memory;
use firmware::raspi2b::{Board, exit, viewer};
use firmware::software_fpga::ModelMemory;
use static_cell::ConstStaticCell;

static MODEL: ConstStaticCell<ModelMemory> = ConstStaticCell::new(ModelMemory::new());
static MEMORY: ConstStaticCell<Memory> = ConstStaticCell::new(Memory::new());

#[entry]
fn main() -> ! {
    let board = match Board::take() {
        Some(Ok(board)) => board,
        Some(Err(error)) => panic!("{error}"),
        None => exit(1),
    };
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
