//! How the last run ended, and what follows from it.
//!
//! A run leaves a note of what it is doing in words that survive a warm reset. A reset that leads to
//! the same end again and again must not become a loop, so the next start counts, and waits for a
//! person when it has seen enough:
//!
//! | end of the last run | what follows |
//! | --- | --- |
//! | the watchdog bit while a bridge was being opened | waits at once: it would hang again |
//! | the watchdog bit, and there is no note | waits at once: it may have been a bridge |
//! | the watchdog bit while frames were drawn, or a fault's report and reset | tries again, [`FAILURES`] times in a row |
//! | anything else | nothing |

use super::reset_cause::ResetCause;
use core::fmt;

/// So many failures in a row make the next start wait for a person.
pub const FAILURES: u8 = 3;

/// What the program is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Nothing that can hang: it waits for the FPGA.
    Idle = 0,
    /// It opens the bridges and looks at what is behind them.
    Bridge = 1,
    /// It draws frames.
    Running = 2,
    /// It met a fault or a panic, said so and asked for a reset.
    Fault = 3,
}

/// What is left for the next start.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Note {
    /// What the program is doing.
    pub stage: Stage,
    /// How many runs before this one failed in a row.
    pub failures: u8,
}

/// Tells this program's notes from others' words.
const MAGIC: u32 = 0x4853_0000;

impl Note {
    /// Returns the note as a word.
    #[must_use]
    pub const fn to_word(self) -> u32 {
        MAGIC | (self.stage as u32) << 8 | self.failures as u32
    }

    /// Returns what a run that met a fault leaves, where `found` is the last note.
    ///
    /// A start judges the last end and leaves a note of its own. A note that still says "fault" is the run's before:
    /// this one met its fault before it could judge.
    #[must_use]
    pub const fn of_fault(found: Option<Self>) -> Self {
        let failures = match found {
            None => 0,
            Some(Self { stage: Stage::Fault, failures }) => failures.saturating_add(1),
            Some(Self { failures, .. }) => failures,
        };
        Self { stage: Stage::Fault, failures }
    }

    /// Returns whether the run that leaves this note was one too many.
    #[must_use]
    pub const fn is_last(self) -> bool {
        self.failures.saturating_add(1) >= FAILURES
    }

    /// Reads a note; `None` if the word is none.
    #[must_use]
    pub const fn from_word(word: u32) -> Option<Self> {
        let stage = match word & 0xFFFF_FF00 ^ MAGIC {
            0x000 => Stage::Idle,
            0x100 => Stage::Bridge,
            0x200 => Stage::Running,
            0x300 => Stage::Fault,
            _ => return None,
        };
        Some(Self { stage, failures: (word & 0xFF) as u8 })
    }
}

/// How the last run ended, where that matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// Nothing to tell.
    Unremarkable,
    /// A bridge did not answer.
    BridgeHung,
    /// The main loop stopped.
    LoopStopped,
    /// A fault or a panic.
    Fault,
    /// The watchdog bit, and nobody knows in what.
    Unknown,
}

/// What the next start makes of the last end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Verdict {
    /// How the last run ended.
    pub end: End,
    /// Failures in a row, this end among them.
    pub failures: u8,
    /// Whether to wait for a person before the bridges are opened.
    pub hold: bool,
}

impl Verdict {
    /// Returns whether there is nothing to tell.
    #[must_use]
    pub const fn is_unremarkable(self) -> bool {
        matches!(self.end, End::Unremarkable)
    }

    /// Judges the last end by the reset's cause and by the note that was found.
    #[must_use]
    pub const fn of(cause: ResetCause, note: Option<Note>) -> Self {
        // A cold reset takes the note with it, and a watchdog's bite beside it was the boot ROM's.
        let note = if cause.is_cold() { None } else { note };
        let (end, before) = match note {
            _ if cause.is_cold() => (End::Unremarkable, 0),
            Some(Note { stage: Stage::Bridge, failures }) if cause.is_watchdog() => (End::BridgeHung, failures),
            Some(Note { stage: Stage::Running, failures }) if cause.is_watchdog() => (End::LoopStopped, failures),
            Some(Note { stage: Stage::Fault, failures }) if cause.is_warm_by_software() => (End::Fault, failures),
            _ if cause.is_watchdog() => (End::Unknown, 0),
            _ => (End::Unremarkable, 0),
        };
        match end {
            End::Unremarkable => Self { end, failures: 0, hold: false },
            End::BridgeHung | End::Unknown => Self { end, failures: before.saturating_add(1), hold: true },
            End::LoopStopped | End::Fault => {
                let failures = before.saturating_add(1);
                Self { end, failures, hold: failures >= FAILURES }
            }
        }
    }
}

