//! Time, and every wait with who asks for it.

/// A moment, in units of 1,024 µs since some other; one that is 25 days away or more is taken for the past.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Moment(u32);

/// A while, in microseconds; a wait takes at least that, and at most 3 ms more.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Wait(u32);

const MICROSECONDS_EXPONENT: u32 = 10;

impl Moment {
    pub(crate) const fn from_us(microseconds: u64) -> Self {
        Self((microseconds >> MICROSECONDS_EXPONENT) as u32)
    }

    pub(crate) const fn after(self, wait: Wait) -> Self {
        // One more for the wait's end, one for the moment's beginning.
        Self(self.0.wrapping_add((wait.0 >> MICROSECONDS_EXPONENT) + 2))
    }

    /// Tells how far it is away, in units of 1,024 µs; `None` if it has come.
    pub(crate) const fn away_from(self, now: Self) -> Option<u32> {
        let away = self.0.wrapping_sub(now.0);
        if away == 0 || away > u32::MAX / 2 { None } else { Some(away) }
    }

    /// Returns when it comes, by a clock that shows this many microseconds now.
    pub(crate) const fn to_us(away: u32, now_us: u64) -> u64 {
        ((now_us >> MICROSECONDS_EXPONENT) + away as u64) << MICROSECONDS_EXPONENT
    }
}

impl Wait {
    const fn milliseconds(count: u32) -> Self {
        Self(count * 1_000)
    }

    pub(crate) const fn times(self, count: u32) -> Self {
        Self(self.0 * count)
    }

    pub(crate) const fn microseconds(self) -> u64 {
        self.0 as u64
    }

    /// A port's connection has to be steady this long before its reset: TATTDB, USB 2.0 §7.1.7.3.
    pub(crate) const PORT_DEBOUNCE: Self = Self::milliseconds(100);
    /// How often a port is asked whether its reset is over. The hub drives it for 10 to 20 ms: TDRST,
    /// USB 2.0 §7.1.7.5, §11.5.1.5.
    pub(crate) const PORT_RESET_STEP: Self = Self::milliseconds(10);
    /// When a port's reset that did not end has failed: ten times TDRST's maximum.
    pub(crate) const PORT_RESET_TIMEOUT: Self = Self::milliseconds(200);
    /// After a reset a device may be deaf this long: TRSTRCY, USB 2.0 §7.1.7.5.
    pub(crate) const RESET_RECOVERY: Self = Self::milliseconds(10);
    /// After SET_ADDRESS a device may be deaf this long: USB 2.0 §9.2.6.3.
    pub(crate) const ADDRESS_RECOVERY: Self = Self::milliseconds(2);
    /// The unit of a hub's bPwrOn2PwrGood: USB 2.0 §11.23.2.1.
    pub(crate) const POWER_GOOD_UNIT: Self = Self::milliseconds(2);
    /// A device has this long for each packet of a data stage: USB 2.0 §9.2.6.4. For a standard request
    /// without one §9.2.6.4 grants 50 ms, for a class's nothing but [`CONTROL_TIMEOUT`](Self::CONTROL_TIMEOUT)
    /// holds; both get as long as one packet, because slow keyboards take more than 50 ms.
    pub(crate) const STAGE_TIMEOUT: Self = Self::milliseconds(500);
    /// No request takes longer: USB 2.0 §9.2.6.1.
    pub(crate) const CONTROL_TIMEOUT: Self = Self::milliseconds(5_000);
    /// When a device that is not ready yet has failed, from the end of its reset on. Ours: as long as the longest
    /// request, because others wait for their turn meanwhile.
    pub(crate) const READY_TIMEOUT: Self = Self::CONTROL_TIMEOUT;
    /// Between a device's failure and its next reset. Ours.
    pub(crate) const RETRY_PAUSE: Self = Self::milliseconds(100);
    /// After [`ATTEMPTS`], the root port's device is reset this seldom: it may be a hub on the board,
    /// which nobody can plug in again. Ours.
    pub(crate) const ROOT_RETRY_PAUSE: Self = Self::milliseconds(10_000);
    /// The pause after a failed interrupt transfer; it doubles from one to the next. Ours.
    pub(crate) const READ_PAUSE: Self = Self::milliseconds(10);
    /// How long a DualShock 3 shakes when the pose is frozen. Ours.
    pub(crate) const PULSE: Self = Self::milliseconds(80);
}

/// How often a device is reset before it is given up. Ours.
pub(crate) const ATTEMPTS: u8 = 3;
/// Failed interrupt transfers in a row before the device has failed; with the doubling, 1.27 s: longer than any
/// hub takes to tell that the device was unplugged (bInterval at most 255 ms). Ours.
pub(crate) const READ_ERRORS_MAXIMUM: u8 = 7;

/// A device is served, let be or given up so many microseconds after its hub has told of it, at most, if nobody else
/// starts at the same time: only one starts at a time, and others wait until then. Each attempt has
/// [`READY_TIMEOUT`](Wait::READY_TIMEOUT) from the end of its reset on, and ends there.
///
/// A device on the root port is not given up, but tried ever more seldom; its first three attempts take no longer.
pub const SETTLED_WITHIN_US: u64 = {
    let attempt = Wait::RETRY_PAUSE.0 + Wait::PORT_RESET_TIMEOUT.0 + Wait::PORT_RESET_STEP.0 + Wait::READY_TIMEOUT.0;
    // What the waits are longer by, and what their requests take.
    let more = 20_000;
    (Wait::PORT_DEBOUNCE.0 + ATTEMPTS as u32 * (attempt + more)) as u64
};

#[cfg(test)]
mod tests {
    use super::{Moment, Wait};

    #[test]
    fn a_wait_is_never_too_short_and_hardly_too_long() {
        for wait in [Wait::ADDRESS_RECOVERY, Wait::RESET_RECOVERY, Wait::CONTROL_TIMEOUT] {
            for start_us in (0..5_000).chain([u64::from(u32::MAX) << 10]) {
                let end = Moment::from_us(start_us).after(wait);
                let has_come = |after_us: u64| end.away_from(Moment::from_us(start_us + after_us)).is_none();
                assert!(!has_come(wait.microseconds() - 1), "{start_us}");
                assert!(has_come(wait.microseconds() + 3_000), "{start_us}");
            }
        }
    }

    #[test]
    fn how_far_away_it_is_tells_when_it_comes() {
        let now_us = (7 << 50) + 12_345;
        let end = Moment::from_us(now_us).after(Wait::PULSE);
        let away = end.away_from(Moment::from_us(now_us)).unwrap();
        let at_us = Moment::to_us(away, now_us);
        assert_eq!(end.away_from(Moment::from_us(at_us)), None);
        assert!(end.away_from(Moment::from_us(at_us - 1)).is_some());
    }
}
