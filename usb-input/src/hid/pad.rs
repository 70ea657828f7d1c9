//! A pad's report to a DualShock 3's.

use controls::{Acceleration, Battery, Button, Buttons, DualShock3Report};

use super::field::{Field, bits};
use super::inputs::Input;

const DESKTOP_PAGE: u16 = 0x01;
const BUTTON_PAGE: u16 = 0x09;
const X: u16 = 0x30;
const RZ: u16 = 0x35;
const HAT: u16 = 0x39;
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
        let before = *self;
        if input.variable {
            self.add_numbers(input);
        }
        *self != before
    }

    fn add_numbers(&mut self, input: &Input<'_>) {
        // More numbers in one item than usages of interest need not be looked at.
        for index in 0..input.count.min(0x100) {
            let Some(usage) = input.usage(index) else { break };
            let Some(bit) = input.bit.checked_add(index.saturating_mul(input.size)) else { break };
            let field = Field { bit, size: input.size, minimum: input.minimum, maximum: input.maximum };
            match ((usage >> 16) as u16, usage as u16) {
                (DESKTOP_PAGE, axis @ X..=RZ) => {
                    let slot = &mut self.axes[usize::from(axis - X)];
                    *slot = slot.or(Some(field));
                }
                (DESKTOP_PAGE, HAT) => self.hat = self.hat.or(Some(field)),
                (BUTTON_PAGE, number @ 1..) => {
                    if let Some(slot) = self.buttons.get_mut(usize::from(number) - 1)
                        && *slot == NOWHERE
                    {
                        *slot = bit;
                    }
                }
                _ => {}
            }
        }
    }

    /// Reads a report, without its id.
    ///
    /// The right stick is Z and Rz, or Rx and Ry on a pad without these two. Acceleration is that of a pad that is held
    /// level, the battery is unknown: no usage tells them.
    pub(crate) fn read(&self, report: &[u8]) -> DualShock3Report {
        let [x, y, z, rx, ry, rz] = self.axes;
        let right = if z.is_some() && rz.is_some() { [z, rz] } else { [rx, ry] };
        let stick = |axes: [Option<Field>; 2]| axes.map(|axis| axis.map_or(0x80, |axis| axis.read_byte(report)));
        let down = |bit: u32| bit != NOWHERE && bits(report, bit, 1) == Some(1);
        let held = self.buttons.iter().zip(BUTTONS).filter(|&(&bit, _)| down(bit)).map(|(_, button)| button);
        DualShock3Report {
            held: held.collect::<Buttons>() | self.directions(report),
            left_stick: stick([x, y]),
            right_stick: stick(right),
            battery: Battery::Unknown,
            acceleration: Acceleration::LEVEL,
        }
    }

    /// Reads the hat: eight directions clockwise from up, or four; anything else is its centre.
    fn directions(&self, report: &[u8]) -> Buttons {
        use Button::{Down, Left, Right, Up};
        const EIGHT: [&[Button]; 8] =
            [&[Up], &[Up, Right], &[Right], &[Right, Down], &[Down], &[Down, Left], &[Left], &[Left, Up]];
        let direction = self.hat.and_then(|hat| {
            let step = i64::from(hat.read(report)?) - i64::from(hat.minimum);
            let range = i64::from(hat.maximum) - i64::from(hat.minimum);
            let eighths = if range == 3 { step.checked_mul(2)? } else { step };
            EIGHT.get(usize::try_from(eighths).ok()?)
        });
        direction.map_or(Buttons::NONE, |buttons| buttons.iter().copied().collect())
    }
}
