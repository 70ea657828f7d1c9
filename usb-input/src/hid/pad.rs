//! A pad's report to a DualShock 3's.

use controls::{Acceleration, Battery, Button, Buttons, DualShock3Report};

use super::field::{Field, bits};
use super::inputs::Input;

const DESKTOP_PAGE: u16 = 0x01;
const BUTTON_PAGE: u16 = 0x09;
const X: u16 = 0x30;
const RZ: u16 = 0x35;
const HAT: u16 = 0x39;
/// Where a stick rests.
const CENTRE: u8 = 0x80;
/// No button there.
const NOWHERE: u32 = u32::MAX;

/// What buttons 1, 2, … are taken for: the order of Sony's own pads since the DualShock 4, which most
/// others with this many buttons follow.
const BUTTONS: [Button; 13] = [
    Button::Square,
    Button::Cross,
    Button::Circle,
    Button::Triangle,
    Button::L1,
    Button::R1,
    Button::L2,
    Button::R2,
    Button::Select,
    Button::Start,
    Button::L3,
    Button::R3,
    Button::Ps,
];

/// Where a pad's report has its sticks and buttons.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct PadLayout {
    /// X, Y, Z, Rx, Ry, Rz.
    axes: [Option<Field>; 6],
    hat: Option<Field>,
    /// The bits of buttons 1, 2, …
    buttons: [u32; BUTTONS.len()],
}

impl Default for PadLayout {
    fn default() -> Self {
        Self { axes: [None; 6], hat: None, buttons: [NOWHERE; BUTTONS.len()] }
    }
}

impl PadLayout {
    /// Tells whether it has a stick.
    pub(super) fn is_usable(&self) -> bool {
        self.axes[0].is_some() && self.axes[1].is_some()
    }

    /// Takes in an item if it is about a stick, a hat or buttons, and tells whether it is.
    pub(super) fn add(&mut self, input: &Input<'_>) -> bool {
        let mut of_use = false;
        if !input.variable {
            return of_use;
        }
        let mut bit = input.bit;
        // More numbers in one item than usages of interest need not be looked at.
        for index in 0..input.count.min(0x100) {
            let Some(usage) = input.usage(index) else { break };
            let number = usage as u16;
            match (usage >> 16) as u16 {
                DESKTOP_PAGE => {
                    let slot = match number {
                        X..=RZ => Some(&mut self.axes[usize::from(number - X)]),
                        HAT => Some(&mut self.hat),
                        _ => None,
                    };
                    if let Some(slot @ None) = slot {
                        *slot = Some(Field { bit, size: input.size, minimum: input.minimum, maximum: input.maximum });
                        of_use = true;
                    }
                }
                BUTTON_PAGE => {
                    if let Some(slot @ &mut NOWHERE) = self.buttons.get_mut(usize::from(number.wrapping_sub(1))) {
                        *slot = bit;
                        of_use = true;
                    }
                }
                _ => {}
            }
            bit = bit.saturating_add(input.size);
        }
        of_use
    }

    /// Reads a report, without its id.
    ///
    /// The right stick is Z and Rz, or Rx and Ry on a pad without these two. Acceleration is that of a pad that is held
    /// level, the battery is unknown: no usage tells them.
    pub(crate) fn read(&self, report: &[u8]) -> DualShock3Report {
        let axis = |index: usize| self.axes[index].as_ref().map_or(CENTRE, |axis| axis.read_byte(report));
        let [_, _, z, _, _, rz] = &self.axes;
        let [right_x, right_y] = if z.is_some() && rz.is_some() { [2, 5] } else { [3, 4] };
        let mut held = self.directions(report);
        for (&bit, button) in self.buttons.iter().zip(BUTTONS) {
            if bits(report, bit, 1) == Some(1) {
                held = held.with(button);
            }
        }
        DualShock3Report {
            held,
            left_stick: [axis(0), axis(1)],
            right_stick: [axis(right_x), axis(right_y)],
            battery: Battery::Unknown,
            acceleration: Acceleration::LEVEL,
        }
    }

    /// Reads the hat: eight directions clockwise from up, or four; anything else is its centre.
    fn directions(&self, report: &[u8]) -> Buttons {
        const UP: u8 = 1 << 0;
        const RIGHT: u8 = 1 << 1;
        const DOWN: u8 = 1 << 2;
        const LEFT: u8 = 1 << 3;
        const EIGHT: [u8; 8] = [UP, UP | RIGHT, RIGHT, RIGHT | DOWN, DOWN, DOWN | LEFT, LEFT, LEFT | UP];
        let Some((hat, value)) = self.hat.and_then(|hat| Some((hat, hat.read(report)?))) else {
            return Buttons::NONE;
        };
        let step = value.wrapping_sub(hat.minimum) as usize;
        let four = hat.maximum.wrapping_sub(hat.minimum) == 3;
        let pressed = EIGHT.get(if four { step.saturating_mul(2) } else { step }).copied().unwrap_or(0);
        // The pad's own four buttons are neighbours in this order.
        Buttons::from_bits(u32::from(pressed) << Button::Up as u32)
    }
}
