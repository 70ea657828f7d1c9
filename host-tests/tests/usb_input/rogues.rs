//! Devices that are wrong, each in its own way, on a controller with nothing behind it: what is wrong here is the
//! stack's. More of them, on the strict model of the core, are in `usb_driver`.

use std::time::Instant;

use usb_input::{Event, Kind, Place};
use usb_model::keyboard::{Form, keyboard};
use usb_model::rogue::rogue;
use usb_model::simple_hub::Ports;
use usb_model::wire::Speed;

use crate::bench::{Bench, place, shared};

/// Enumerations of rogues in all.
const ROGUES: u64 = 10_000;
/// A device is done with, one way or the other, within three attempts of five seconds, their pauses and resets, and what
/// reads reports gives up after 1.27 s; in between it may be attached three times.
const LIMIT_US: u64 = 25_000_000;

impl Bench {
    /// Polls until nothing more happens at this moment, then jumps to the next one at which something can.
    fn jump(&mut self, end: u64) {
        loop {
            let before = (self.host.transactions(), self.events.len(), self.reports.len());
            self.host.take_wait_us();
            self.poll();
            if before == (self.host.transactions(), self.events.len(), self.reports.len()) {
                break;
            }
        }
        let next = [self.usb.next_wait_us(), self.host.take_wait_us()].into_iter().flatten().min();
        self.now.set(next.unwrap_or(end).clamp(self.now.get() + 1, end.max(self.now.get() + 1)));
    }

    /// Jumps until something is so, or the time is over; tells whether it is so.
    fn jump_until(&mut self, limit_us: u64, condition: impl Fn(&Self) -> bool) -> bool {
        let end = self.now.get() + limit_us;
        while !condition(self) {
            if self.now.get() >= end {
                return false;
            }
            self.jump(end);
        }
        true
    }
}

/// Whether whoever is at a place has come to its end: given up, or something that is let be.
fn settled(events: &[Event], here: Place) -> bool {
    events.iter().any(|event| match event {
        Event::Fault { device, fault } => *device == here && *fault == usb_input::Fault::GivenUp,
        Event::Unsupported { device, .. } | Event::Attached { device, .. } => *device == here,
        _ => false,
    })
}

#[test]
fn ten_thousand_rogues_do_no_harm() {
    let started = Instant::now();
    let threads = std::thread::available_parallelism().map_or(1, usize::from).clamp(1, 4) as u64;
    let parts: Vec<_> = (0..threads)
        .map(|part| std::thread::spawn(move || run(ROGUES * part / threads..ROGUES * (part + 1) / threads)))
        .collect();
    let mut total = Outcome::default();
    for part in parts {
        let outcome = part.join().expect("no panic");
        total.attached += outcome.attached;
        total.given_up += outcome.given_up;
        total.longest_us = total.longest_us.max(outcome.longest_us);
    }
    println!(
        "{ROGUES} rogues in {:.1} s: {} got as far as being attached or named, {} were given up; the longest took {} ms",
        started.elapsed().as_secs_f64(),
        total.attached,
        total.given_up,
        total.longest_us / 1_000
    );
    assert_eq!(total.attached + total.given_up, ROGUES);
    assert!(total.attached > ROGUES / 10 && total.given_up > ROGUES / 10, "both happen");
}

#[derive(Default)]
struct Outcome {
    attached: u64,
    given_up: u64,
    longest_us: u64,
}

/// Plugs in one rogue after the other beside a keyboard that has to go on working, and now and then a good device
/// in its place.
fn run(seeds: std::ops::Range<u64>) -> Outcome {
    let mut bench = Bench::new();
    let (_, ports) = bench.plug_hub(Speed::High, 3);
    let neighbour = shared(keyboard(Form::Boot, Speed::Low));
    bench.plug_into(&ports, 3, neighbour.clone());
    let ready = (place(&[3]), Kind::BootKeyboard);
    assert!(bench.jump_until(2_000_000, |bench| bench.attached().contains(&ready)));
    let mut outcome = Outcome::default();
    let here = place(&[1]);
    for seed in seeds {
        bench.events.clear();
        bench.reports.clear();
        let began = bench.now.get();
        ports.plug(1, shared(rogue(seed)), began);
        let done = bench.jump_until(LIMIT_US, |bench| settled(&bench.events, here));
        assert!(done, "rogue {seed} is neither attached nor given up: {:#?}", bench.events);
        outcome.longest_us = outcome.longest_us.max(bench.now.get() - began);
        let given_up = bench.faults().iter().any(|fault| fault.contains("given up"));
        *(if given_up { &mut outcome.given_up } else { &mut outcome.attached }) += 1;
        // Reports, of whatever kind.
        bench.jump_until(60_000, |_| false);
        ports.unplug(1);
        let gone = |bench: &Bench| given_up || bench.detached().contains(&here);
        assert!(bench.jump_until(LIMIT_US, gone), "rogue {seed} does not go: {:#?}", bench.events);
        if seed % 4 == 0 {
            the_next_one_works(&mut bench, &ports, seed);
        }
        assert_eq!(
            bench.attached().iter().filter(|found| **found == ready).count(),
            0,
            "rogue {seed} harms its neighbour"
        );
        neighbour_types(&mut bench, &neighbour, seed);
    }
    outcome
}

fn the_next_one_works(bench: &mut Bench, ports: &Ports, seed: u64) {
    bench.events.clear();
    let good = shared(keyboard(Form::List, Speed::Full));
    bench.plug_into(ports, 1, good.clone());
    let attached = (place(&[1]), Kind::ReportKeyboard);
    assert!(
        bench.jump_until(LIMIT_US, |bench| bench.attached().contains(&attached)),
        "after rogue {seed}: {:#?}",
        bench.events
    );
    good.borrow_mut().function.press(0x2C);
    assert!(bench.jump_until(100_000, |bench| bench.state().frozen), "after rogue {seed}");
    ports.unplug(1);
    assert!(bench.jump_until(500_000, |bench| bench.detached().contains(&place(&[1]))), "after rogue {seed}");
}

fn neighbour_types(bench: &mut Bench, neighbour: &std::cell::RefCell<usb_model::keyboard::Keyboard>, seed: u64) {
    let has = |bench: &Bench, key: u8| {
        let device = place(&[3]);
        bench.reports.contains(&Event::KeyboardReport { device, report: [0, 0, key, 0, 0, 0, 0, 0] })
    };
    bench.reports.clear();
    neighbour.borrow_mut().function.press(0x04);
    neighbour.borrow_mut().function.release(0x04);
    let typed = bench.jump_until(100_000, |bench| has(bench, 0x04) && has(bench, 0));
    assert!(typed, "beside rogue {seed}: {:#?} {:#?}", bench.events, bench.reports);
}
