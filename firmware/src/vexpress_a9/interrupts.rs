//! Which interrupt does what.

use super::memory_map::{KEYBOARD_INTERRUPT, LINK_INTERRUPT};
use super::pl050::KeyboardInterrupt;
use crate::cortex_a9::gic::{Interface, InterruptId};
use crate::cortex_a9::private_timer::TimerInterrupt;
use crate::pl011::Pl011;
use crate::serial::LinkInterrupt;
use core::cell::RefCell;
use core::sync::atomic::{AtomicU32, Ordering};
use cortex_a_rt::irq;
use critical_section::Mutex;

/// What the handler serves.
pub(super) struct Sources {
    pub(super) interface: Interface,
    pub(super) timer: TimerInterrupt,
    pub(super) link: LinkInterrupt<Pl011>,
    pub(super) keyboard: KeyboardInterrupt,
}

static SOURCES: Mutex<RefCell<Option<Sources>>> = Mutex::new(RefCell::new(None));
static TICKS: AtomicU32 = AtomicU32::new(0);
static UNEXPECTED: AtomicU32 = AtomicU32::new(0);

/// Hands the handler what it serves. Interrupts are still masked.
pub(super) fn install(sources: Sources) {
    critical_section::with(|section| SOURCES.replace(section, Some(sources)));
}

/// Returns the private timer's interrupts since start; wraps.
#[must_use]
pub fn ticks() -> u32 {
    TICKS.load(Ordering::Relaxed)
}

/// Returns how many interrupts came that nobody asked for.
#[must_use]
pub fn unexpected_interrupts() -> u32 {
    UNEXPECTED.load(Ordering::Relaxed)
}

/// Adds one. Only the handler writes these counters, and it does not interrupt itself.
fn count(counter: &AtomicU32) {
    counter.store(counter.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
}

#[irq]
fn interrupt() {
    critical_section::with(|section| {
        let mut sources = SOURCES.borrow_ref_mut(section);
        if let Some(sources) = sources.as_mut() {
            sources.serve();
        }
    });
}

impl Sources {
    /// Serves one interrupt; another that is pending interrupts again.
    fn serve(&mut self) {
        let Some(acknowledged) = self.interface.acknowledge() else { return };
        match acknowledged.interrupt() {
            InterruptId::PRIVATE_TIMER => {
                self.timer.acknowledge();
                count(&TICKS);
            }
            LINK_INTERRUPT => self.link.serve(),
            KEYBOARD_INTERRUPT => self.keyboard.serve(),
            _ => count(&UNEXPECTED),
        }
        self.interface.end(acknowledged);
    }
}
