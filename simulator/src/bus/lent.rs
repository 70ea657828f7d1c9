//! Memory that a bus master has for now, and the processor leaves alone.

use std::sync::{Mutex, MutexGuard, PoisonError};

struct Range {
    channel: usize,
    start: u32,
    bytes: u32,
    /// The master writes there; else it only reads, and the processor may read, too.
    writes: bool,
}

/// What is lent.
#[derive(Default)]
pub(super) struct Lent(Mutex<Vec<Range>>);

impl Lent {
    fn ranges(&self) -> MutexGuard<'_, Vec<Range>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn add(&self, channel: usize, start: u32, bytes: u32, writes: bool) {
        self.ranges().push(Range { channel, start, bytes, writes });
    }

    pub(super) fn remove(&self, channel: usize) {
        self.ranges().retain(|range| range.channel != channel);
    }

    pub(super) fn clear(&self) {
        self.ranges().clear();
    }

    /// Says what is wrong when the processor reads or writes.
    pub(super) fn check(&self, address: u32, bytes: u32, writes: bool) -> Result<(), &'static str> {
        let touched = self.ranges().iter().any(|range| {
            address < range.start.saturating_add(range.bytes)
                && range.start < address.saturating_add(bytes)
                && (writes || range.writes)
        });
        if touched {
            return Err("a bus master has this buffer: leave it alone until its channel has halted");
        }
        Ok(())
    }
}
