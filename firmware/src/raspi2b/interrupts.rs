//! Which interrupt does what.

use super::interrupt_controller::InterruptController;
use super::memory_map::{LINK_INTERRUPT, TIMER_INTERRUPT, USB_INTERRUPT};
use super::system_timer::Ticker;
use crate::armv7a::sleep::sleep_unless;
use crate::pl011::Pl011;
use crate::serial::LinkInterrupt;
use crate::usb::Service;
use core::cell::RefCell;
use core::sync::atomic::{AtomicU32, Ordering};
use cortex_a_rt::irq;
use critical_section::Mutex;

/// What the handler serves.
pub(super) struct Sources {
    pub(super) controller: InterruptController,
    pub(super) ticker: Ticker,
    pub(super) link: LinkInterrupt<Pl011>,
    pub(super) usb: Service,
}

static SOURCES: Mutex<RefCell<Option<Sources>>> = Mutex::new(RefCell::new(None));
static UNEXPECTED: AtomicU32 = AtomicU32::new(0);

/// Hands the handler what it serves. Interrupts are still masked.
pub(super) fn install(sources: Sources) {
    critical_section::with(|section| SOURCES.replace(section, Some(sources)));
}

/// Works on the USB bus, while its interrupts wait; `None` before there is one.
pub(super) fn with_usb<R>(work: impl FnOnce(&mut Service) -> R) -> Option<R> {
    critical_section::with(|section| SOURCES.borrow_ref_mut(section).as_mut().map(|sources| work(&mut sources.usb)))
}

/// Lets the USB bus go on by the clock.
pub(super) fn start_ticking() {
    critical_section::with(|section| {
        if let Some(sources) = SOURCES.borrow_ref_mut(section).as_mut() {
            sources.controller.enable(TIMER_INTERRUPT);
        }
    });
}

/// Stops the USB bus: no tick comes from now on.
pub(super) fn stop_ticking() {
    critical_section::with(|section| {
        if let Some(sources) = SOURCES.borrow_ref_mut(section).as_mut() {
            sources.controller.disable(TIMER_INTERRUPT);
        }
    });
}

/// Sleeps until the next interrupt, at most a tick, unless `ready` holds.
pub(super) fn sleep_a_tick_unless(ready: impl FnOnce() -> bool) {
    sleep_unless(|| {
        let armed = critical_section::with(|section| {
            SOURCES.borrow_ref_mut(section).as_mut().is_some_and(|sources| sources.ticker.arm())
        });
        !armed || ready()
    });
}

/// Returns how many interrupts came that nobody asked for; each is kept back from then on.
#[must_use]
pub(super) fn unexpected_interrupts() -> u32 {
    UNEXPECTED.load(Ordering::Relaxed)
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
        match self.controller.pending() {
            None => {}
            Some(TIMER_INTERRUPT) => {
                self.ticker.acknowledge();
                // A tick that could not be set is set by who sleeps next.
                let _ = self.ticker.arm();
                self.usb.tick();
            }
            Some(LINK_INTERRUPT) => self.link.serve(),
            Some(USB_INTERRUPT) => self.usb.on_interrupt(),
            Some(other) => {
                self.controller.disable(other);
                // Only the handler writes this counter, and it does not interrupt itself.
                UNEXPECTED.store(UNEXPECTED.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
            }
        }
    }
}
