//! A board's own push buttons and slide switches.

use crate::ReportError;
use crate::keyboard_state::Keys;

/// Holds what the DE1-SoC's own buttons and switches are.
///
/// | byte | meaning |
/// | --- | --- |
/// | 0 | bits 0–3: KEY0 to KEY3 pressed; bit 4: the processor's own key |
/// | 1, 2 | SW0 to SW9 up, from bit 0 of byte 1 |
///
/// SW0 and SW1 choose what the four keys do, each while it is down:
///
/// | SW1 | SW0 | KEY3 | KEY2 | KEY1 | KEY0 |
/// | --- | --- | --- | --- | --- | --- |
/// | down | down | lean left | far edge up | far edge down | lean right |
/// | down | up | move left | move up | move down | move right |
/// | up | down | turn left | nearer | farther | turn right |
/// | up | up | previous scene | level | centre | next scene |
///
/// SW2 up freezes the pose. SW3 up holds R1, which gives the scene's other mode. SW4 up, whatever SW1 and
/// SW0 say: KEY3 has the legend told, KEY2 changes the scene's mode, KEY1 the projection, KEY0 the style.
/// The processor's key goes to the next scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PanelReport {
    /// The keys that are pressed: KEY0 in bit 0, the processor's own in bit 4.
    pub keys: u8,
    /// The switches that are up: SW0 in bit 0.
    pub switches: u16,
}

/// What KEY3 to KEY0 stand for, by the number that SW1 and SW0 make, and last with SW4 up: usages of a
/// keyboard's keys.
const KEYS: [[u8; 4]; 5] = [
    [0x50, 0x52, 0x51, 0x4F], // arrows: left, up, down, right
    [0x04, 0x1A, 0x16, 0x07], // A, W, S, D
    [0x14, 0x2E, 0x2D, 0x08], // Q, +, -, E
    [0x2A, 0x15, 0x09, 0x28], // Backspace, R, F, Enter
    [0x0B, 0x06, 0x19, 0x2B], // H, C, V, Tab
];
const SPACE: u8 = 0x2C;
const ENTER: u8 = 0x28;
const TWO: u8 = 0x1F;

impl PanelReport {
    /// The report's length in bytes.
    pub const LENGTH: usize = 3;

    /// Reads a report. Bits without a meaning are not looked at.
    ///
    /// # Errors
    ///
    /// [`ReportError::PanelLength`] unless there are exactly 3 bytes.
    pub fn parse(bytes: &[u8]) -> Result<Self, ReportError> {
        match *bytes {
            [keys, low, high] => Ok(Self { keys, switches: u16::from_le_bytes([low, high]) }),
            _ => Err(ReportError::PanelLength { found: bytes.len() }),
        }
    }

    /// Writes the report.
    #[must_use]
    pub const fn to_bytes(self) -> [u8; Self::LENGTH] {
        let [low, high] = self.switches.to_le_bytes();
        [self.keys, low, high]
    }

    /// Returns the keyboard's keys that do the same.
    pub(crate) fn as_keys(self) -> Keys {
        let row = if self.switches & 1 << 4 != 0 { 4 } else { usize::from(self.switches & 0b11) };
        let held = |holds: bool, usage: u8| if holds { usage } else { 0 };
        let [key3, key2, key1, key0] = KEYS[row];
        Keys([
            held(self.keys & 1 << 3 != 0, key3),
            held(self.keys & 1 << 2 != 0, key2),
            held(self.keys & 1 << 1 != 0, key1),
            held(self.keys & 1 << 0 != 0, key0),
            held(self.keys & 1 << 4 != 0, ENTER),
            held(self.switches & 1 << 2 != 0, SPACE),
            held(self.switches & 1 << 3 != 0, TWO),
            0,
        ])
    }
}

#[cfg(test)]
mod tests {
    use super::PanelReport;
    use crate::{Button, Config, ControllerState, Controls, ReportError, Source};
    use fixed::types::I2F14;
    use std::vec::Vec;

