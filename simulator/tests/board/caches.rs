//! Mistakes with caches, which memory with one copy of the data would hide, end the run.

use crate::common::{DSB, Raw, Read, Step, Write, image, mcr, passes, r0, run, stops};
use simulator::PowerOn;

/// A buffer in memory that nobody has touched.
const BUFFER: u32 = 0x0300_0000;
const L2: u32 = 0xFFFE_F000;
const DCCMVAC: [u32; 4] = [0, 7, 10, 1];
const DCIMVAC: [u32; 4] = [0, 7, 6, 1];
const DCCISW: [u32; 4] = [0, 7, 14, 2];
const DCISW: [u32; 4] = [0, 7, 6, 2];
const SCTLR: [u32; 4] = [0, 1, 0, 0];
const ACTLR: [u32; 4] = [0, 1, 0, 1];

const WFE: Step = Raw(0xE320_F002);

/// Cleans (and invalidates) all of L1.
fn all_of_l1(operation: [u32; 4]) -> Vec<Step> {
    let sets_and_ways = (0..256).flat_map(|set| (0..4).map(move |way| way << 30 | set << 5));
    sets_and_ways.flat_map(|set_way: u32| r0(set_way).into_iter().chain([mcr(operation)])).collect()
}

/// Cleans all of L2: the poll after it finds it busy once.
const ALL_OF_L2: [Step; 4] = [Write(L2 + 0x7FC, 0xFF), Read(L2 + 0x7FC), Read(L2 + 0x7FC), Write(L2 + 0x730, 0)];

/// What start-up code owes U-Boot's caches.
fn cleaned() -> Vec<Step> {
    [all_of_l1(DCCISW), vec![DSB], ALL_OF_L2.to_vec()].concat()
}

fn after(mut steps: Vec<Step>, more: &[Step]) -> Vec<Step> {
    steps.extend_from_slice(more);
    steps
}

/// Lets a bus master read or write the buffer once the steps are done.
#[track_caller]
fn dma(steps: &[Step], writes: bool) -> Result<(), String> {
    let mut machine = PowerOn::new(image(steps)).start();
    run(&mut machine).unwrap();
    if writes { machine.dma_write(BUFFER, &[1; 40]) } else { machine.dma_read(BUFFER, 40).map(|_| ()) }
        .map_err(|violation| violation.to_string())
}

#[track_caller]
fn says<T: std::fmt::Debug>(result: Result<T, String>, needed: &str) {
    let message = result.expect_err(needed);
    assert!(message.contains(needed), "{message}");
}

#[test]
fn u_boots_own_dirty_lines_are_cleaned_before_the_caches_go() {
    let caches_off = [r0(0x00C5_0078).to_vec(), vec![mcr(SCTLR), Write(BUFFER, 1)]].concat();
    assert!(stops(&caches_off).needed.contains("L1 may hold this line dirty"));
    let l1_only = after(all_of_l1(DCCISW), &caches_off);
    assert!(stops(&l1_only).needed.contains("L2 may hold this line dirty"));
    let l2_first = after([ALL_OF_L2.to_vec(), all_of_l1(DCCISW)].concat(), &caches_off);
    assert!(stops(&l2_first).needed.contains("L2 may hold this line dirty"), "L1's lines came to L2 later");
    passes(&after(cleaned(), &caches_off));
}

#[test]
fn three_ways_of_four_are_not_a_clean_set() {
    let three = (0..256).flat_map(|set| (0..3).map(move |way| way << 30 | set << 5));
    let three: Vec<Step> = three.flat_map(|at: u32| r0(at).into_iter().chain([mcr(DCCISW)])).collect();
    let steps = [three, ALL_OF_L2.to_vec(), r0(0x00C5_0078).to_vec(), vec![mcr(SCTLR), Write(BUFFER, 1)]].concat();
    assert!(stops(&steps).needed.contains("L1 may hold this line dirty"));
}

