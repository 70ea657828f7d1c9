//! A gamepad's events, as Linux names them (`input-event-codes.h`, `gamepad.rst`), as a DualShock 3's report.

use std::collections::BTreeMap;

use controls::{Button, Buttons, DualShock3Report};

/// Types of events.
const KEY: u16 = 1;
const AXIS: u16 = 3;

/// Buttons' codes. South is Cross.
const BUTTONS: [(u16, Button); 17] = [
    (0x130, Button::Cross),
    (0x131, Button::Circle),
    (0x133, Button::Triangle),
    (0x134, Button::Square),
    (0x136, Button::L1),
    (0x137, Button::R1),
    (0x138, Button::L2),
    (0x139, Button::R2),
    (0x13A, Button::Select),
    (0x13B, Button::Start),
    (0x13C, Button::Ps),
    (0x13D, Button::L3),
    (0x13E, Button::R3),
    (0x220, Button::Up),
    (0x221, Button::Down),
    (0x222, Button::Left),
    (0x223, Button::Right),
];
/// Axes' codes: the sticks', the triggers', which count as pressed from half of their way on, and the D-pad's.
const STICKS: [u16; 4] = [0, 1, 3, 4];
const TRIGGERS: [(u16, Button); 2] = [(2, Button::L2), (5, Button::R2)];
const DIRECTIONS: [(u16, [Button; 2]); 2] = [(16, [Button::Left, Button::Right]), (17, [Button::Up, Button::Down])];

/// What a gamepad's events have come to.
#[derive(Debug, Default)]
pub(crate) struct Mapping {
    /// Least and largest value of each axis.
    ranges: BTreeMap<u16, [i32; 2]>,
    report: DualShock3Report,
}

impl Mapping {
    /// Returns the mapping of a gamepad that has these axes: code, least and largest value.
    pub(crate) fn new(axes: impl IntoIterator<Item = (u16, [i32; 2])>) -> Self {
        Self { ranges: axes.into_iter().collect(), report: DualShock3Report::default() }
    }

    /// Takes an event: its type, code and value. What a DualShock 3 has not is left out.
    pub(crate) fn take(&mut self, kind: u16, code: u16, value: i32) {
        match kind {
            KEY => {
                if let Some((_, button)) = BUTTONS.iter().find(|(known, _)| *known == code) {
                    self.hold(*button, value != 0);
                }
            }
            AXIS => self.move_axis(code, value),
            _ => {}
        }
    }

    fn move_axis(&mut self, code: u16, value: i32) {
        if let Some((_, [low, high])) = DIRECTIONS.iter().find(|(known, _)| *known == code) {
            self.hold(*low, value < 0);
            self.hold(*high, value > 0);
            return;
        }
        let Some(byte) = self.in_a_byte(code, value) else { return };
        if let Some((_, button)) = TRIGGERS.iter().find(|(known, _)| *known == code) {
            self.hold(*button, byte >= 0x80);
        } else if let Some(index) = STICKS.iter().position(|known| *known == code) {
            let sticks = [&mut self.report.left_stick, &mut self.report.right_stick];
            sticks.into_iter().flatten().nth(index).into_iter().for_each(|axis| *axis = byte);
        }
    }

    /// Returns an axis' value in 0 to 255.
    fn in_a_byte(&self, code: u16, value: i32) -> Option<u8> {
        let [least, largest] = self.ranges.get(&code)?.map(i64::from);
        let way = i64::from(value).clamp(least, largest.max(least)) - least;
        u8::try_from((way * 255 + (largest - least) / 2).checked_div(largest - least)?).ok()
    }

    fn hold(&mut self, button: Button, held: bool) {
        let bit = Buttons::from(button).bits();
        let bits = self.report.held.bits();
        self.report.held = Buttons::from_bits(if held { bits | bit } else { bits & !bit });
    }

    /// Returns the report.
    pub(crate) fn report(&self) -> [u8; DualShock3Report::LENGTH] {
        self.report.to_bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STICK: [i32; 2] = [-32_768, 32_767];

    /// A gamepad with the axes of an Xbox 360's, as the kernel's `xpad` reports it.
    fn after(events: &[(u16, u16, i32)]) -> DualShock3Report {
        let axes = [(0, STICK), (1, STICK), (2, [0, 255]), (3, STICK), (4, STICK), (5, [0, 255]), (16, [-1, 1])];
        let mut mapping = Mapping::new(axes);
        events.iter().for_each(|(kind, code, value)| mapping.take(*kind, *code, *value));
        DualShock3Report::parse(&mapping.report()).expect("it is a report")
    }

    #[test]
    fn sticks_go_from_end_to_end_and_rest_in_the_middle() {
        let report = after(&[(3, 0, -32_768), (3, 1, 32_767), (3, 3, 0), (3, 4, 16_384)]);
        assert_eq!((report.left_stick, report.right_stick), ([0, 255], [128, 191]));
        assert_eq!(after(&[]).left_stick, [0x80; 2]);
    }

    #[test]
    fn buttons_are_held_and_let_go() {
        let held = |events: &[_]| after(events).held;
        let south = (1, 0x130, 1);
        assert_eq!(held(&[south]), Button::Cross.into());
        assert_eq!(held(&[south, (1, 0x13C, 1), (1, 0x130, 0)]), Button::Ps.into());
        assert_eq!(held(&[(3, 16, -1)]), Button::Left.into());
        assert_eq!(held(&[(3, 16, -1), (3, 16, 1)]), Button::Right.into());
        assert_eq!(held(&[(3, 2, 200), (3, 5, 100)]), Button::L2.into());
    }

    #[test]
    fn what_the_pad_has_not_changes_nothing() {
        assert_eq!(after(&[(0, 0, 0), (4, 4, 0x90001), (1, 0x2FF, 1), (3, 40, 7)]), DualShock3Report::default());
    }
}
