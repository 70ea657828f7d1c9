//! A first-order low-pass that arrives.

use fixed::types::I24F8;

/// Names the part of the way to a new reading that the filter goes with each report.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum LowPass {
    /// All of it: no filter.
    Off = 0,
    /// A half.
    Half = 1,
    /// A quarter: 90 % of a step after 9 reports, 90 ms of a DualShock 3.
    #[default]
    Quarter = 2,
    /// An eighth.
    Eighth = 3,
    /// A sixteenth.
    Sixteenth = 4,
}

impl LowPass {
    /// Returns where a filter that stands at `value` is after one `reading`.
    ///
    /// The step is rounded away from zero to 1/256 count, so that the filter comes to rest on the
    /// reading itself, and never beyond it.
    pub(crate) fn step(self, value: I24F8, reading: I24F8) -> I24F8 {
        let distance = i64::from(reading.to_bits()) - i64::from(value.to_bits());
        let shift = self as u32;
        let step = if distance >= 0 { -(-distance >> shift) } else { distance >> shift };
        I24F8::from_bits((i64::from(value.to_bits()) + step) as i32)
    }
}

#[cfg(test)]
mod tests {
    use super::LowPass;
    use fixed::types::I24F8;

    const ALL: [LowPass; 5] = [LowPass::Off, LowPass::Half, LowPass::Quarter, LowPass::Eighth, LowPass::Sixteenth];

    #[test]
    fn it_comes_to_rest_exactly_on_the_reading_and_never_passes_it() {
        for low_pass in ALL {
            for start in (-512..=512).step_by(37) {
                for end in (-512..=512).step_by(41) {
                    let (mut value, end) = (I24F8::from_num(start), I24F8::from_num(end));
                    let rising = end > value;
                    for _ in 0..400 {
                        let next = low_pass.step(value, end);
                        assert!(if rising { (value..=end).contains(&next) } else { (end..=value).contains(&next) });
                        value = next;
                    }
                    assert_eq!(value, end, "{low_pass:?}");
                }
            }
        }
    }

    #[test]
    fn a_quarter_goes_a_quarter_of_the_way() {
        let step = |from, to| LowPass::Quarter.step(I24F8::from_num(from), I24F8::from_num(to));
        assert_eq!(step(0, 100), 25);
        assert_eq!(step(0, -100), -25);
        assert_eq!(step(100, 0), 75);
        let after_nine = (0..9).fold(I24F8::ZERO, |value, _| LowPass::Quarter.step(value, I24F8::from_num(100)));
        assert!((90..=95).contains(&after_nine.to_num::<i32>()), "{after_nine}");
    }

    #[test]
    fn it_holds_any_two_numbers() {
        for low_pass in ALL {
            assert!(low_pass.step(I24F8::MAX, I24F8::MIN) < I24F8::MAX);
            assert!(low_pass.step(I24F8::MIN, I24F8::MAX) > I24F8::MIN);
        }
    }
}
