//! What the driver costs while a pad and a keyboard are there and nothing else happens: calls, and register accesses.
//!
//! `cargo xtask bench` reads the lines that this prints.

use dwc2_host::SpeedLimit;
use usb_input::Kind;

use super::times::board;
use super::{Whole, port};
use crate::rig::Cost;

/// How long is counted.
const COUNTED_US: u64 = 1_000_000;
/// Where in a frame the polls may come: anywhere, microframe by microframe.
const PHASES: u64 = 8;

/// What a second costs, with the polls so many microframes later than they were, and the transactions in it.
fn second(limit: SpeedLimit, phase: u64) -> (Cost, u64) {
    let (mut whole, _keys) = board(limit, [1, 2]);
    let ready =
        |whole: &Whole| whole.is_attached(port(1), Kind::BootKeyboard) && whole.is_attached(port(2), Kind::DualShock3);
    assert!(whole.run_until(1_500_000, ready), "{:?}", whole.events);
    whole.rig.delay_polls(phase * 125);
    whole.run(100_000);
    let before = std::mem::take(&mut whole.rig.machine().cost);
    assert!(before.frame_reads_most <= 1, "{before:?}");
    let transactions = whole.rig.machine().core.transactions();
    whole.run(COUNTED_US);
    let machine = whole.rig.machine();
    (machine.cost, machine.core.transactions() - transactions)
}

/// Prints a figure, and fails above its bar.
fn hold(name: &str, value: u64, bar: u64) {
    println!("bench: usb.{name} {value} {bar}");
    assert!(value <= bar, "{name}: {value} a second are more than {bar}");
}

/// Where the polls come in the frame matters: a start split goes out in its first half.
#[test]
fn a_second_with_pad_and_keyboard_is_cheap() {
    // The pad is asked every millisecond, the keyboard every ten: each time a start split and a complete split, or an IN.
    for (limit, name, transactions, bars) in [
        (SpeedLimit::High, "split", 2 * 1_095, [5_500, 36_000, 8_500, 46_000]),
        (SpeedLimit::Full, "full_speed", 1_095, [2_200, 13_500, 2_200, 13_500]),
    ] {
        let costs: Vec<(Cost, u64)> = (0..PHASES).map(|phase| second(limit, phase)).collect();
        for (cost, asked) in &costs {
            assert!(*asked >= transactions, "{limit:?}: {asked} transactions");
            assert_eq!(cost.frame_reads_most, 1, "{limit:?}: {cost:?}");
        }
        let services: Vec<u64> = costs.iter().map(|(cost, _)| cost.services).collect();
        let accesses: Vec<u64> = costs.iter().map(|(cost, _)| cost.reads + cost.writes).collect();
        let mean = |values: &[u64]| values.iter().sum::<u64>() / PHASES;
        let most = |values: &[u64]| values.iter().copied().max().unwrap_or(0);
        hold(&format!("{name}_services_per_second"), mean(&services), bars[0]);
        hold(&format!("{name}_accesses_per_second"), mean(&accesses), bars[1]);
        hold(&format!("{name}_services_per_second_at_worst"), most(&services), bars[2]);
        hold(&format!("{name}_accesses_per_second_at_worst"), most(&accesses), bars[3]);
    }
}
