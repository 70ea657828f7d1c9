//! The words that wait while the device is disabled.

use crate::memory::{FIFO_WORDS_MAX, FIFO_WORDS_MIN, SizeError};

/// A FIFO that is filled word by word and emptied whole, so it needs no ring.
pub(crate) struct Fifo<'a> {
    words: &'a mut [u32],
    level: usize,
}

impl<'a> Fifo<'a> {
    /// Takes the FIFO's words; their number is its depth.
    ///
    /// # Errors
    /// [`SizeError::Fifo`].
    pub(crate) fn new(words: &'a mut [u32]) -> Result<Self, SizeError> {
        match words.len() {
            FIFO_WORDS_MIN..=FIFO_WORDS_MAX => Ok(Self { words, level: 0 }),
            found => Err(SizeError::Fifo { found }),
        }
    }

    /// Returns how many words it holds at most.
    pub(crate) fn depth(&self) -> usize {
        self.words.len()
    }

    /// Returns how many words it holds.
    pub(crate) fn level(&self) -> usize {
        self.level
    }

    /// Takes what fits of `words`, drops the rest and returns whether there was any.
    #[must_use]
    pub(crate) fn push(&mut self, words: &[u32]) -> bool {
        let free = &mut self.words[self.level..];
        let taken = words.len().min(free.len());
        free[..taken].copy_from_slice(&words[..taken]);
        self.level += taken;
        taken < words.len()
    }

    /// Empties it and returns what was in it, first come first.
    pub(crate) fn drain(&mut self) -> &[u32] {
        let level = core::mem::take(&mut self.level);
        &self.words[..level]
    }
}
