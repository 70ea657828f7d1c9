//! What controllers say, taken in and tallied.

use controls::{Config, ControllerState, Controls, Report, ReportError};
use serde::{Deserialize, Serialize};

/// The controls, and a tally of what they took in: it shows whether a report was lost or came twice.
pub struct Intake {
    controls: Controls,
    tally: Tally,
    /// Frames until a key that was typed at a terminal is let go.
    typed: u8,
}

/// Frames that a typed key is down: longer than a terminal takes until it says again that one is held.
const TYPED_FRAMES: u8 = 4;

/// What came in since the start, or since a PC began a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Tally {
    /// A pad's reports.
    pub pad: Reports,
    /// A keyboard's reports.
    pub keyboard: Reports,
    /// Sources that went.
    pub disconnected: u32,
    /// Reports that could not be read.
    pub unreadable: u32,
}

/// Reports that were taken in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Reports {
    /// How many; wraps.
    pub count: u32,
    /// FNV-1a, 32 bits, of all their bytes in the order in which they came.
    pub checksum: u32,
}

impl Reports {
    /// Takes a report in.
    pub fn add(&mut self, report: &[u8]) {
        self.count = self.count.wrapping_add(1);
        self.checksum =
            report.iter().fold(self.checksum, |hash, byte| (hash ^ u32::from(*byte)).wrapping_mul(0x0100_0193));
    }
}

impl Default for Reports {
    /// Returns what no report gives: FNV-1a's offset basis.
    fn default() -> Self {
        Self { count: 0, checksum: 0x811C_9DC5 }
    }
}

impl Intake {
    /// Starts with nothing connected.
    #[must_use]
    pub fn new() -> Self {
        Self { controls: Controls::new(Config::default()), tally: Tally::default(), typed: 0 }
    }

    /// Takes in a report of any kind.
    ///
    /// # Errors
    /// [`ReportError`] for one that cannot be read; nothing but the tally has changed then.
    pub fn accept(&mut self, report: Report<'_>) -> Result<(), ReportError> {
        if let Err(error) = self.controls.accept(report) {
            self.tally.unreadable = self.tally.unreadable.wrapping_add(1);
            return Err(error);
        }
        match report {
            Report::DualShock3(bytes) => self.tally.pad.add(bytes),
            Report::Keyboard(bytes) => self.tally.keyboard.add(bytes),
            // A level that is sampled, not a stream of reports.
            Report::Panel(_) => {}
            _ => self.tally.disconnected = self.tally.disconnected.wrapping_add(1),
        }
        Ok(())
    }

    /// Takes in a serial frame of a report's kind.
    ///
    /// # Errors
    /// As [`accept`](Self::accept), and [`ReportError`] for a frame that is none.
    pub fn accept_frame(&mut self, kind: u8, payload: &[u8]) -> Result<(), ReportError> {
        self.accept(Report::from_frame(kind, payload)?)
    }

    /// Returns what the application is to see now.
    #[must_use]
    pub fn state(&self) -> ControllerState {
        self.controls.state()
    }

    /// Takes in a key that was typed at a terminal, by its usage on a USB keyboard: as if it was let go and pressed
    /// there, for a step at most.
    pub fn type_key(&mut self, usage: u8) {
        self.controls.type_key(usage);
        self.typed = TYPED_FRAMES;
    }

    /// Ends a frame: forgets what was pressed in it.
    pub fn end_frame(&mut self) {
        self.controls.end_frame();
        if self.typed == 1 {
            let _ = self.controls.accept_keyboard(&[0; 8]);
        }
        self.typed = self.typed.saturating_sub(1);
    }

    /// Returns what came in so far.
    #[must_use]
    pub fn tally(&self) -> Tally {
        self.tally
    }
}

impl Default for Intake {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use controls::{DualShock3Report, Source};

    /// Test vectors of the algorithm's authors: draft-eastlake-fnv, appendix C.
    #[test]
    fn the_checksum_is_fnv_1a() {
        for (text, expected) in [(&b""[..], 0x811C_9DC5), (b"a", 0xE40C_292C), (b"foobar", 0xBF9C_F968)] {
            let mut reports = Reports::default();
            reports.add(text);
            assert_eq!(reports.checksum, expected);
        }
    }

    #[test]
    fn a_typed_key_is_let_go_after_some_frames_and_pressed_anew_when_it_is_typed_again() {
        use controls::Button;
        const TAB: u8 = 0x2B;
        let mut intake = Intake::new();
        intake.type_key(TAB);
        for frame in 0..10 {
            let state = intake.state();
            assert_eq!(state.pressed.contains(Button::Triangle), frame == 0, "{frame}");
            assert_eq!(state.held.contains(Button::Triangle), frame < usize::from(TYPED_FRAMES), "{frame}");
            intake.end_frame();
        }
        for _ in 0..3 {
            intake.type_key(TAB);
            assert!(intake.state().pressed.contains(Button::Triangle));
            intake.end_frame();
        }
        assert_eq!(intake.tally(), Tally::default());
    }

    #[test]
    fn a_typed_key_asks_for_one_step_and_a_held_one_for_one_a_frame() {
        use controls::Request;
        const I: u8 = 0x0C;
        let steps = |intake: &mut Intake| {
            let asked = |_| {
                let asked = intake.state().asked;
                intake.end_frame();
                usize::from(asked == Some(Request::Up))
            };
            (0..10).map(asked).sum::<usize>()
        };
        let mut intake = Intake::new();
        intake.type_key(I);
        assert_eq!(steps(&mut intake), 1, "once typed");
        intake.type_key(I);
        intake.end_frame();
        intake.type_key(I);
        assert_eq!(steps(&mut intake), 1, "typed again before it was let go");
        intake.accept(Report::Keyboard(&[0, 0, I, 0, 0, 0, 0, 0])).expect("a good report");
        assert_eq!(steps(&mut intake), 10, "held on a keyboard");
    }

    #[test]
    fn what_is_taken_in_is_tallied_by_its_source() {
        let mut intake = Intake::new();
        let pad = DualShock3Report::default().to_bytes();
        intake.accept(Report::DualShock3(&pad)).unwrap();
        intake.accept(Report::Keyboard(&[0; 8])).unwrap();
        intake.accept_frame(controls::serial::kind::KEYBOARD, &[0, 0, 4, 0, 0, 0, 0, 0]).unwrap();
        assert!(intake.accept(Report::DualShock3(&pad[1..])).is_err());
        intake.accept(Report::Disconnected(Source::Keyboard)).unwrap();
        let tally = intake.tally();
        assert_eq!((tally.pad.count, tally.keyboard.count, tally.disconnected, tally.unreadable), (1, 2, 1, 1));
        let mut alone = Reports::default();
        alone.add(&pad);
        assert_eq!(tally.pad, alone);
    }
}
