//! Random numbers that repeat.

/// xorshift64*.
pub struct Random(u64);

impl Random {
    /// Returns a generator; any seed will do.
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    /// Returns 32 random bits.
    pub fn word(&mut self) -> u32 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 32) as u32
    }

    /// Returns a number from `low` to `high`, both included.
    pub fn within(&mut self, low: i32, high: i32) -> i32 {
        let span = (i64::from(high) - i64::from(low) + 1) as u64;
        (i64::from(low) + ((u64::from(self.word()) * span) >> 32) as i64) as i32
    }

    /// Returns true once in `times`.
    pub fn one_in(&mut self, times: i32) -> bool {
        self.within(1, times) == 1
    }
}
