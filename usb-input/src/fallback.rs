//! When high speed is given up for full speed.

use crate::{Event, Fault, Place};

/// Failures of the device on the root port, which is tried for ever, after which full speed is worth a try.
const ROOT_FAILURES: u8 = 3;

/// Looks out for a bus that does not work at high speed: a device is given up, or that on the root port fails again and
/// again, before any report has come. Whatever is wrong then, a hub's transaction translator or the signal, full speed
/// does without; and a device that is broken by itself costs those that are not a second.
#[derive(Debug, Default)]
pub struct Fallback {
    /// Reports have come, or it was told to fall back already.
    settled: bool,
    root_failures: u8,
}

impl Fallback {
    /// Takes an event in; tells, at most once, whether to fall back.
    pub fn is_due(&mut self, event: &Event) -> bool {
        let due = match *event {
            Event::KeyboardReport { .. } | Event::PadReport { .. } => {
                self.settled = true;
                false
            }
            Event::Fault { fault: Fault::GivenUp, .. } => true,
            Event::Fault { device: Place::ROOT, fault } if is_failure(fault) => {
                self.root_failures = self.root_failures.saturating_add(1);
                self.root_failures >= ROOT_FAILURES
            }
            _ => false,
        };
        let due = due && !self.settled;
        self.settled |= due;
        due
    }
}

/// A failure that may be the bus's.
fn is_failure(fault: Fault) -> bool {
    matches!(fault, Fault::Transfer { .. } | Fault::Descriptor { .. } | Fault::TooSlow)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn below() -> Place {
        Place::ROOT.below(2).expect("a place")
    }

    fn fault(device: Place, fault: Fault) -> Event {
        Event::Fault { device, fault }
    }

    #[test]
    fn the_first_device_that_is_given_up_is_enough_once() {
        let mut fallback = Fallback::default();
        assert!(!fallback.is_due(&fault(below(), Fault::TooSlow)));
        assert!(fallback.is_due(&fault(below(), Fault::GivenUp)));
        assert!(!fallback.is_due(&fault(below(), Fault::GivenUp)), "once");
    }

    #[test]
    fn the_root_ports_device_may_fail_twice() {
        let mut fallback = Fallback::default();
        let told = [(); 4].map(|()| fallback.is_due(&fault(Place::ROOT, Fault::TooSlow)));
        assert_eq!(told, [false, false, true, false]);
        let mut fallback = Fallback::default();
        assert!(!(0..9).any(|_| fallback.is_due(&fault(Place::ROOT, Fault::TooManyPorts { ports: 9 }))));
    }

    #[test]
    fn a_bus_that_brought_a_report_works() {
        let mut fallback = Fallback::default();
        assert!(!fallback.is_due(&Event::KeyboardReport { device: below(), report: [0; 8] }));
        assert!(!fallback.is_due(&fault(below(), Fault::GivenUp)));
    }
}
