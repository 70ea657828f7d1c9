//! Several keyboards and pads, as the one of each that the controls know.

use crate::slots::DEVICES_MAXIMUM;
use crate::{Event, Place};
use controls::{KeyboardReport, Report};
use heapless::Vec;

/// What the devices said last. Keyboards type together; of the pads, the one that spoke first leads until it goes.
#[derive(Debug, Default)]
pub struct Merge {
    keyboards: Vec<(Place, [u8; KeyboardReport::LENGTH]), DEVICES_MAXIMUM>,
    pad: Option<Place>,
    together: [u8; KeyboardReport::LENGTH],
}

impl Merge {
    /// Takes an event in, and returns what the controls are to be told.
    pub fn report<'a>(&'a mut self, event: &'a Event) -> Option<Report<'a>> {
        match event {
            Event::KeyboardReport { device, report } => {
                // "Too many keys" says nothing of any of them.
                if let Ok(None) = KeyboardReport::parse(report) {
                    return None;
                }
                match self.keyboards.iter_mut().find(|(place, _)| place == device) {
                    Some((_, last)) => *last = *report,
                    // There is room for as many as there are devices.
                    None => drop(self.keyboards.push((*device, *report))),
                }
                Some(Report::Keyboard(self.typed_together()))
            }
            Event::PadReport { device, report } => {
                (*self.pad.get_or_insert(*device) == *device).then_some(Report::DualShock3(report))
            }
            Event::Detached { device, .. } => {
                self.keyboards.retain(|(place, _)| place != device);
                let gone = event.report()?;
                match gone {
                    Report::Disconnected(controls::Source::Keyboard) if !self.keyboards.is_empty() => {
                        Some(Report::Keyboard(self.typed_together()))
                    }
                    Report::Disconnected(controls::Source::DualShock3) => {
                        self.pad.take_if(|pad| pad == device).map(|_| gone)
                    }
                    _ => Some(gone),
                }
            }
            _ => None,
        }
    }

    /// Makes one report of all: one keyboard's own, else all keys that are down, as many as a report has room for.
    fn typed_together(&mut self) -> &[u8] {
        if let [(_, report)] = *self.keyboards {
            self.together = report;
            return &self.together;
        }
        self.together = [0; KeyboardReport::LENGTH];
        let (head, keys) = self.together.split_at_mut(2);
        let down = self.keyboards.iter().flat_map(|(_, report)| &report[2..]).filter(|usage| **usage != 0);
        keys.iter_mut().zip(down).for_each(|(key, usage)| *key = *usage);
        head[0] = self.keyboards.iter().fold(0, |modifiers, (_, report)| modifiers | report[0]);
        &self.together
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Kind;
    use controls::{DualShock3Report, Source};

    fn place(port: u8) -> Place {
        Place::ROOT.below(port).expect("a place")
    }

    fn typed(port: u8, report: [u8; 8]) -> Event {
        Event::KeyboardReport { device: place(port), report }
    }

    fn gone(port: u8, kind: Kind) -> Event {
        Event::Detached { device: place(port), kind: Some(kind) }
    }

    fn keys(merge: &mut Merge, event: Event) -> Option<[u8; 8]> {
        match merge.report(&event)? {
            Report::Keyboard(report) => Some(report.try_into().expect("8 bytes")),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn one_keyboards_reports_go_through_as_they_are() {
        let report = [0x22, 0x77, 4, 0, 5, 0, 0, 9];
        assert_eq!(keys(&mut Merge::default(), typed(1, report)), Some(report));
    }

    #[test]
    fn keyboards_type_together_and_let_go_alone() {
        let mut merge = Merge::default();
        keys(&mut merge, typed(1, [0x02, 0, 4, 5, 0, 0, 0, 0]));
        let both = keys(&mut merge, typed(2, [0x20, 0, 6, 0, 0, 0, 0, 0]));
        assert_eq!(both, Some([0x22, 0, 4, 5, 6, 0, 0, 0]));
        assert_eq!(keys(&mut merge, typed(2, [0, 0, 1, 1, 1, 1, 1, 1])), None, "too many keys");
        assert_eq!(keys(&mut merge, gone(1, Kind::BootKeyboard)), Some([0x20, 0, 6, 0, 0, 0, 0, 0]));
        let last = gone(2, Kind::ReportKeyboard);
        assert_eq!(merge.report(&last), Some(Report::Disconnected(Source::Keyboard)));
    }

    #[test]
    fn more_keys_than_a_report_holds_are_cut_off() {
        let mut merge = Merge::default();
        keys(&mut merge, typed(1, [0, 0, 4, 5, 6, 7, 0, 0]));
        let both = keys(&mut merge, typed(2, [0, 0, 8, 9, 10, 11, 0, 0]));
        assert_eq!(both, Some([0, 0, 4, 5, 6, 7, 8, 9]));
    }

    #[test]
    fn the_second_pad_waits_until_the_first_has_gone() {
        let mut merge = Merge::default();
        let report = DualShock3Report::default().to_bytes();
        let [first, second] = [1, 2].map(|port| Event::PadReport { device: place(port), report });
        assert_eq!(merge.report(&first), Some(Report::DualShock3(&report)));
        assert_eq!(merge.report(&second), None);
        assert_eq!(merge.report(&gone(2, Kind::DualShock4)), None);
        assert_eq!(merge.report(&second), None);
        assert_eq!(merge.report(&gone(1, Kind::DualShock3)), Some(Report::Disconnected(Source::DualShock3)));
        assert_eq!(merge.report(&second), Some(Report::DualShock3(&report)));
    }
}
