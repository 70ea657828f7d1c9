//! When high speed is given up for full speed.

use heapless::Vec;

use crate::slots::DEVICES_MAXIMUM;
use crate::{Event, Fault, Place};

/// Failures in a row of the controller, or of the device on the root port, which are tried for ever, after which full
/// speed is worth a try.
const FAILURES: u8 = 3;

/// Looks out for a bus that does not work at high speed: a device is given up and no other is in use, or the controller
/// or the device on the root port fails again and again, before any report has come. Whatever is wrong then, a hub's
/// transaction translator or the signal, full speed does without.
#[derive(Debug, Default)]
pub struct Fallback {
    /// Reports have come, or it was told to fall back already.
    settled: bool,
    failures: u8,
    /// Keyboards and pads that are there, at work or not.
    attached: Vec<Place, DEVICES_MAXIMUM>,
}

impl Fallback {
    /// Takes an event in; tells, at most once, whether to fall back.
    pub fn is_due(&mut self, event: &Event) -> bool {
        let due = match *event {
            Event::KeyboardReport { .. } | Event::PadReport { .. } => {
                self.settled = true;
                false
            }
            Event::Attached { device, kind, .. } if kind.source().is_some() => {
                // There is room for as many as there are devices.
                let _ = self.attached.push(device);
                false
            }
            Event::Detached { device, .. } => {
                self.attached.retain(|place| *place != device);
                false
            }
            // One that is broken by itself takes none of the others with it.
            Event::Fault { device, fault: Fault::GivenUp } => self.attached.iter().all(|place| *place == device),
            Event::Fault { device: Place::ROOT, fault } if is_failure(fault) => self.one_more(),
            _ => false,
        };
        self.once(due)
    }

    /// Takes note of a failure of the controller that a bad signal may be the cause of; tells whether to fall back.
    pub fn controller_failed(&mut self) -> bool {
        let due = self.one_more();
        self.once(due)
    }

    fn one_more(&mut self) -> bool {
        self.failures = self.failures.saturating_add(1);
        self.failures >= FAILURES
    }

    fn once(&mut self, due: bool) -> bool {
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
    use crate::{Identity, Kind, Text};
    use embassy_usb_driver::Speed;

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
    fn a_controller_that_fails_three_times_is_enough_once() {
        let mut fallback = Fallback::default();
        assert_eq!([(); 4].map(|()| fallback.controller_failed()), [false, false, true, false]);
        let mut fallback = Fallback::default();
        fallback.is_due(&Event::KeyboardReport { device: below(), report: [0; 8] });
        assert!(!(0..9).any(|_| fallback.controller_failed()), "it works");
    }

    #[test]
    fn a_broken_device_takes_no_other_with_it() {
        let other = Place::ROOT.below(1).expect("a place");
        let (maker, name) = (Text::default(), Text::default());
        let identity = Identity { vendor: 1, product: 2, class: 3, speed: Speed::Low, maker, name };
        let attached = |device| Event::Attached { device, kind: Kind::BootKeyboard, identity };
        let mut fallback = Fallback::default();
        fallback.is_due(&attached(other));
        assert!(!fallback.is_due(&fault(below(), Fault::GivenUp)), "the keyboard may be idle");
        fallback.is_due(&Event::Detached { device: other, kind: Some(Kind::BootKeyboard) });
        fallback.is_due(&attached(below()));
        assert!(fallback.is_due(&fault(below(), Fault::GivenUp)), "it was attached itself");
    }

    #[test]
    fn a_bus_that_brought_a_report_works() {
        let mut fallback = Fallback::default();
        assert!(!fallback.is_due(&Event::KeyboardReport { device: below(), report: [0; 8] }));
        assert!(!fallback.is_due(&fault(below(), Fault::GivenUp)));
    }
}
