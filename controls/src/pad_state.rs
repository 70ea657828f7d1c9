//! What the pad does to the state.

use crate::{Acceleration, Battery, Buttons, Config, DualShock3Report, Stick, Tilt};
use fixed::types::I24F8;

/// Keeps the last report of a pad, and its accelerometer smoothed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PadState {
    pub(crate) held: Buttons,
    pub(crate) left_stick: Stick,
    pub(crate) right_stick: Stick,
    pub(crate) battery: Battery,
    pub(crate) tilt: Tilt,
    smoothed: Acceleration,
    /// Where it was when it last counted as moved.
    anchor: Acceleration,
}

/// Tells what a report has moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Movement {
    pub(crate) tilt: bool,
    pub(crate) anything: bool,
}

impl PadState {
    /// Starts with a first report: nothing to smooth it with yet.
    pub(crate) fn new(report: &DualShock3Report, config: &Config) -> Self {
        Self {
            held: report.held,
            left_stick: Stick::from_raw(report.left_stick, config.stick_response),
            right_stick: Stick::from_raw(report.right_stick, config.stick_response),
            battery: report.battery,
            tilt: tilt(report.acceleration, config, Tilt::LEVEL),
            smoothed: report.acceleration,
            anchor: report.acceleration,
        }
    }

    /// Takes in a report and tells what it moved.
    pub(crate) fn update(&mut self, report: &DualShock3Report, config: &Config) -> Movement {
        let before = *self;
        *self = Self::new(report, config);
        self.smoothed = before.smoothed.zip(report.acceleration, |value, reading| config.low_pass.step(value, reading));
        self.tilt = tilt(self.smoothed, config, before.tilt);
        let moved = self.smoothed.differs_by_more_than(before.anchor, dead_zone_width(config));
        self.anchor = if moved { self.smoothed } else { before.anchor };
        let touched =
            self.held != before.held || self.left_stick != before.left_stick || self.right_stick != before.right_stick;
        Movement { tilt: moved, anything: moved || touched }
    }

    /// Takes where the pad is now as the place from which it has to move.
    pub(crate) fn settle(&mut self) {
        self.anchor = self.smoothed;
    }
}

fn dead_zone_width(config: &Config) -> I24F8 {
    I24F8::from(config.tilt_dead_zone_counts)
}

/// Returns the tilt, or of roll and pitch what was before where gravity does not tell: roll with the
/// pad upright on an edge, both in free fall.
fn tilt(smoothed: Acceleration, config: &Config, before: Tilt) -> Tilt {
    /// A tenth of 1 g.
    const FAINT_COUNTS: i64 = 11;
    let faint = |square: i64| square < (FAINT_COUNTS << I24F8::FRAC_NBITS).pow(2);
    let [x, y, z] = [smoothed.x, smoothed.y, smoothed.z].map(|axis| i64::from(axis.to_bits()).pow(2));
    let width = dead_zone_width(config);
    let quiet = Acceleration { x: dead_zone(smoothed.x, width), y: dead_zone(smoothed.y, width), z: smoothed.z };
    let now = Tilt::from_acceleration(quiet);
    Tilt {
        roll: if faint(x + z) { before.roll } else { now.roll },
        pitch: if faint(x + y + z) { before.pitch } else { now.pitch },
    }
}

/// Takes readings up to the width for 0, and lets those from twice the width on through.
fn dead_zone(value: I24F8, width: I24F8) -> I24F8 {
    let size = value.saturating_abs();
    if size <= width {
        I24F8::ZERO
    } else if size < width + width {
        let beyond = size - width;
        if value > 0 { beyond + beyond } else { -(beyond + beyond) }
    } else {
        value
    }
}

#[cfg(test)]
mod tests {
    use super::{Movement, PadState, dead_zone};
    use crate::{Acceleration, Config, DualShock3Report, LowPass};
    use fixed::types::I24F8;

    fn report(raw: [u16; 3]) -> DualShock3Report {
        DualShock3Report { acceleration: Acceleration::from_raw(raw), ..DualShock3Report::default() }
    }

    #[test]
    fn the_dead_zone_is_flat_then_steep_then_true() {
        let found = |counts: i32| dead_zone(I24F8::from_num(counts), I24F8::from_num(4)).to_num::<i32>();
        assert_eq!([0, 1, 4, 5, 6, 8, 9, 113].map(found), [0, 0, 0, 2, 4, 8, 9, 113]);
        for counts in -600..=600 {
            assert_eq!(found(-counts), -found(counts));
            assert!((0..=2).contains(&(found(counts + 1) - found(counts))), "{counts}");
        }
    }

    #[test]
    fn a_still_pad_reads_level_and_does_not_move() {
        let config = Config::default();
        let mut pad = PadState::new(&report([511, 511, 398]), &config);
        for noise in [1, 3, 0, 4, 2, 4, 4, 4, 4, 4, 4, 4, 0] {
            let movement = pad.update(&report([511 + noise, 511 - noise, 398 + noise]), &config);
            assert_eq!(movement, Movement { tilt: false, anything: false });
            assert_eq!((pad.tilt.roll.to_bits(), pad.tilt.pitch.to_bits()), (0, 0));
        }
    }

    #[test]
    fn five_counts_are_a_movement_once() {
        let config = Config { low_pass: LowPass::Off, ..Config::default() };
        let mut pad = PadState::new(&report([511, 511, 398]), &config);
        assert!(pad.update(&report([516, 511, 398]), &config).tilt);
        assert!(!pad.update(&report([516, 511, 398]), &config).tilt);
    }

    #[test]
    fn a_slow_hand_moves_too() {
        let config = Config { low_pass: LowPass::Off, ..Config::default() };
        let mut pad = PadState::new(&report([511, 511, 398]), &config);
        let movements = (1..=20).filter(|&count| pad.update(&report([511 + count, 511, 398]), &config).tilt);
        assert!(movements.eq([5, 10, 15, 20]));
    }

    #[test]
    fn after_settling_it_has_to_move_from_there() {
        let config = Config { low_pass: LowPass::Off, ..Config::default() };
        let mut pad = PadState::new(&report([511, 511, 398]), &config);
        pad.update(&report([515, 511, 398]), &config);
        pad.settle();
        assert!(!pad.update(&report([519, 511, 398]), &config).tilt);
        assert!(pad.update(&report([520, 511, 398]), &config).tilt);
    }

    #[test]
    fn the_filter_arrives_at_the_exact_tilt() {
        let config = Config::default();
        let mut pad = PadState::new(&report([511, 511, 398]), &config);
        let first = pad.update(&report([591, 511, 431]), &config);
        assert!(first.tilt && pad.tilt.roll < 20);
        for _ in 0..60 {
            pad.update(&report([591, 511, 431]), &config);
        }
        assert_eq!(pad.tilt.roll, 45);
    }

    #[test]
    fn upright_on_an_edge_the_roll_stays_as_it_was() {
        let config = Config { low_pass: LowPass::Off, ..Config::default() };
        let mut pad = PadState::new(&report([591, 511, 431]), &config);
        pad.update(&report([505, 398, 517]), &config);
        assert_eq!(pad.tilt.roll, 45);
        assert!(pad.tilt.pitch > 80);
        pad.update(&report([511, 511, 511]), &config);
        assert!(pad.tilt.pitch > 80, "free fall");
    }
}
