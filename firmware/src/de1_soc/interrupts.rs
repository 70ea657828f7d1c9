//! Which interrupt does what.

use super::memory_map::{FPGA_INTERRUPT, UART_INTERRUPT, USB_INTERRUPT};
use super::uart16550::Uart16550;
use crate::cortex_a9::gic::{Distributor, Interface, InterruptId};
use crate::cortex_a9::private_timer::TimerInterrupt;
use crate::serial::LinkInterrupt;
use crate::usb::Service;
use core::cell::RefCell;
use core::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use cortex_a_rt::irq;
use critical_section::Mutex;

/// What the handler serves.
pub(super) struct Sources {
    pub(super) interface: Interface,
    pub(super) distributor: Distributor,
    pub(super) timer: TimerInterrupt,
    pub(super) link: LinkInterrupt<Uart16550>,
    pub(super) usb: Service,
}

static SOURCES: Mutex<RefCell<Option<Sources>>> = Mutex::new(RefCell::new(None));
static FPGA_CALLED: AtomicBool = AtomicBool::new(false);
static FPGA_CALLS: AtomicU32 = AtomicU32::new(0);
static UNEXPECTED: AtomicU32 = AtomicU32::new(0);

/// Hands the handler what it serves. Interrupts are still masked.
pub(super) fn install(sources: Sources) {
    critical_section::with(|section| SOURCES.replace(section, Some(sources)));
}

/// Works on the USB bus, while its interrupts wait; `None` before there is one.
pub(super) fn with_usb<R>(work: impl FnOnce(&mut Service) -> R) -> Option<R> {
    critical_section::with(|section| SOURCES.borrow_ref_mut(section).as_mut().map(|sources| work(&mut sources.usb)))
}

/// Lets the FPGA's interrupt come, once: its handler keeps it back, as only the driver can clear its
/// cause.
pub(super) fn listen_to_fpga() {
    critical_section::with(|section| {
        FPGA_CALLED.store(false, Ordering::Relaxed);
        if let Some(sources) = SOURCES.borrow_ref_mut(section).as_mut() {
            sources.distributor.enable(FPGA_INTERRUPT);
        }
    });
}

/// Returns whether the FPGA's interrupt came since [`listen_to_fpga`].
pub(super) fn fpga_has_called() -> bool {
    FPGA_CALLED.load(Ordering::Relaxed)
}

/// Returns how often the FPGA's interrupt came since the start; wraps.
pub(super) fn fpga_calls() -> u32 {
    FPGA_CALLS.load(Ordering::Relaxed)
}

/// Returns how many interrupts came that nobody asked for; each is kept back from then on.
pub(super) fn unexpected_interrupts() -> u32 {
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
                self.usb.tick();
            }
            FPGA_INTERRUPT => {
                // Its line stays up until the driver clears the cause, and a handler that touched the bridge could
                // hang: so it is kept back until the driver waits again.
                self.distributor.disable(FPGA_INTERRUPT);
                FPGA_CALLED.store(true, Ordering::Relaxed);
                count(&FPGA_CALLS);
            }
            UART_INTERRUPT => self.link.serve(),
            USB_INTERRUPT => self.usb.on_interrupt(),
            other => {
                self.distributor.disable(other);
                count(&UNEXPECTED);
            }
        }
        self.interface.end(acknowledged);
    }
}