/// For a person: what happened. Nothing where there is nothing to tell.
impl fmt::Display for Verdict {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let failures = self.failures;
        match self.end {
            End::Unremarkable => Ok(()),
            End::BridgeHung => out.write_str(
                "the watchdog reset the board: the FPGA's bridge did not answer although the FPGA is configured: \
                 is its design Halfspace's, and do its clocks run?",
            ),
            End::LoopStopped => {
                write!(out, "the watchdog reset the board: the main loop stopped ({failures} in a row)")
            }
            End::Fault => write!(out, "the last run ended with a fault ({failures} in a row); its report stands above"),
            End::Unknown => out.write_str("the watchdog reset the board, and left no note of what hung"),
        }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::string::ToString;

    const POWER_ON: ResetCause = ResetCause(1);
    const KEY: ResetCause = ResetCause(1 << 8);
    const SOFTWARE: ResetCause = ResetCause(1 << 10);
    const WATCHDOG: ResetCause = ResetCause(1 << 14);

    fn note(stage: Stage, failures: u8) -> Option<Note> {
        Some(Note { stage, failures })
    }

    #[test]
    fn a_note_comes_back_and_other_words_are_none() {
        for stage in [Stage::Idle, Stage::Bridge, Stage::Running, Stage::Fault] {
            for failures in [0, 3, u8::MAX] {
                let note = Note { stage, failures };
                assert_eq!(Note::from_word(note.to_word()), Some(note));
            }
        }
        for word in [0, u32::MAX, MAGIC ^ 1 << 16, MAGIC | 0x400, 0xAE9E_FEBC] {
            assert_eq!(Note::from_word(word), None, "{word:#x}");
        }
    }

    #[test]
    fn a_bridge_that_hung_is_not_tried_again() {
        let verdict = Verdict::of(WATCHDOG, note(Stage::Bridge, 0));
        assert_eq!(verdict, Verdict { end: End::BridgeHung, failures: 1, hold: true });
        assert!(verdict.to_string().contains("bridge did not answer"));
        assert!(Verdict::of(WATCHDOG, None).hold);
        assert!(Verdict::of(WATCHDOG, note(Stage::Idle, 0)).hold);
    }

    #[test]
    fn a_failing_run_is_tried_again_twice() {
        for (cause, stage) in [(WATCHDOG, Stage::Running), (SOFTWARE, Stage::Fault)] {
            let holds = [0, 1, 2, 3, u8::MAX].map(|failures| Verdict::of(cause, note(stage, failures)).hold);
            assert_eq!(holds, [false, false, true, true, true]);
        }
    }

    #[test]
    fn faults_before_the_last_end_is_judged_count_too() {
        let mut found = None;
        let ends = [(); 4].map(|()| {
            let left = Note::of_fault(found);
            found = Note::from_word(left.to_word());
            left.is_last()
        });
        assert_eq!(ends, [false, false, true, true]);
        // One that was judged to be the second in a row, and begins to draw.
        let judged = Verdict::of(SOFTWARE, note(Stage::Fault, 1));
        assert!(Note::of_fault(note(Stage::Running, judged.failures)).is_last());
        assert!(!Note::of_fault(note(Stage::Running, 1)).is_last());
    }

    #[test]
    fn a_person_who_resets_the_board_starts_afresh() {
        for stage in [Stage::Idle, Stage::Bridge, Stage::Running, Stage::Fault] {
            for cause in [POWER_ON, KEY, ResetCause(0), ResetCause(1 | 1 << 14)] {
                let verdict = Verdict::of(cause, note(stage, 2));
                assert_eq!(verdict, Verdict { end: End::Unremarkable, failures: 0, hold: false });
                assert_eq!(verdict.to_string(), "");
            }
        }
    }
}
