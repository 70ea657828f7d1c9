//! Which interrupt does what.

use super::interrupt_controller::InterruptController;
use super::memory_map::{LINK_INTERRUPT, TIMER_INTERRUPT, USB_INTERRUPT};
use super::system_timer::Alarm;
use crate::pl011::LinkInterrupt;
use core::cell::RefCell;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use cortex_a_rt::irq;
use critical_section::Mutex;

/// What the handler serves.
pub(super) struct Sources {
    pub(super) controller: InterruptController,
    pub(super) alarm: Alarm,
    pub(super) link: LinkInterrupt,
}

static SOURCES: Mutex<RefCell<Option<Sources>>> = Mutex::new(RefCell::new(None));
static USB_CALLS: AtomicBool = AtomicBool::new(false);
static UNEXPECTED: AtomicU32 = AtomicU32::new(0);

/// Hands the handler what it serves. Interrupts are still masked.
pub(super) fn install(sources: Sources) {
    critical_section::with(|section| SOURCES.replace(section, Some(sources)));
}

/// Returns whether the USB host controller has called since [`listen_to_usb`].
#[must_use]
pub(super) fn usb_calls() -> bool {
    USB_CALLS.load(Ordering::Relaxed)
}

/// Lets the USB host controller call: its interrupt is held back from its first call on, as its
/// driver works outside the handler.
pub(super) fn listen_to_usb(controller: InterruptController) {
    USB_CALLS.store(false, Ordering::Relaxed);
    controller.enable(USB_INTERRUPT);
}

/// Returns how many interrupts came that nobody asked for; each is kept back from then on.
#[must_use]
pub fn unexpected_interrupts() -> u32 {
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
            Some(TIMER_INTERRUPT) => self.alarm.acknowledge(),
            Some(LINK_INTERRUPT) => self.link.serve(),
            Some(USB_INTERRUPT) => {
                self.controller.disable(USB_INTERRUPT);
                USB_CALLS.store(true, Ordering::Relaxed);
            }
            Some(other) => {
                self.controller.disable(other);
                // Only the handler writes this counter, and it does not interrupt itself.
                UNEXPECTED.store(UNEXPECTED.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
            }
        }
    }
}
