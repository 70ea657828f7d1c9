//! What the HPS LED shows: the program's state, from across the room.

/// A state that the LED tells. While frames are drawn it changes with them instead.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Blink {
    /// Two flashes, a pause: the FPGA is not configured.
    NotConfigured,
    /// Three flashes, a pause: what is in the FPGA is not what this program draws with.
    WrongDesign,
    /// Four flashes, a pause: the last run ended badly, and the HPS key is waited for.
    Held,
    /// Ten times a second: the program ended with a fault.
    Fault,
}

/// How long a round of flashes takes, in milliseconds.
const ROUND_MS: u64 = 2_000;
/// How long a flash and the dark after it take.
const FLASH_MS: u64 = 300;

impl Blink {
    /// Returns whether the LED is lit at a time, in milliseconds since any moment.
    #[must_use]
    pub const fn is_lit(self, milliseconds: u64) -> bool {
        let flashes = match self {
            Self::NotConfigured => 2,
            Self::WrongDesign => 3,
            Self::Held => 4,
            Self::Fault => return milliseconds % 100 < 50,
        };
        let now = milliseconds % ROUND_MS;
        now < flashes * FLASH_MS && now % FLASH_MS < FLASH_MS / 2
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How often the LED goes on in ten rounds.
    fn flashes(blink: Blink) -> usize {
        (0..10 * ROUND_MS).filter(|now| blink.is_lit(*now) && (*now == 0 || !blink.is_lit(now - 1))).count()
    }

    #[test]
    fn states_differ_by_their_flashes() {
        assert_eq!(flashes(Blink::NotConfigured), 20);
        assert_eq!(flashes(Blink::WrongDesign), 30);
        assert_eq!(flashes(Blink::Held), 40);
        assert_eq!(flashes(Blink::Fault), 200);
    }

    #[test]
    fn every_round_ends_with_a_pause_that_is_longer_than_the_dark_between_flashes() {
        for blink in [Blink::NotConfigured, Blink::WrongDesign, Blink::Held] {
            assert!((ROUND_MS - 2 * FLASH_MS..ROUND_MS).all(|now| !blink.is_lit(now)));
        }
    }
}
