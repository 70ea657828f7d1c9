//! Devices that are wrong, each in its own way, on the root port and behind hubs.

use std::env;
use std::ops::Range;
use std::process::{Child, Command, Stdio};
use std::time::Instant;

use dwc2_host::SpeedLimit;

use super::batch::{BATCH, Bench, Outcome};

/// Enumerations of rogues in all.
const ROGUES: u64 = 100_000;
/// Names the rogues of a part: `FROM..TO`.
const RANGE: &str = "ROGUES";
/// Begins the line in which a part says what came of its rogues.
const SUMMARY: &str = "rogues, given up, longest, passed: ";

#[test]
fn a_hundred_thousand_rogues_do_no_harm() {
    let started = Instant::now();
    // Processes of their own, because the driver's critical section is one for all threads of a process.
    let parts = std::thread::available_parallelism().map_or(1, usize::from).clamp(1, 8) as u64;
    let children: Vec<Child> =
        (0..parts).map(|part| begin(ROGUES * part / parts..ROGUES * (part + 1) / parts)).collect();
    let mut total = Outcome::default();
    for child in children {
        let output = child.wait_with_output().expect("a process that ends");
        let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        assert!(
            output.status.success(),
            "{text}\nagain: ROGUES=FROM..TO cargo test --test usb_driver some_rogues -- --ignored"
        );
        let numbers = text.lines().find_map(|line| line.split_once(SUMMARY)).expect("a summary").1;
        let [rogues, given_up, longest_us, passed_us] =
            *numbers.split(' ').map(|number| number.parse().expect("a number")).collect::<Vec<u64>>()
        else {
            panic!("{numbers}");
        };
        total.rogues += rogues;
        total.given_up += given_up;
        total.longest_us = total.longest_us.max(longest_us);
        total.passed_us += passed_us;
    }
    println!(
        "{} rogues in {:.1} s, {} s on the bus: {} were given up, the others attached or named; the slowest {BATCH} took {} ms",
        total.rogues,
        started.elapsed().as_secs_f64(),
        total.passed_us / 1_000_000,
        total.given_up,
        total.longest_us / 1_000
    );
    assert_eq!(total.rogues, ROGUES);
    assert!((ROGUES / 10..ROGUES * 9 / 10).contains(&total.given_up), "both happen");
}

/// Starts a part.
fn begin(range: Range<u64>) -> Child {
    Command::new(env::current_exe().expect("this test has a file"))
        .args(["--exact", "whole::rogues::some_rogues", "--ignored", "--nocapture"])
        .env(RANGE, format!("{}..{}", range.start, range.end))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("a process more")
}

#[test]
#[ignore = "a part of the test above, which runs it in processes of its own; ROGUES=FROM..TO names the seeds"]
fn some_rogues() {
    let seeds = env::var(RANGE).unwrap_or_else(|_| "0..600".into());
    let (from, to) = seeds.split_once("..").expect("ROGUES=FROM..TO");
    let [from, to] = [from, to].map(|number| number.parse::<u64>().expect("ROGUES=FROM..TO, both numbers"));
    let mut benches = [Bench::root(), Bench::hub(SpeedLimit::Full), Bench::hub(SpeedLimit::High)];
    let mut outcome = Outcome::default();
    let mut seed = from;
    while seed < to {
        // The same rogues come together, wherever a part begins.
        let end = (seed / BATCH + 1) * BATCH;
        let bench = match seed / BATCH % 10 {
            0 => 0,
            1..=2 => 1,
            _ => 2,
        };
        benches[bench].batch(seed..end.min(to), &mut outcome);
        seed = end;
    }
    let Outcome { rogues, given_up, longest_us, passed_us } = outcome;
    println!("{SUMMARY}{rogues} {given_up} {longest_us} {passed_us}");
}