    /// What the application sees after one frame with the panel like this.
    fn after(keys: u8, switches: u16) -> ControllerState {
        let mut controls = Controls::new(Config::default());
        controls.accept_panel(&PanelReport { keys, switches }.to_bytes()).unwrap();
        let state = controls.state();
        controls.end_frame();
        ControllerState { tilt: controls.state().tilt, ..state }
    }

    #[test]
    fn four_keys_do_what_the_two_switches_say() {
        let signs = |[a, b]: [I2F14; 2]| [a.to_num::<i32>(), b.to_num::<i32>()];
        // KEY3, KEY2, KEY1, KEY0, and two at once that undo each other.
        let ways = [0b1000, 0b0100, 0b0010, 0b0001, 0b1001];
        let tilts: Vec<[i32; 2]> = ways
            .iter()
            .map(|keys| after(*keys, 0).tilt)
            .map(|tilt| [tilt.roll.to_num::<i32>().signum(), tilt.pitch.to_num::<i32>().signum()])
            .collect();
        assert_eq!(tilts, [[1, 0], [0, 1], [0, -1], [-1, 0], [0, 0]]);
        let pans = ways.map(|keys| after(keys, 0b01)).map(|state| signs([state.pan().x, state.pan().y]));
        assert_eq!(pans, [[-1, 0], [0, 1], [0, -1], [1, 0], [0, 0]]);
        let turns = ways.map(|keys| after(keys, 0b10)).map(|state| signs([state.turn(), state.zoom()]));
        assert_eq!(turns, [[-1, 0], [0, 1], [0, -1], [1, 0], [0, 0]]);
        let buttons = [Button::Select, Button::R3, Button::L3, Button::Start];
        for (keys, button) in ways.into_iter().zip(buttons) {
            assert_eq!(after(keys, 0b11).pressed, button.into());
        }
    }

    #[test]
    fn a_switch_freezes_and_the_processors_key_goes_on() {
        assert!(after(0, 0b100).frozen);
        assert_eq!(after(0b1_0000, 0).pressed, Button::Start.into());
        assert_eq!(after(0b1_0000, 0).last_moved, Some(Source::Panel));
        // The display's test pattern, and switches without a meaning.
        assert_eq!(after(0, 0b11_1110_0000), ControllerState { last_moved: None, ..after(0, 0) });
    }

    #[test]
    fn a_fifth_row_chooses_how_the_scene_is_drawn() {
        for (keys, button) in
            [(0b1000, Button::Ps), (0b0100, Button::Circle), (0b0010, Button::Square), (0b0001, Button::Triangle)]
        {
            for others in 0..4 {
                assert_eq!(after(keys, 0b1_0000 | others).pressed, button.into());
            }
        }
        assert_eq!(after(0, 0b1000).held, Button::R1.into());
        let all = after(0b1_1111, 0b1_1100).held;
        let expected =
            [Button::Ps, Button::Circle, Button::Square, Button::Triangle, Button::Start, Button::Cross, Button::R1];
        assert_eq!(all, expected.into_iter().collect(), "all at once");
    }

    #[test]
    fn a_keyboard_beside_it_keeps_its_keys() {
        let mut controls = Controls::new(Config::default());
        controls.accept_keyboard(&[0, 0, SPACE_KEY, 0, 0, 0, 0, 0]).unwrap();
        controls.accept_panel(&PanelReport { keys: 0b1000, switches: 0b01 }.to_bytes()).unwrap();
        let state = controls.state();
        assert!(state.frozen && state.pan().x == I2F14::NEG_ONE);
        controls.disconnect(Source::Panel);
        assert!(controls.state().frozen && controls.state().pan().x == I2F14::ZERO);
    }
    const SPACE_KEY: u8 = 0x2C;

    #[test]
    fn a_report_comes_back_and_another_length_is_named() {
        let report = PanelReport { keys: 0b1_0110, switches: 0x2A5 };
        assert_eq!(PanelReport::parse(&report.to_bytes()), Ok(report));
        for length in [0, 2, 4] {
            assert_eq!(PanelReport::parse(&[0; 4][..length]), Err(ReportError::PanelLength { found: length }));
        }
    }
}
