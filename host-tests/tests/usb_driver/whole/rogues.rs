//! Devices that are wrong, each in its own way, on the root port and behind hubs.

use std::env;
use std::ops::Range;
use std::process::{Child, Command, Stdio};
use std::time::Instant;

use dwc2_host::SpeedLimit;

use super::batch::{BATCH, Bench, Outcome};
use super::reach::REACHES;

/// Enumerations of rogues in all.
const ROGUES: u64 = 100_000;
/// Names the rogues of a part: `FROM..TO`.
const RANGE: &str = "ROGUES";
/// Begins the line in which a part says what came of its rogues.
const SUMMARY: &str = "rogues, longest, passed, and how many came how far: ";
/// At least so many of a hundred come as far as each [`Reach`](super::reach::Reach): all that is asked is asked of rogues.
const SHARES_MINIMUM: [u64; REACHES] = [15, 15, 4, 20, 25];

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
        let numbers: Vec<u64> = numbers.split(' ').map(|number| number.parse().expect("a number")).collect();
        let [rogues, longest_us, passed_us, ref reached @ ..] = numbers[..] else { panic!("{numbers:?}") };
        total.rogues += rogues;
        total.reached.iter_mut().zip(reached).for_each(|(sum, count)| *sum += count);
        total.longest_us = total.longest_us.max(longest_us);
        total.passed_us += passed_us;
    }
    println!(
        "{} rogues in {:.1} s, {} s on the bus; {:?} came as far as device descriptor, configuration, class, name, use; \
         the slowest {BATCH} took {} ms",
        total.rogues,
        started.elapsed().as_secs_f64(),
        total.passed_us / 1_000_000,
        total.reached,
        total.longest_us / 1_000
    );
    assert_eq!(total.rogues, ROGUES);
    for (reached, least) in total.reached.iter().zip(SHARES_MINIMUM) {
        assert!(reached * 100 >= least * ROGUES, "{:?} of {ROGUES} are not {SHARES_MINIMUM:?} of 100", total.reached);
    }
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
    let Outcome { rogues, reached, longest_us, passed_us } = outcome;
    let reached: String = reached.iter().map(|count| format!(" {count}")).collect();
    println!("{SUMMARY}{rogues} {longest_us} {passed_us}{reached}");
}