#[test]
fn invalidating_dirty_caches_loses_data() {
    assert!(stops(&all_of_l1(DCISW)).needed.contains("set 0 of L1 may hold dirty lines"));
    assert!(stops(&[Write(L2 + 0x77C, 0xFF)]).needed.contains("the L2 cache may hold dirty lines"));
    let again = after(cleaned(), &[Write(BUFFER, 7)]);
    assert!(stops(&after(again, &all_of_l1(DCISW))).needed.contains("set 0 of L1"));
    passes(&after(cleaned(), &all_of_l1(DCISW)));
}

#[test]
fn what_a_bus_master_reads_was_cleaned_out_of_both_levels() {
    let written = after(cleaned(), &[Write(BUFFER, 7), Write(BUFFER + 36, 8)]);
    says(dma(&written, false), "L1 cache may hold newer data");
    let l1 = |line: u32| r0(BUFFER + line).into_iter().chain([mcr(DCCMVAC)]).collect::<Vec<_>>();
    let l1_cleaned = [written, l1(0), l1(32)].concat();
    says(dma(&l1_cleaned, false), "L2 cache may hold newer data");
    let first = after(l1_cleaned.clone(), &[Write(L2 + 0x7B0, BUFFER), DSB]);
    says(dma(&first, false), "DMA read from 0x03000020");
    let both = after(first, &[Write(L2 + 0x7B0, BUFFER + 32), DSB]);
    assert_eq!(dma(&both, false), Ok(()));
    let again = after(both, &[Write(BUFFER + 4, 9)]);
    says(dma(&again, false), "L1 cache may hold newer data");
}

#[test]
fn no_dirty_line_lies_under_what_a_bus_master_writes() {
    says(dma(&after(cleaned(), &[Write(BUFFER, 7)]), true), "write it back over the new data");
    assert_eq!(dma(&cleaned(), true), Ok(()));
}

#[test]
fn what_a_bus_master_wrote_is_invalidated_in_l2_and_then_in_l1() {
    let l1 = r0(BUFFER).into_iter().chain([mcr(DCIMVAC)]).collect::<Vec<_>>();
    let l2 = vec![Write(L2 + 0x770, BUFFER)];
    for (steps, right) in [
        (vec![], false),
        (l1.clone(), false),
        (l2.clone(), false),
        ([l1.clone(), l2.clone()].concat(), false),
        ([l2, l1].concat(), true),
    ] {
        // The transfer takes place while the program waits for an event.
        let program = [cleaned(), vec![WFE], steps, vec![Read(BUFFER)]].concat();
        let mut machine = PowerOn::new(image(&program)).start();
        run(&mut machine).unwrap();
        machine.dma_write(BUFFER, &[0x5A; 32]).unwrap();
        machine.wake();
        match run(&mut machine) {
            Ok(_) => assert!(right && machine.registers().general[2] == 0x5A5A_5A5A),
            Err(violation) => {
                assert!(!right, "{violation}");
                assert!(violation.needed.contains("invalidate L2, then L1"), "{violation}");
            }
        }
    }
}

#[test]
fn a_core_joins_coherency_only_with_the_snoop_control_unit_on() {
    let join = r0(1 << 6).into_iter().chain([mcr(ACTLR)]).collect::<Vec<_>>();
    assert!(stops(&join).needed.contains("snoop control unit"));
    passes(&after(vec![Write(0xFFFE_C000, 1)], &join));
}

#[test]
fn an_l2_that_is_on_keeps_its_configuration() {
    assert!(stops(&[Write(L2 + 0x104, 0)]).needed.contains("while the cache is off"));
    assert!(stops(&[Write(L2 + 0x7FC, 1)]).needed.contains("all eight ways"));
    let impatient = after(all_of_l1(DCCISW), &[Write(L2 + 0x7FC, 0xFF), Write(L2 + 0x730, 0)]);
    assert!(stops(&impatient).needed.contains("poll its register"));
}
