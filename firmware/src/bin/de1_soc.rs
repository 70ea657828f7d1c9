//! The DE1-SoC's image. So far it starts the processor and says so.
#![no_std]
#![no_main]

use core::fmt::Write;
use cortex_a_rt::entry;
use firmware::armv7a::exceptions::{Hooks, park};
use firmware::cortex_a9::start;
use firmware::de1_soc::memory_map::{CLUSTER, CONSOLE, TRANSLATION_TABLE};
use firmware::de1_soc::uart16550::Transmitter;

#[entry]
fn main() -> ! {
    write("\nHalfspace on the DE1-SoC: starting MMU and caches\n");
    let hooks = Hooks { write, stop: || park() };
    // SAFETY: the first call, on the core that comes from `_start`; the map is this board's.
    let report = unsafe { start::bring_up(&CLUSTER, &TRANSLATION_TABLE, hooks) };
    write("MMU and L1 caches are on\n");
    if report.l2.is_err() {
        write("the L2 cache is off: its maintenance did not end\n");
    }
    write("the board's bring-up (FPGA, USB, interrupts) is a later step; parked here\n");
    park()
}

/// Writes to the console. A console that is stuck loses the text: there is no other.
fn write(text: &str) {
    // SAFETY: U-Boot set UART0 up, and only this function drives it.
    let mut console = unsafe { Transmitter::at(CONSOLE) };
    let _ = console.write_str(text);
}
