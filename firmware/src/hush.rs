//! Complaints that could come by the thousand, at most one a second.

/// Lets one complaint a second through, and counts the others.
#[derive(Debug)]
pub struct Hush {
    /// A second, in the clock's ticks.
    second: u64,
    /// When one was let through last.
    spoke: Option<u64>,
    kept_back: u32,
}

impl Hush {
    /// Lets the first one through.
    #[must_use]
    pub const fn new(ticks_per_second: u64) -> Self {
        Self { second: ticks_per_second, spoke: None, kept_back: 0 }
    }

    /// Asks for a complaint to be made now. Returns how many were kept back since the last; `None` keeps this one back,
    /// too.
    pub fn speak(&mut self, now: u64) -> Option<u32> {
        if self.is_over(now) {
            self.spoke = Some(now);
            return Some(core::mem::take(&mut self.kept_back));
        }
        self.kept_back = self.kept_back.saturating_add(1);
        None
    }

    /// Returns how many were kept back, once their second is over; `None` when there is nothing to tell yet.
    pub fn kept_back(&mut self, now: u64) -> Option<u32> {
        if self.kept_back > 0 && self.is_over(now) { self.speak(now) } else { None }
    }

    fn is_over(&self, now: u64) -> bool {
        self.spoke.is_none_or(|spoke| now.wrapping_sub(spoke) >= self.second)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_a_second_speaks_and_the_others_are_counted() {
        let mut hush = Hush::new(1_000);
        assert_eq!([0, 1, 2, 999].map(|now| hush.speak(now)), [Some(0), None, None, None]);
        assert_eq!([hush.kept_back(999), hush.kept_back(1_000), hush.kept_back(1_001)], [None, Some(3), None]);
        assert_eq!(hush.speak(1_500), None, "the count was a line, too");
        assert_eq!(hush.speak(2_000), Some(1));
        assert_eq!(hush.kept_back(5_000), None);
    }
}
