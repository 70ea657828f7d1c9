//! The program's care of the caches: counted, and missed when it is taken away.

use crate::board::{Board, changed};
use simulator::PowerOn;
use simulator::time::milliseconds;

/// NOP.
const NOTHING: u32 = 0xE320_F000;
/// Set and way to clean, or to clean and forget, in L1 (`mcr p15, 0, r, c7, c10, 2` and `c14`): without register and condition.
const CLEANS_L1: [(u32, u32); 2] = [(0x0FFF_0FFF, 0x0E07_0F5A), (0x0FFF_0FFF, 0x0E07_0F5E)];
/// DSB and DMB of any kind.
const BARRIERS: [(u32, u32); 1] = [(0xFFFF_FFE0, 0xF57F_F040)];
/// Long enough for a keyboard to be found.
const TIME: u64 = 2_000;

/// Runs the image without instructions of a kind, a keyboard plugged in; returns why it was stopped.
fn without(instructions: &[(u32, u32)]) -> String {
    let mut taken = 0;
    let image = changed(|word| {
        if !instructions.iter().any(|(mask, value)| word & mask == *value) {
            return word;
        }
        taken += 1;
        NOTHING
    });
    assert!(taken > 0, "the image has no such instruction");
    let mut board = Board::start(PowerOn::new(image));
    board.machine.hardware(|hardware| hardware.usb.plug_keyboard());
    match board.machine.run(milliseconds(TIME)) {
        Err(violation) => violation.to_string(),
        Ok(event) => board.fail(&format!("nothing was missed without them: {event:?}")),
    }
}

#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn caches_are_maintained_at_the_start_and_bus_masters_are_at_work_after_it() {
    let mut board = Board::draws();
    let start = board.machine.cache_counts();
    // Each set and way of L1 once, 256 by 4; L2 by its ways.
    assert!(start.l1_sets >= 1_024 && start.l2_ways >= 1, "{start:?}");
    board.machine.hardware(|hardware| hardware.usb.plug_keyboard());
    board.says(1_500, "usb 1: keyboard");
    let after = board.machine.cache_counts();
    assert!(after.dma_reads > start.dma_reads && after.dma_writes > start.dma_writes, "{start:?}, then {after:?}");
}

#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn the_run_stops_without_the_cleaning_of_l1() {
    let why = without(&CLEANS_L1);
    assert!(why.contains("L1") && why.contains("clean"), "{why}");
}

#[test]
#[ignore = "needs the image: cargo xtask test --only simulator"]
fn the_run_stops_at_a_transfer_without_its_barrier() {
    let why = without(&BARRIERS);
    assert!(why.contains("no barrier followed"), "{why}");
}
