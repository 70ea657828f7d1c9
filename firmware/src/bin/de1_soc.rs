//! Halfspace on the DE1-SoC.
#![no_std]
#![no_main]

use cortex_a_rt::entry;
use firmware::app::Memory;
use firmware::de1_soc;
use static_cell::ConstStaticCell;

static MEMORY: ConstStaticCell<Memory> = ConstStaticCell::new(Memory::new());

#[entry]
fn main() -> ! {
    de1_soc::run(&MEMORY)
}
